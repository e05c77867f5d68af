#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Who asks for heap memory after READY. The counts are those of the whole process: one run at a
/// time.
namespace hitchview::app {

enum class OnHeapCall {
    kCount,
    kTrap,  ///< the first one of a frame-path thread stops the program, naming thread and caller
};

struct HeapCallCounts {
    std::uint64_t frame_path = 0;  ///< of every thread but those of files
    std::uint64_t files = 0;       ///< of threads whose name begins `src-` or `out-`

    struct Thread {
        std::string name;
        std::uint64_t calls = 0;
    };
    std::vector<Thread> threads{};  ///< frame path; those that called, in the order they began to
};

/// Counts from zero. What the trap needs is loaded here.
void StartCountingHeapCalls(OnHeapCall on_call);
/// What was counted can still be read.
void StopCountingHeapCalls();
/// Since the last start; empty where the executable does not tell of its heap calls: a build with a
/// sanitizer, or one without heap_interposer.cpp.
std::optional<HeapCallCounts> CountHeapCalls();
/// The sum of the frame path alone, while it is counted. Any thread; takes no memory.
std::optional<std::uint64_t> HeapCallsOfFramePath();

/// For heap_interposer.cpp, before each call of malloc and its kin. Any thread; takes no memory,
/// and costs one load while nothing is counted.
void NoteHeapCall();

}  // namespace hitchview::app

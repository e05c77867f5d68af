#include "app/real_time.hpp"

#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "app/thread_schedule.hpp"

namespace hitchview::app {
namespace {

using hal::Checked;
using hal::Done;

#ifdef HITCHVIEW_SANITIZED
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
constexpr const char* kTooMuch = "a sanitizer's tables are larger than memory";

constexpr std::size_t kStackBytes = 2 << 20;
/// Of the stack of the process's first thread, which grows as it is used.
constexpr std::size_t kFirstStackBytes = 512 << 10;
constexpr std::size_t kPageBytes = 4096;  // at most the real size
/// Since Linux 5.14; older headers do not name it.
constexpr int kPopulateWrite = 23;

[[gnu::noinline]] void TouchStack() {
    std::array<volatile char, kFirstStackBytes> stack;
    for (std::size_t i = 0; i < stack.size(); i += kPageBytes) stack[i] = 0;
}

/// 0 or errno. `line`: one of /proc/self/maps.
int Prefault(const std::string& line) {
    std::uintptr_t first = 0;
    std::uintptr_t end = 0;
    std::array<char, 5> access{};
    if (std::sscanf(line.c_str(), "%" SCNxPTR "-%" SCNxPTR " %4s", &first, &end, access.data()) !=
        3) {
        return 0;
    }
    if (std::strcmp(access.data(), "rw-p") != 0) return 0;
    // The address comes from the kernel as a number.
    void* const memory = reinterpret_cast<void*>(first);  // NOLINT(performance-no-int-to-ptr)
    return madvise(memory, end - first, kPopulateWrite) == 0 ? 0 : errno;
}

std::string Outcome(const Checked<Done>& step) {
    return step ? "" : step.error();
}

}  // namespace

Checked<Done> KeepHeap() {
    const bool kept = mallopt(M_TRIM_THRESHOLD, -1) == 1 && mallopt(M_MMAP_MAX, 0) == 1;
    if (kept) return Done{};
    return std::string("this C library cannot be told to keep the heap");
}

Checked<Done> BoundStacks() {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, kStackBytes);
    const int error = pthread_setattr_default_np(&attributes);
    pthread_attr_destroy(&attributes);
    if (error == 0) return Done{};
    return std::string(std::strerror(error));
}

Checked<Done> LockAllMemory() {
    if (kSanitized) return std::string(kTooMuch);
    if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return Done{};
    return std::string(std::strerror(errno)) +
           ": give the service LimitMEMLOCK=infinity or the capability CAP_IPC_LOCK";
}

Checked<Done> PrefaultMemory() {
    TouchStack();
    if (kSanitized) return std::string(kTooMuch);
    std::ifstream maps("/proc/self/maps");
    if (!maps) return std::string("/proc/self/maps cannot be read");
    int refused = 0;
    for (std::string line; std::getline(maps, line);) {
        if (const int error = Prefault(line)) refused = error;
    }
    if (refused == 0) return Done{};
    if (refused == EINVAL) return std::string("needs Linux 5.14, or locked memory");
    return std::string(std::strerror(refused));
}

void LogSteps(const std::vector<SetUpStep>& steps) {
    for (const auto& [name, refusal] : steps) {
        if (refusal.empty()) {
            std::fprintf(stderr, "real time: %s\n", name);
        } else {
            std::fprintf(stderr, "real time: not %s: %s\n", name, refusal.c_str());
        }
    }
}

Checked<Done> PrepareRealTime(const RealTimeConfig& config) {
    using Lock = RealTimeConfig::LockMemory;
    std::vector<SetUpStep> steps{{"heap kept", Outcome(KeepHeap())},
                                 {"stacks bounded", Outcome(BoundStacks())}};
    if (config.lock_memory != Lock::kNever) {
        const auto locked = LockAllMemory();
        if (!locked && config.lock_memory == Lock::kRequired)
            return "real_time.lock_memory is required: " + locked.error();
        steps.push_back({"memory locked", Outcome(locked)});
    }
    LogSteps(steps);
    return Done{};
}

void EnterRealTime(const ThreadSchedule& pipeline) {
    std::vector<SetUpStep> steps{{"memory resident", Outcome(PrefaultMemory())}};
    if (pipeline.given()) steps.push_back({"pipeline scheduled", Outcome(Apply(pipeline))});
    LogSteps(steps);
}

}  // namespace hitchview::app

#include "app/heap_calls.hpp"

#include <execinfo.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <string_view>

namespace hitchview::app {
namespace {

using ThreadName = std::array<char, 16>;  // as the kernel keeps it

/// Calls of one thread. It stays after the thread has ended.
struct ThreadCalls {
    ThreadName name{};
    std::atomic<bool> files{false};
    std::atomic<std::uint64_t> calls{0};
};

/// More threads than any rig has; those beyond share the last entry.
constexpr std::size_t kMaxThreads = 64;
constinit std::array<ThreadCalls, kMaxThreads> table{};
constinit std::atomic<std::size_t> threads_seen{0};

/// Number of the count under way; 0: none. Threads take part anew in each.
constinit std::atomic<std::uint32_t> counting{0};
constinit std::atomic<std::uint32_t> counts_made{0};
constinit std::atomic<bool> trapping{false};
constinit std::atomic<bool> countable{false};

/// This thread's entry in the count of that number. A model of TLS that is never allocated late.
struct Membership {
    std::uint32_t count = 0;
    ThreadCalls* entry = nullptr;
};
[[gnu::tls_model("initial-exec")]] constinit thread_local Membership membership;

bool IsOfFiles(std::string_view name) {
    return name.starts_with("src-") || name.starts_with("out-");
}

ThreadCalls& Join() {
    const std::size_t place = std::min(threads_seen.fetch_add(1), kMaxThreads - 1);
    ThreadCalls& entry = table[place];
    prctl(PR_GET_NAME, entry.name.data());
    entry.files = IsOfFiles(entry.name.data());
    return entry;
}

void Write(std::string_view text) {
    // Nothing can be done where stderr is gone.
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
}

[[noreturn]] void StopProgram(const ThreadName& thread) {
    counting = 0;
    Write("heap call after READY on thread '");
    Write(thread.data());
    Write("', called from:\n");
    std::array<void*, 32> callers{};
    const int depth = backtrace(callers.data(), static_cast<int>(callers.size()));
    backtrace_symbols_fd(callers.data(), depth, STDERR_FILENO);
    std::abort();
}

std::size_t EntriesSeen() {
    return std::min(threads_seen.load(), kMaxThreads);
}

}  // namespace

void StartCountingHeapCalls(OnHeapCall on_call) {
    StopCountingHeapCalls();
    // backtrace() loads a library on its first call, which takes memory.
    std::array<void*, 1> caller{};
    backtrace(caller.data(), 1);
    for (ThreadCalls& entry : table) entry.calls = 0;
    threads_seen = 0;
    trapping = on_call == OnHeapCall::kTrap;
    counting = ++counts_made;
}

void StopCountingHeapCalls() {
    counting = 0;
}

std::optional<HeapCallCounts> CountHeapCalls() {
    if (!countable) return std::nullopt;
    HeapCallCounts counts;
    for (std::size_t i = 0; i < EntriesSeen(); ++i) {
        const ThreadCalls& entry = table[i];
        (entry.files ? counts.files : counts.frame_path) += entry.calls;
        if (!entry.files) counts.threads.push_back({entry.name.data(), entry.calls});
    }
    return counts;
}

std::optional<std::uint64_t> HeapCallsOfFramePath() {
    if (!countable) return std::nullopt;
    std::uint64_t calls = 0;
    for (std::size_t i = 0; i < EntriesSeen(); ++i) {
        if (!table[i].files) calls += table[i].calls;
    }
    return calls;
}

void NoteHeapCall() {
    const std::uint32_t count = counting.load(std::memory_order_relaxed);
    if (count == 0) {
        countable.store(true, std::memory_order_relaxed);
        return;
    }
    if (membership.count != count) membership = {count, &Join()};
    ThreadCalls& mine = *membership.entry;
    mine.calls.fetch_add(1, std::memory_order_relaxed);
    if (!mine.files && trapping.load(std::memory_order_relaxed)) StopProgram(mine.name);
}

}  // namespace hitchview::app

#pragma once

#include <string>
#include <vector>

#include "hal/result.hpp"

namespace hitchview::app {

/// How the threads of the frame path are scheduled. Unset: as the kernel likes.
struct ThreadSchedule {
    int priority = 0;             ///< SCHED_FIFO, [1, 99]; 0: the usual scheduling
    std::vector<int> affinity{};  ///< CPUs they may run on; empty: all

    [[nodiscard]] bool given() const { return priority > 0 || !affinity.empty(); }
};

/// Sets what is set for the calling thread; threads that it starts later have it too. All of it is
/// tried; the error says what the kernel refused and what lets it through.
hal::Checked<hal::Done> Apply(const ThreadSchedule& schedule);

/// The calling thread gets the CPU when threads of the usual scheduling leave it some.
void RunInBackground();

/// At most 15 characters are kept, as the kernel does.
void NameThisThread(const std::string& name);

/// How many CPUs the calling thread may run on.
int UsableCpus();

/// Tells the CPU that the thread is waiting in a loop.
inline void RelaxCpu() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
}

}  // namespace hitchview::app

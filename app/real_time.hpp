#pragma once

#include <string>
#include <vector>

#include "app/config.hpp"
#include "hal/result.hpp"

/// What a run that must keep its deadlines asks of the kernel and of the C library. Each step says
/// why it was refused and what helps; none of them leaves anything half done. Each lasts until the
/// process ends.
namespace hitchview::app {

/// The heap gives nothing back and takes no mappings of its own, so that memory that was taken once
/// never faults again.
hal::Checked<hal::Done> KeepHeap();
/// Threads that start from now on have a stack that is small enough to be resident as a whole.
hal::Checked<hal::Done> BoundStacks();
/// Keeps all memory in RAM, what is taken later included.
hal::Checked<hal::Done> LockAllMemory();
/// Makes all memory that can be written resident: heap, pools, stacks of all threads, data of
/// libraries, and as much of the calling thread's stack as it may come to need.
hal::Checked<hal::Done> PrefaultMemory();

/// A step of the set-up and its outcome.
struct SetUpStep {
    const char* name;
    std::string refusal{};  ///< empty: done
};
/// One line for each, for the log.
void LogSteps(const std::vector<SetUpStep>& steps);

/// The steps that come before memory is taken and threads start. Error: a step that `config`
/// requires was refused.
hal::Checked<hal::Done> PrepareRealTime(const RealTimeConfig& config);
/// Those that come when all memory is taken and all threads run, on the pipeline's thread.
void EnterRealTime(const ThreadSchedule& pipeline);

}  // namespace hitchview::app

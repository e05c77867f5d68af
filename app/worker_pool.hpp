#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "algo/task_runner.hpp"
#include "app/thread_schedule.hpp"

namespace hitchview::app {

/// A fixed set of threads (`<name>-1` ...) that share the pieces of one job at a time with the
/// calling thread. A frame has many small jobs: a thread that has nothing to do looks for the next
/// one for some tens of microseconds before it sleeps, unless it would take the CPU from another
/// of the pool. Takes no memory after construction. Run: one caller at a time, fewer than 2^32
/// pieces.
class WorkerPool final : public algo::TaskRunner {
 public:
    /// `workers` >= 1 counts the calling thread: 1 makes no threads. Returns when the threads run,
    /// scheduled as asked for; the calling thread is left as it is.
    explicit WorkerPool(int workers, const ThreadSchedule& schedule = {},
                        const std::string& name = "worker");
    ~WorkerPool() override;
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    /// CPU time that its threads have taken; without the calling thread's.
    [[nodiscard]] std::chrono::nanoseconds cpu_time() const;

    /// What the kernel refused of the schedule, in words; empty if nothing.
    [[nodiscard]] const std::string& refusal() const { return refusal_; }

 private:
    void DoRun(int count, void (*piece)(void* context, int i), void* context) override;
    void Work(int index, const std::string& name, const ThreadSchedule& schedule);
    void TakePieces();
    template <typename Counter>
    void WaitWhile(const Counter& counter, std::uint32_t value) const;

    // What is open: number of the job << 32 | pieces that nobody has taken. The number keeps a
    // thread that was late for one job from taking a piece of another.
    alignas(64) std::atomic<std::uint64_t> open_{0};
    alignas(64) std::atomic<std::uint32_t> unfinished_{0};  // pieces of the job that have not ended
    alignas(64) std::atomic<std::uint32_t> jobs_{0};        // steps when there is something to do
    std::atomic<std::uint32_t> starting_{0};                // threads that do not run yet
    std::atomic<bool> stop_{false};

    // Of the job; constant while it has unfinished pieces.
    void (*piece_)(void* context, int i) = nullptr;
    void* context_ = nullptr;
    std::uint32_t count_ = 0;

    bool spins_;
    std::string refusal_;
    std::vector<std::thread> threads_;
};

}  // namespace hitchview::app

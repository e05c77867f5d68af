#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "algo/task_runner.hpp"

namespace hitchview::app {

/// A fixed set of threads that share the pieces of one job at a time with the calling thread.
/// Takes no memory after construction. Run: one caller at a time.
class WorkerPool final : public algo::TaskRunner {
 public:
    /// `workers` >= 1 counts the calling thread: 1 makes no threads.
    explicit WorkerPool(int workers);
    ~WorkerPool() override;
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

 private:
    void DoRun(int count, void (*piece)(void* context, int i), void* context) override;
    void Work(int index);
    void TakePieces();

    std::mutex mutex_;
    std::condition_variable started_;
    std::condition_variable ended_;
    std::uint64_t job_ = 0;
    int busy_ = 0;
    bool stop_ = false;

    void (*piece_)(void* context, int i) = nullptr;
    void* context_ = nullptr;
    int count_ = 0;
    std::atomic<int> next_{0};
    std::vector<std::thread> threads_;
};

}  // namespace hitchview::app

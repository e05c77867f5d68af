#include "app/worker_pool.hpp"

#include <pthread.h>

#include <string>

#include "hal/expect.hpp"

namespace hitchview::app {

WorkerPool::WorkerPool(int workers) {
    HV_EXPECT(workers >= 1);
    threads_.reserve(static_cast<std::size_t>(workers - 1));
    for (int i = 1; i < workers; ++i) threads_.emplace_back([this, i] { Work(i); });
}

WorkerPool::~WorkerPool() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    started_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::DoRun(int count, void (*piece)(void* context, int i), void* context) {
    {
        const std::lock_guard lock(mutex_);
        piece_ = piece;
        context_ = context;
        count_ = count;
        next_.store(0, std::memory_order_relaxed);
        busy_ = static_cast<int>(threads_.size());
        ++job_;
    }
    started_.notify_all();
    TakePieces();
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [this] { return busy_ == 0; });
}

void WorkerPool::Work(int index) {
    pthread_setname_np(pthread_self(), ("worker-" + std::to_string(index)).c_str());
    std::uint64_t done = 0;
    while (true) {
        {
            std::unique_lock lock(mutex_);
            started_.wait(lock, [&] { return stop_ || job_ != done; });
            if (stop_) return;
            done = job_;
        }
        TakePieces();
        const std::lock_guard lock(mutex_);
        if (--busy_ == 0) ended_.notify_one();
    }
}

void WorkerPool::TakePieces() {
    for (int i = next_.fetch_add(1); i < count_; i = next_.fetch_add(1)) piece_(context_, i);
}

}  // namespace hitchview::app

#include "app/worker_pool.hpp"

#include <pthread.h>

#include <algorithm>
#include <ctime>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

using std::chrono::steady_clock;

/// About what a thread costs to be put to sleep and woken up.
constexpr std::chrono::microseconds kLongestSpin{40};

constexpr std::uint32_t kEven = 4;  // shares per thread: the last ones even out the others

int CpusFor(const ThreadSchedule& schedule) {
    return schedule.affinity.empty() ? UsableCpus() : static_cast<int>(schedule.affinity.size());
}

std::uint32_t ShareOf(std::uint32_t left, std::size_t threads) {
    return std::max(1U, left / (kEven * static_cast<std::uint32_t>(threads)));
}

}  // namespace

WorkerPool::WorkerPool(int workers, const ThreadSchedule& schedule, const std::string& name)
    : starting_(static_cast<std::uint32_t>(workers - 1)), spins_(CpusFor(schedule) >= workers) {
    HV_EXPECT(workers >= 1);
    threads_.reserve(static_cast<std::size_t>(workers - 1));
    for (int i = 1; i < workers; ++i) {
        threads_.emplace_back([this, i, name, schedule] { Work(i, name, schedule); });
    }
    while (const std::uint32_t starting = starting_.load()) starting_.wait(starting);
}

WorkerPool::~WorkerPool() {
    stop_ = true;
    jobs_.fetch_add(1);
    jobs_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

std::chrono::nanoseconds WorkerPool::cpu_time() const {
    std::chrono::nanoseconds sum{0};
    for (const std::thread& thread : threads_) {
        clockid_t clock{};
        timespec taken{};
        // The threads live as long as this does, so their clocks can be read.
        HV_EXPECT(pthread_getcpuclockid(const_cast<std::thread&>(thread).native_handle(), &clock) ==
                  0);
        HV_EXPECT(clock_gettime(clock, &taken) == 0);
        sum += std::chrono::seconds(taken.tv_sec) + std::chrono::nanoseconds(taken.tv_nsec);
    }
    return sum;
}

void WorkerPool::DoRun(int count, void (*piece)(void* context, int i), void* context) {
    if (threads_.empty() || count <= 1) {
        for (int i = 0; i < count; ++i) piece(context, i);
        return;
    }
    piece_ = piece;
    context_ = context;
    count_ = static_cast<std::uint32_t>(count);
    unfinished_.store(count_, std::memory_order_relaxed);
    const std::uint64_t job = jobs_.load(std::memory_order_relaxed) + 1;
    open_.store(job << 32 | count_, std::memory_order_release);
    jobs_.fetch_add(1, std::memory_order_release);
    jobs_.notify_all();
    TakePieces();
    while (const std::uint32_t left = unfinished_.load(std::memory_order_acquire))
        WaitWhile(unfinished_, left);
}

void WorkerPool::Work(int index, const std::string& name, const ThreadSchedule& schedule) {
    NameThisThread(name + "-" + std::to_string(index));
    const auto applied = Apply(schedule);
    if (!applied && index == 1) refusal_ = applied.error();
    std::uint32_t seen = 0;
    if (starting_.fetch_sub(1) == 1) starting_.notify_all();
    while (!stop_) {
        WaitWhile(jobs_, seen);
        seen = jobs_.load(std::memory_order_acquire);
        TakePieces();
    }
}

/// Takes shares until there are none left. A share that was taken is of a job with unfinished
/// pieces, so what is read of the job then belongs to it.
void WorkerPool::TakePieces() {
    std::uint64_t open = open_.load(std::memory_order_acquire);
    while (const auto left = static_cast<std::uint32_t>(open)) {
        const std::uint32_t share = ShareOf(left, threads_.size() + 1);
        if (!open_.compare_exchange_weak(open, open - share, std::memory_order_acquire)) continue;
        const std::uint32_t first = count_ - left;
        for (std::uint32_t i = first; i < first + share; ++i) piece_(context_, static_cast<int>(i));
        if (unfinished_.fetch_sub(share, std::memory_order_acq_rel) == share)
            unfinished_.notify_one();
        open = open_.load(std::memory_order_acquire);
    }
}

/// Returns once the counter has another value.
template <typename Counter>
void WorkerPool::WaitWhile(const Counter& counter, std::uint32_t value) const {
    constexpr int kLooksPerTime = 32;
    if (spins_) {
        const auto until = steady_clock::now() + kLongestSpin;
        while (steady_clock::now() < until) {
            for (int i = 0; i < kLooksPerTime; ++i) {
                if (counter.load(std::memory_order_acquire) != value) return;
                RelaxCpu();
            }
        }
    }
    counter.wait(value, std::memory_order_acquire);
}

}  // namespace hitchview::app

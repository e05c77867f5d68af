#pragma once

namespace hitchview::algo {

/// Runs independent pieces of work, perhaps on several threads; the threads belong to the caller of
/// `algo`. The pieces must not depend on their order: the result is the same on any number of
/// threads.
class TaskRunner {
 public:
    virtual ~TaskRunner() = default;

    /// Calls work(0) ... work(count - 1) and returns when all have ended.
    template <typename Work>
    void Run(int count, Work&& work) {
        DoRun(
            count, [](void* context, int i) { (*static_cast<Work*>(context))(i); }, &work);
    }

 private:
    virtual void DoRun(int count, void (*piece)(void* context, int i), void* context) = 0;
};

/// Everything on the calling thread.
class SerialRunner final : public TaskRunner {
    void DoRun(int count, void (*piece)(void* context, int i), void* context) override {
        for (int i = 0; i < count; ++i) piece(context, i);
    }
};

}  // namespace hitchview::algo

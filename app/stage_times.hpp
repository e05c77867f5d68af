#pragma once

#include <array>
#include <chrono>
#include <string_view>

namespace hitchview::app {

/// The steps of one frame set that are timed. kTotal is the sum as the deadline sees it.
enum class Stage { kWatch, kMotion, kMap, kGains, kBands, kRender, kTotal };
inline constexpr int kStages = 7;

constexpr std::string_view ToString(Stage stage) {
    constexpr std::array<std::string_view, kStages> kNames{"watch", "motion", "map",  "gains",
                                                           "bands", "render", "total"};
    return kNames[static_cast<std::size_t>(stage)];
}

/// Times of one stage over the newest kWindow frame sets, in memory of its own.
class StageTimes {
 public:
    static constexpr std::size_t kWindow = 1024;

    void Add(std::chrono::nanoseconds duration);

    struct Summary {
        double last_ms = 0, p50_ms = 0, p99_ms = 0, max_ms = 0;
    };
    /// Of the window, but `max_ms` since the start; all 0 before the first Add. Takes no memory and
    /// some microseconds.
    [[nodiscard]] Summary Summarise() const;
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] double last_ms() const {
        return count_ == 0 ? 0 : window_ms_[(count_ - 1) % kWindow];
    }

 private:
    std::array<float, kWindow> window_ms_{};
    std::size_t count_ = 0;
    float max_ms_ = 0;
};

using AllStageTimes = std::array<StageTimes, kStages>;

/// Times of the panoramas on their way out.
struct PublishTimes {
    StageTimes jpeg;     ///< compression
    StageTimes send;     ///< of picture and status to the network
    StageTimes latency;  ///< from the start of the oldest exposure until it was sent; in real time
};

/// Adds the time from construction to destruction to a stage.
class StageTimer {
 public:
    explicit StageTimer(StageTimes& times)
        : times_(times), start_(std::chrono::steady_clock::now()) {}
    StageTimer(AllStageTimes& times, Stage stage)
        : StageTimer(times[static_cast<std::size_t>(stage)]) {}
    ~StageTimer() { times_.Add(std::chrono::steady_clock::now() - start_); }
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

 private:
    StageTimes& times_;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace hitchview::app

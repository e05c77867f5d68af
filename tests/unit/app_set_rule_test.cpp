#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>
#include <vector>

#include "app/set_rule.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;
using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Instant kPeriod{33'333'333};

/// How one simulated camera behaves.
struct CameraModel {
    Instant phase{};
    double drift = 0;       ///< of its clock
    Instant jitter{};       ///< of the exposure, at most
    Instant least_delay{};  ///< from exposure to delivery
    Instant delay_spread{};
    double lost_share = 0;
    Instant dead_from = Instant::max();  ///< delivers nothing from then on, and nobody is told
};

struct Arrival {
    Instant at;
    std::size_t camera;
    Instant captured_at;
};

struct MadeSet {
    Instant at;
    std::array<std::optional<Instant>, kMaxCameras> frames;

    [[nodiscard]] Instant newest() const {
        Instant newest = Instant::min();
        for (const auto& frame : frames) newest = std::max(newest, frame.value_or(newest));
        return newest;
    }
    [[nodiscard]] Instant spread() const {
        Instant oldest = Instant::max();
        for (const auto& frame : frames) oldest = std::min(oldest, frame.value_or(oldest));
        return newest() - oldest;
    }
    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(
            std::ranges::count_if(frames, [](const auto& frame) { return frame.has_value(); }));
    }
};

/// All frames of these cameras until `until`, in the order in which they come.
std::vector<Arrival> Arrivals(const std::vector<CameraModel>& cameras, Instant until,
                              std::mt19937& random) {
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<Arrival> arrivals;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const CameraModel& camera = cameras[i];
        const double period_ns = static_cast<double>(kPeriod.count()) * (1 + camera.drift);
        Instant last{};
        for (int frame = 0;; ++frame) {
            const auto part = [&](Instant whole) {
                return Instant(
                    static_cast<Instant::rep>(share(random) * static_cast<double>(whole.count())));
            };
            const Instant captured_at = camera.phase + part(camera.jitter) +
                                        Instant(static_cast<Instant::rep>(period_ns * frame));
            if (captured_at >= std::min(until, camera.dead_from)) break;
            const Instant at =
                std::max(last, captured_at + camera.least_delay + part(camera.delay_spread));
            last = at;
            if (share(random) >= camera.lost_share) arrivals.push_back({at, i, captured_at});
        }
    }
    std::ranges::stable_sort(arrivals, {}, &Arrival::at);
    return arrivals;
}

/// What a reader that is never busy gets: it asks when a frame comes, and when it was told to.
class Reader {
 public:
    Reader(std::size_t cameras, Instant tolerance) : cameras_(cameras), rule_(kPeriod, tolerance) {
        heard_at_.fill(Instant{});
    }

    std::vector<MadeSet> Read(const std::vector<Arrival>& arrivals) {
        for (const Arrival& arrival : arrivals) {
            while (ask_at_ < arrival.at) Ask(ask_at_);
            auto& queue = queues_[arrival.camera];
            if (queue.size() == 2) queue.pop_front();
            queue.push_back(arrival.captured_at);
            heard_at_[arrival.camera] = arrival.at;
            Ask(arrival.at);
        }
        return sets_;
    }

 private:
    void Ask(Instant now) {
        PendingFrames pending;
        for (std::size_t i = 0; i < cameras_; ++i) {
            if (!queues_[i].empty()) pending.heads[i] = queues_[i].front();
            pending.followed[i] = queues_[i].size() == 2;
            pending.awaited[i] = now - heard_at_[i] < 3 * kPeriod;
        }
        const SetRule::Verdict verdict = rule_.Judge(pending, now);
        const CameraMask done = verdict.taken | verdict.set_aside;
        EXPECT_TRUE(done.any() || verdict.ask_again_at > now) << "it would be asked for ever";
        if (verdict.taken.any()) sets_.push_back({now, {}});
        for (std::size_t i = 0; i < cameras_; ++i) {
            if (verdict.taken[i]) sets_.back().frames[i] = pending.heads[i];
            if (done[i]) queues_[i].pop_front();
        }
        ask_at_ = done.any() ? now : verdict.ask_again_at;
    }

    std::size_t cameras_;
    SetRule rule_;
    std::array<std::deque<Instant>, kMaxCameras> queues_;
    std::array<Instant, kMaxCameras> heard_at_{};
    Instant ask_at_ = Instant::max();
    std::vector<MadeSet> sets_;
};

std::vector<MadeSet> Sets(const std::vector<CameraModel>& cameras, Instant until, Instant tolerance,
                          std::mt19937& random) {
    return Reader(cameras.size(), tolerance).Read(Arrivals(cameras, until, random));
}

CameraModel RandomCamera(std::mt19937& random) {
    const auto within = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto ms = [&](double low, double high) {
        return Instant(static_cast<Instant::rep>(1e6 * within(low, high)));
    };
    CameraModel camera;
    camera.phase = ms(0, 33);
    camera.drift = within(-1e-3, 1e-3);
    camera.jitter = ms(0, 2);
    camera.least_delay = ms(2, 20);
    camera.delay_spread = ms(0, 12);
    camera.lost_share = within(0, 1) < 0.5 ? 0 : within(0, 0.3);
    if (within(0, 1) < 0.15) camera.dead_from = ms(0, 20'000);
    return camera;
}

class SetRulePropertyTest : public testing::TestWithParam<unsigned> {
 protected:
    SetRulePropertyTest() {
        const auto count = std::uniform_int_distribution<int>(1, kMaxCameras)(random_);
        for (int i = 0; i < count; ++i) cameras_.push_back(RandomCamera(random_));
        cameras_[0].dead_from = Instant::max();
        cameras_[0].lost_share = std::min(cameras_[0].lost_share, 0.05);
        tolerance_ = Instant(std::uniform_int_distribution<Instant::rep>(kPeriod.count() / 8,
                                                                         kPeriod.count())(random_));
        sets_ = Sets(cameras_, std::chrono::seconds(20), tolerance_, random_);
    }

    std::mt19937 random_{GetParam()};
    std::vector<CameraModel> cameras_;
    Instant tolerance_{};
    std::vector<MadeSet> sets_;
};

TEST_P(SetRulePropertyTest, NeverMixesFramesFurtherApartThanTheTolerance) {
    ASSERT_FALSE(sets_.empty());
    for (const MadeSet& set : sets_) {
        EXPECT_GE(set.count(), 1U);
        EXPECT_LE(set.spread(), tolerance_);
    }
}

TEST_P(SetRulePropertyTest, NeverStarvesNorShowsAFrameTwice) {
    std::array<Instant, kMaxCameras> newest{};
    newest.fill(Instant::min());
    Instant last{};
    for (const MadeSet& set : sets_) {
        // A period for a lost frame, one for patience, one for regrouping, and the delays.
        EXPECT_LE(set.at - last, 4 * kPeriod + milliseconds(40));
        last = set.at;
        for (std::size_t i = 0; i < kMaxCameras; ++i) {
            if (!set.frames[i]) continue;
            EXPECT_GT(*set.frames[i], newest[i]) << "camera " << i;
            newest[i] = *set.frames[i];
        }
    }
    EXPECT_GT(last, std::chrono::seconds(19));
}

INSTANTIATE_TEST_SUITE_P(Seeds, SetRulePropertyTest, testing::Range(0U, 60U));

std::vector<CameraModel> Triggered(int count) {
    std::vector<CameraModel> cameras(static_cast<std::size_t>(count));
    for (CameraModel& camera : cameras) {
        camera.phase = milliseconds(7);
        camera.jitter = microseconds(300);
        camera.least_delay = milliseconds(5);
        camera.delay_spread = milliseconds(9);
    }
    return cameras;
}

TEST(SetRuleTest, TriggeredCamerasMakeCompleteSetsOfOneTrigger) {
    std::mt19937 random(1);
    const auto sets = Sets(Triggered(8), std::chrono::seconds(10), kPeriod, random);
    EXPECT_GE(sets.size(), 298U);
    for (std::size_t i = 2; i < sets.size(); ++i) {
        EXPECT_EQ(sets[i].count(), 8U);
        EXPECT_LE(sets[i].spread(), microseconds(300));
    }
}

TEST(SetRuleTest, ALostFrameCostsItsCameraOneSetAndTheOthersNothing) {
    auto cameras = Triggered(8);
    cameras[3].lost_share = 0.1;
    std::mt19937 random(2);
    const auto sets = Sets(cameras, std::chrono::seconds(10), kPeriod / 2, random);
    const auto whole = std::ranges::count(sets, 8U, &MadeSet::count);
    const auto without_it = std::ranges::count(sets, 7U, &MadeSet::count);
    EXPECT_EQ(whole + without_it, static_cast<std::ptrdiff_t>(sets.size()));
    EXPECT_NEAR(static_cast<double>(without_it), 30, 15);
    EXPECT_GE(sets.size(), 285U);
}

TEST(SetRuleTest, ASetThatBeginsBetweenTwoGroupsIsRegroupedOnce) {
    // Six expose together, two just before; told apart by where the first set begins.
    std::vector<CameraModel> cameras = Triggered(8);
    cameras[2].phase = cameras[5].phase = milliseconds(7) + kPeriod - milliseconds(2);
    std::mt19937 random(3);
    const auto sets = Sets(cameras, std::chrono::seconds(3), kPeriod, random);
    ASSERT_GT(sets.size(), 80U);
    for (std::size_t i = 3; i < sets.size(); ++i) {
        EXPECT_LE(sets[i].spread(), milliseconds(3)) << i;
        EXPECT_EQ(sets[i].count(), 8U) << i;
    }
}

TEST(SetRuleTest, FreeRunningCamerasAtAnyPhaseAllGetIntoEverySet) {
    std::vector<CameraModel> cameras = Triggered(8);
    for (std::size_t i = 0; i < cameras.size(); ++i)
        cameras[i].phase = kPeriod * static_cast<int>(i) / 8;
    std::mt19937 random(4);
    const auto sets = Sets(cameras, std::chrono::seconds(10), kPeriod, random);
    EXPECT_GE(sets.size(), 295U);
    EXPECT_GE(std::ranges::count(sets, 8U, &MadeSet::count), 290);
}

TEST(SetRuleTest, ACameraThatKeepsOffTheTriggerIsMissingAndNotTheOthers) {
    for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
        std::vector<CameraModel> cameras = Triggered(8);
        const auto off = Instant(
            static_cast<Instant::rep>(share * static_cast<double>(kPeriod.count())));
        cameras[2].phase += off;
        std::mt19937 random(5);
        const auto sets = Sets(cameras, std::chrono::seconds(5), milliseconds(2), random);
        EXPECT_GE(sets.size(), 140U) << share;
        for (std::size_t i = 3; i < sets.size(); ++i) {
            EXPECT_EQ(sets[i].count(), 7U) << share << ' ' << i;
            EXPECT_FALSE(sets[i].frames[2]) << share << ' ' << i;
        }
    }
}

TEST(SetRuleTest, NoFramesNoSet) {
    SetRule rule(kPeriod, kPeriod);
    const auto verdict = rule.Judge({}, milliseconds(5));
    EXPECT_TRUE(verdict.taken.none());
    EXPECT_GT(verdict.ask_again_at, milliseconds(5));
}

}  // namespace
}  // namespace hitchview::app

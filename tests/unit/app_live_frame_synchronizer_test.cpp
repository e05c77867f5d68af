#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "app/live_frame_synchronizer.hpp"
#include "drivers/steady_clock.hpp"
#include "hal/fake_clock.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;
using std::chrono::milliseconds;
using namespace std::chrono_literals;

constexpr Instant kPeriod = milliseconds(10);

/// Gives a frame at each period of the clock, and can be unplugged.
class TickingCamera final : public hal::Camera {
 public:
    TickingCamera(hal::Clock& clock, Instant phase)
        : clock_(clock), next_(clock.Now() + phase), pool_({16, 16}, 8) {}

    void Plug(bool in) { plugged_ = in; }
    /// From now on its stamps stand still.
    void StopStamps() { stamps_stand_ = true; }
    /// Unplugged, for this reason.
    void Lose(hal::CameraLoss loss) {
        loss_ = loss;
        plugged_ = false;
    }
    /// Can be had again, and gives nothing, until it is plugged in.
    void Mute() {
        mute_ = true;
        plugged_ = false;
    }

 private:
    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return pool_.format(); }
    hal::Result<hal::FrameLease> DoWaitFrame(milliseconds /*timeout*/) override {
        clock_.SleepUntil(next_);
        if (!plugged_) return hal::Error::kDisconnected;
        if (!stamps_stand_) stamp_ = next_;
        const hal::FrameHeader header{sequence_++, stamp_};
        next_ = std::max(next_ + kPeriod, clock_.Now() - kPeriod);
        const auto slot = pool_.Take();
        if (!slot) return hal::Error::kTimeout;
        ++delivered_;
        return pool_.Lease(*slot, header);
    }
    hal::Result<hal::Done> DoReopen() override {
        if (!plugged_ && !mute_) return hal::Error::kNotFound;
        next_ = clock_.Now() + kPeriod;
        ++reopened_;
        return hal::Done{};
    }
    [[nodiscard]] hal::CameraLoss DoLoss() const override { return loss_; }
    [[nodiscard]] hal::CameraCounts DoCounts() const override {
        return {.delivered = delivered_, .reopened = reopened_};
    }

    hal::Clock& clock_;
    Instant next_;
    hal::FramePool pool_;
    std::atomic<bool> plugged_{true};
    std::atomic<bool> mute_{false};
    std::atomic<hal::CameraLoss> loss_{hal::CameraLoss::kSilent};
    std::atomic<std::uint64_t> delivered_{0};
    std::atomic<std::uint64_t> reopened_{0};
    std::atomic<bool> stamps_stand_{false};
    Instant stamp_{};
    std::uint32_t sequence_ = 0;
};

class LiveFrameSynchronizerTest : public testing::Test {
 protected:
    LiveFrameSynchronizerTest() {
        std::vector<LiveCamera> live;
        for (std::size_t i = 0; i < cameras_.size(); ++i) {
            const auto unit = i < 2 ? algo::Unit::kTractor : algo::Unit::kTrailer;
            live.push_back({&cameras_[i], "camera" + std::to_string(i), unit, i % 2});
        }
        sets_.emplace(live, events_, clock_, kPeriod, kPeriod);
    }

    /// Takes sets until one is as wanted; the number taken, or -1 if none of many was.
    template <typename Wanted>
    int TakeUntil(Wanted&& wanted) {
        for (int i = 0; i < 1000; ++i) {
            const auto answer = sets_->WaitSet();
            const FrameSet& set = answer.value();
            EXPECT_LE(set.captured_until - set.captured_from, kPeriod);
            EXPECT_TRUE(set.sequence > sequence_ || i == 0);
            sequence_ = set.sequence;
            if (wanted(set)) return i;
        }
        return -1;
    }
    int TakeUntilMissing(std::uint32_t cameras) {
        return TakeUntil([&](const FrameSet& set) { return set.cameras_missing == cameras; });
    }

    drivers::SteadyClock clock_;
    EventQueue events_;
    std::array<TickingCamera, 4> cameras_{
        TickingCamera(clock_, milliseconds(1)), TickingCamera(clock_, milliseconds(2)),
        TickingCamera(clock_, milliseconds(2)), TickingCamera(clock_, milliseconds(3))};
    std::optional<LiveFrameSynchronizer> sets_;
    std::uint32_t sequence_ = 0;
};

TEST_F(LiveFrameSynchronizerTest, FramesGetToTheirUnitsAndPlaces) {
    EXPECT_GE(TakeUntil([](const FrameSet& set) {
                  if (set.cameras_missing != 0) return false;
                  for (const algo::Unit unit : algo::kUnits) {
                      if (!set.leases[unit][0] || !set.leases[unit][1] || set.leases[unit][2])
                          return false;
                  }
                  return true;
              }),
              0);
}

TEST_F(LiveFrameSynchronizerTest, AnUnpluggedCameraIsMissingAndComesBack) {
    EXPECT_GE(TakeUntilMissing(0), 0);
    cameras_[2].Plug(false);
    EXPECT_GE(TakeUntilMissing(0b0100), 0);
    cameras_[2].Plug(true);
    EXPECT_GE(TakeUntilMissing(0), 0);
    sets_->Finish();
    EXPECT_EQ(sets_->Summarise().cameras[2].device.reopened, 1U);
}

TEST_F(LiveFrameSynchronizerTest, ACameraThatGoesIsToldOfOnceAndOnceThatItIsBack) {
    EXPECT_GE(TakeUntilMissing(0), 0);
    EXPECT_FALSE(events_.Take());
    cameras_[2].Plug(false);
    EXPECT_GE(TakeUntilMissing(0b0100), 0);
    cameras_[2].Plug(true);
    EXPECT_GE(TakeUntilMissing(0), 0);
    sets_->Finish();
    const auto lost = events_.Take();
    const auto back = events_.Take();
    ASSERT_TRUE(lost && back);
    EXPECT_EQ(lost->code, hal::EventCode::kCameraLost);
    EXPECT_EQ(lost->subject.view(), "camera2");
    EXPECT_EQ(lost->text.view(), "lost: silent");
    EXPECT_EQ(back->code, hal::EventCode::kCameraBack);
    EXPECT_EQ(back->subject.view(), "camera2");
    const auto away = std::chrono::duration_cast<milliseconds>(back->when - lost->when);
    EXPECT_EQ(back->text.view(), "back after " + std::to_string(away.count()) + " ms");
    EXPECT_FALSE(events_.Take());
}

TEST_F(LiveFrameSynchronizerTest, ACameraOfAnotherFormatDoesNotMatchTheCalibration) {
    EXPECT_GE(TakeUntilMissing(0), 0);
    cameras_[3].Lose(hal::CameraLoss::kOtherFormat);
    EXPECT_GE(TakeUntilMissing(0b1000), 0);
    sets_->Finish();  // the capture thread tells it after the set has been made
    const auto lost = events_.Take();
    const auto mismatch = events_.Take();
    ASSERT_TRUE(lost && mismatch);
    EXPECT_EQ(lost->code, hal::EventCode::kCameraLost);
    EXPECT_EQ(lost->text.view(), "lost: another format");
    EXPECT_EQ(mismatch->code, hal::EventCode::kCalibrationMismatch);
    EXPECT_EQ(mismatch->subject.view(), "camera3");
}

TEST_F(LiveFrameSynchronizerTest, ACameraThatCanBeHadAndGivesNothingIsNotBack) {
    EXPECT_GE(TakeUntilMissing(0), 0);
    cameras_[2].Mute();
    EXPECT_GE(TakeUntilMissing(0b0100), 0);
    while (cameras_[2].counts().reopened < 3) (void)sets_->WaitSet();
    EXPECT_EQ(events_.counts().happened[0], 1U);
    EXPECT_EQ(events_.counts().happened[1], 0U);
    cameras_[2].Plug(true);
    EXPECT_GE(TakeUntilMissing(0), 0);
    EXPECT_EQ(events_.counts().happened[0], 1U);
    EXPECT_EQ(events_.counts().happened[1], 1U);
}

TEST_F(LiveFrameSynchronizerTest, WithoutAnyCameraSetsGoOnEmpty) {
    for (TickingCamera& camera : cameras_) camera.Plug(false);
    ASSERT_GE(TakeUntilMissing(0b1111), 0);
    EXPECT_EQ(TakeUntilMissing(0b1111), 0) << "and the next one is as well";
    EXPECT_GE(sets_->counts().empty, 2U);
    cameras_[0].Plug(true);
    EXPECT_GE(TakeUntilMissing(0b1110), 0);
}

TEST_F(LiveFrameSynchronizerTest, WhereAllStampsStandStillSetsGoOnEmpty) {
    for (TickingCamera& camera : cameras_) camera.StopStamps();
    ASSERT_GE(TakeUntilMissing(0b1111), 0);
    EXPECT_EQ(TakeUntilMissing(0b1111), 0) << "and the next one is as well";
}

TEST_F(LiveFrameSynchronizerTest, WhereNothingCameNothingWasSkipped) {
    sets_->StartCounting();
    for (int i = 0; i < 10; ++i) (void)sets_->WaitSet();
    for (TickingCamera& camera : cameras_) camera.Plug(false);
    ASSERT_GE(TakeUntilMissing(0b1111), 0);
    for (TickingCamera& camera : cameras_) camera.Plug(true);
    ASSERT_GE(TakeUntilMissing(0), 0);
    EXPECT_LE(sets_->counts().skipped, 1U) << "a set may be cut short by the unplugging";
}

TEST_F(LiveFrameSynchronizerTest, EveryFrameIsAccountedFor) {
    for (int i = 0; i < 30; ++i) {
        (void)sets_->WaitSet();
        // Every third set takes longer than two periods.
        if (i % 3 == 0) clock_.SleepUntil(clock_.Now() + 2 * kPeriod + kPeriod / 2);
    }
    sets_->Finish();
    const LiveSummary summary = sets_->Summarise();
    EXPECT_GT(summary.sets.skipped, 0U);
    for (const LiveCameraSummary& camera : summary.cameras) {
        EXPECT_EQ(camera.device.delivered, camera.inbox.put);
        EXPECT_EQ(camera.inbox.put, camera.inbox.taken + camera.inbox.superseded +
                                        camera.inbox.set_aside + camera.inbox.pending);
        EXPECT_GT(camera.inbox.taken, 0U);
    }
}

TEST_F(LiveFrameSynchronizerTest, SetsAreCountedAndNumberedFromWhenTheProgramIsReady) {
    (void)sets_->WaitSet();
    clock_.SleepUntil(clock_.Now() + 10 * kPeriod);
    sets_->StartCounting();
    EXPECT_EQ(sets_->WaitSet().value().sequence, 0U);
    const SetCounts& counts = sets_->counts();
    EXPECT_EQ(counts.complete + counts.partial, 1U);
    EXPECT_EQ(counts.skipped, 0U);
}

/// Gives the frames that it is handed.
class HandedCamera final : public hal::Camera {
 public:
    void Hand(std::uint32_t sequence, Instant captured_at) {
        const std::lock_guard lock(mutex_);
        handed_.push_back({.sequence = sequence, .captured_at = captured_at});
        handed_one_.notify_one();
    }

 private:
    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return pool_.format(); }
    hal::Result<hal::FrameLease> DoWaitFrame(milliseconds timeout) override {
        std::unique_lock lock(mutex_);
        if (!handed_one_.wait_for(lock, timeout, [this] { return !handed_.empty(); }))
            return hal::Error::kTimeout;
        const hal::FrameHeader header = handed_.front();
        handed_.pop_front();
        return pool_.Lease(pool_.Take().value(), header);
    }

    std::mutex mutex_;
    std::condition_variable handed_one_;
    std::deque<hal::FrameHeader> handed_;
    hal::FramePool pool_{{16, 16}, 8};
};

/// Four cameras that begin when they like, one of them as long after the others as one set allows,
/// whose frames get to the inbox set by set.
class FreeCamerasTest : public testing::Test {
 protected:
    static constexpr std::array<std::chrono::microseconds, 4> kPhases{0us, 200us, 400us, 5600us};
    static constexpr std::size_t kLatest = 3;

    FreeCamerasTest() {
        std::vector<LiveCamera> live;
        for (std::size_t i = 0; i < cameras_.size(); ++i)
            live.push_back({&cameras_[i], std::to_string(i), algo::Unit::kTractor, i});
        sets_.emplace(live, events_, clock_, kPeriod, kPeriod);
        sets_->StartCounting();
    }

    void Hand(std::uint32_t sequence, std::optional<std::size_t> but = {}) {
        for (std::size_t i = 0; i < cameras_.size(); ++i) {
            if (i == but) continue;
            cameras_[i].Hand(sequence, (sequence + 1) * kPeriod + kPhases.at(i));
            ++handed_;
        }
        while (Put() < handed_) std::this_thread::yield();
    }
    [[nodiscard]] std::uint64_t Put() const {
        std::uint64_t put = 0;
        for (const LiveCameraSummary& camera : sets_->Summarise().cameras) put += camera.inbox.put;
        return put;
    }

    hal::FakeClock clock_;
    EventQueue events_;
    std::array<HandedCamera, kPhases.size()> cameras_;
    std::optional<LiveFrameSynchronizer> sets_;
    std::uint64_t handed_ = 0;
};

TEST_F(FreeCamerasTest, AFrameThatTheLatestOfThemLosesDoesNotLookLikeALostSet) {
    std::uint32_t sequence = 0;
    const auto expect_set = [&](std::uint32_t missing) {
        const auto set = sets_->WaitSet();
        EXPECT_EQ(set.value().sequence, sequence++);
        EXPECT_EQ(set.value().cameras_missing, missing);
    };
    for (int loss = 0; loss < 3; ++loss) {
        for (int i = 0; i < 15; ++i) {
            Hand(sequence);
            expect_set(0);
        }
        Hand(sequence, kLatest);
        Hand(sequence + 1);  // shows that a frame is lost
        expect_set(1U << kLatest);
        expect_set(0);
    }
    EXPECT_EQ(sets_->counts().skipped, 0U);
}

}  // namespace
}  // namespace hitchview::app

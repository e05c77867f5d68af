#include "app/camera_watch.hpp"

#include <gtest/gtest.h>

#include "app/faulty_camera.hpp"
#include "app/recorded_frame_synchronizer.hpp"
#include "hal/fake_clock.hpp"
#include "tests/support/fault_states.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/pattern_camera.hpp"

namespace hitchview::app {
namespace {

using hal::CameraState;
using hal::EventCode;
using hal::Instant;

constexpr Instant kPeriod{33'333'333};
constexpr std::size_t kCameras = 4;
constexpr std::size_t kFaulty = 1;

/// Cameras of which the second is faulty, watched set by set.
class Watched {
 public:
    explicit Watched(const std::vector<CameraFault>& faults,
                     const hal::FrameFormat& format = kFormat, std::size_t cameras = kCameras,
                     Instant patience = {}, Instant period = kPeriod)
        : period_(period) {
        std::vector<WatchedPicture> pictures;
        for (std::size_t i = 0; i < cameras; ++i) {
            const auto unit = i < 2 ? algo::Unit::kTractor : algo::Unit::kTrailer;
            std::unique_ptr<hal::Camera> camera = std::make_unique<tests::PatternCamera>(
                static_cast<std::uint32_t>(i), format, period);
            if (i == kFaulty) {
                camera = std::make_unique<FaultyCamera>(std::move(camera), faults,
                                                        FaultyCamera::Pace{nullptr, period}, 4);
            }
            pictures.push_back({"camera" + std::to_string(i), unit, cameras_[unit].size()});
            cameras_[unit].push_back(std::move(camera));
        }
        sets_.emplace(cameras_);
        watch_.emplace(pictures, period, events_, clock_, patience);
    }

    /// The next set, looked at. `change` befalls it before.
    template <typename Change>
    FrameSet Next(const Change& change) {
        clock_.Advance(period_);
        auto set = sets_->WaitSet();
        EXPECT_TRUE(set);
        change(*set);
        watch_->Look(*set);
        return std::move(*set);
    }
    FrameSet Next() {
        return Next([](FrameSet&) {});
    }
    /// Of the faulty camera after so many sets.
    CameraState After(int sets) {
        CameraState state = CameraState::kGood;
        for (int i = 0; i < sets; ++i) state = Next().camera_states[kFaulty];
        return state;
    }
    std::vector<EventCode> Told() {
        std::vector<EventCode> codes;
        while (const auto event = events_.Take()) {
            EXPECT_EQ(event->subject.view(), "camera1");
            codes.push_back(event->code);
        }
        return codes;
    }

    static constexpr hal::FrameFormat kFormat{160, 120, hal::PixelFormat::kNv12};

 private:
    Instant period_;
    hal::FakeClock clock_;
    EventQueue events_;
    Cameras cameras_;
    std::optional<RecordedFrameSynchronizer> sets_;
    std::optional<CameraWatch> watch_;
};

constexpr int kFrom = 10;
constexpr int kUntil = 160;  // five seconds

EventCode CodeOf(CameraState state) {
    switch (state) {
        case CameraState::kLost:
            return EventCode::kCameraLost;
        case CameraState::kLate:
            return EventCode::kCameraLate;
        case CameraState::kDisordered:
            return EventCode::kCameraDisordered;
        case CameraState::kBlack:
            return EventCode::kCameraBlack;
        case CameraState::kBlinded:
            return EventCode::kCameraBlinded;
        case CameraState::kFrozen:
            return EventCode::kCameraFrozen;
        case CameraState::kStuck:
            return EventCode::kCameraStuck;
        case CameraState::kBlurred:
            return EventCode::kCameraBlurred;
        case CameraState::kDirty:
            return EventCode::kCameraDirty;
        case CameraState::kGood:
            return EventCode::kCameraBack;
    }
    return EventCode::kCameraBack;
}

class EveryFaultTest : public testing::TestWithParam<FaultKind> {};

TEST_P(EveryFaultTest, IsNamedToldOnceAndOver) {
    Watched rig({{GetParam(), kFrom, kUntil}});
    EXPECT_EQ(rig.After(kFrom), CameraState::kGood);
    const CameraState state = tests::StateOf(GetParam());
    EXPECT_EQ(rig.After(kUntil - kFrom), state);
    EXPECT_EQ(rig.Told(), std::vector{CodeOf(state)});
    // Well again within a second.
    EXPECT_EQ(rig.After(30), CameraState::kGood);
    EXPECT_EQ(rig.Told(), std::vector{EventCode::kCameraBack});
    EXPECT_EQ(rig.After(60), CameraState::kGood);
    EXPECT_TRUE(rig.Told().empty());
}

TEST_P(EveryFaultTest, OldOrEmptyPicturesAreTakenOut) {
    Watched rig({{GetParam(), kFrom, kUntil}});
    rig.After(kUntil - 1);
    const FrameSet set = rig.Next();
    const bool shown = hal::IsShown(tests::StateOf(GetParam()));
    EXPECT_EQ(set.cameras_missing, shown ? 0U : 1U << kFaulty);
    const auto& leases = set.leases[algo::Unit::kTractor];
    EXPECT_TRUE(leases[0]);
    EXPECT_EQ(static_cast<bool>(leases[1]), shown);
}

TEST_P(EveryFaultTest, LookingTakesNoMemory) {
    Watched rig({{GetParam(), kFrom, kUntil}});
    rig.After(kFrom - 1);
    const auto before = tests::HeapCallsOfThisThread();
    for (int i = 0; i < 2 * kUntil; ++i) rig.Next();
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
}

INSTANTIATE_TEST_SUITE_P(CameraWatch, EveryFaultTest, testing::ValuesIn(kFaultKinds),
                         [](const auto& tested) { return std::string(ToString(tested.param)); });

class EveryFormatTest : public testing::TestWithParam<hal::PixelFormat> {};

TEST_P(EveryFormatTest, PicturesAreJudgedByTheirLuma) {
    for (const FaultKind kind : {FaultKind::kBlack, FaultKind::kBlinded, FaultKind::kFrozen,
                                 FaultKind::kBlurred, FaultKind::kDirty}) {
        Watched rig({{kind, kFrom, kUntil}}, {160, 120, GetParam()});
        EXPECT_EQ(rig.After(kUntil), tests::StateOf(kind)) << ToString(kind);
    }
}

INSTANTIATE_TEST_SUITE_P(CameraWatch, EveryFormatTest,
                         testing::Values(hal::PixelFormat::kUyvy, hal::PixelFormat::kYuyv,
                                         hal::PixelFormat::kGrey));

TEST(CameraWatchTest, AFrozenPictureIsShownForAtMostFourPeriods) {
    Watched rig({{FaultKind::kFrozen, kFrom, kUntil}});
    rig.After(kFrom + 1);  // the first of them is new
    int shown = 0;
    while (rig.Next().cameras_missing == 0 && shown < kUntil) ++shown;
    EXPECT_LE(shown, 4);
}

TEST(CameraWatchTest, ALateFrameIsShownNotEvenOnce) {
    Watched rig({{FaultKind::kLate, kFrom, kUntil}});
    rig.After(kFrom);
    for (int i = kFrom; i < kUntil; ++i)
        EXPECT_EQ(rig.Next().cameras_missing, 1U << kFaulty) << i;
}

TEST(CameraWatchTest, AShortFaultIsNoState) {
    for (const FaultKind kind : kFaultKinds) {
        Watched rig({{kind, kFrom, kFrom + 1}, {kind, kFrom + 20, kFrom + 21}});
        for (int i = 0; i < 60; ++i)
            EXPECT_EQ(rig.After(1), CameraState::kGood) << ToString(kind) << ' ' << i;
        EXPECT_TRUE(rig.Told().empty());
    }
}

TEST(CameraWatchTest, AFaultThatComesAndGoesIsOneState) {
    std::vector<CameraFault> faults;
    for (int from = kFrom; from < kUntil; from += 3)
        faults.push_back({FaultKind::kDamaged, from, from + 2});
    Watched rig(faults);
    rig.After(kUntil);
    EXPECT_EQ(rig.Told(), std::vector{EventCode::kCameraLost});
    EXPECT_EQ(rig.After(60), CameraState::kGood);
    EXPECT_EQ(rig.Told(), std::vector{EventCode::kCameraBack});
}

TEST(CameraWatchTest, OneFaultAfterAnotherIsToldAndOneEnd) {
    Watched rig({{FaultKind::kDead, kFrom, kUntil}, {FaultKind::kBlack, kUntil, 2 * kUntil}});
    rig.After(2 * kUntil);
    EXPECT_EQ(rig.After(60), CameraState::kGood);
    const auto told = rig.Told();
    ASSERT_GE(told.size(), 3U);
    EXPECT_EQ(told.front(), EventCode::kCameraLost);
    EXPECT_EQ(told.back(), EventCode::kCameraBack);
}

TEST(CameraWatchTest, WithoutOthersToCompareWithDetailIsNotJudged) {
    Watched rig({{FaultKind::kBlurred, kFrom, kUntil}}, Watched::kFormat, 2);
    rig.After(kUntil);
    EXPECT_TRUE(rig.Told().empty());
}

TEST(CameraWatchTest, ALossThatTheDeviceHasToldIsNotToldTwice) {
    Watched rig({});
    const auto take_out = [](FrameSet& set) {
        set.leases[algo::Unit::kTractor][1].Release();
        set.cameras_missing = set.cameras_gone = 1U << kFaulty;
    };
    for (int i = 0; i < 60; ++i) rig.Next(take_out);
    EXPECT_EQ(rig.Next(take_out).camera_states[kFaulty], CameraState::kLost);
    EXPECT_EQ(rig.After(30), CameraState::kGood);
    EXPECT_TRUE(rig.Told().empty());
}

TEST(CameraWatchTest, ADeviceThatIsHadAgainAndGivesNothingGoodIsToldToBeLostAgain) {
    Watched rig({}, Watched::kFormat, kCameras, CameraWatch::LivePatience(kPeriod));
    const auto without = [](std::uint32_t gone) {
        return [gone](FrameSet& set) {
            set.leases[algo::Unit::kTractor][1].Release();
            set.cameras_missing = 1U << kFaulty;
            set.cameras_gone = gone;
        };
    };
    for (int i = 0; i < 30; ++i) rig.Next(without(1U << kFaulty));
    rig.Next();  // the device has given a frame, and its capture thread told that it is back
    for (int i = 0; i < 40; ++i) rig.Next(without(0));
    EXPECT_TRUE(rig.Told().empty()) << "good frames may follow";
    for (int i = 0; i < 60; ++i) rig.Next(without(0));
    EXPECT_EQ(rig.Told(), std::vector{EventCode::kCameraLost});
    rig.After(30);
    EXPECT_EQ(rig.Told(), std::vector{EventCode::kCameraBack});
}

TEST(CameraWatchTest, OfLiveCamerasALossIsLeftToTheDeviceToTellFirst) {
    const std::vector<CameraFault> faults{{FaultKind::kSilent, 10, 40}, {FaultKind::kSilent, 100, 200}};
    Watched rig(faults, Watched::kFormat, kCameras, CameraWatch::LivePatience(kPeriod));
    rig.After(30);
    EXPECT_EQ(rig.After(1), CameraState::kLost);
    rig.After(60);
    EXPECT_TRUE(rig.Told().empty()) << "a second is over before anybody must tell";
    rig.After(105);
    EXPECT_EQ(rig.Told(), std::vector{EventCode::kCameraLost});
    rig.After(30);
    EXPECT_EQ(rig.Told(), std::vector{EventCode::kCameraBack});
}

TEST(CameraWatchTest, AtAnyRateALossIsLeftToTheDeviceForThePeriodsThatItTakes) {
    for (const int rate_hz : {5, 10, 15, 30, 60}) {
        const Instant period = std::chrono::nanoseconds(std::chrono::seconds(1)) / rate_hz;
        Watched rig({}, Watched::kFormat, kCameras, CameraWatch::LivePatience(period), period);
        const auto silent = [](std::uint32_t gone) {
            return [gone](FrameSet& set) {
                set.leases[algo::Unit::kTractor][1].Release();
                set.cameras_missing = 1U << kFaulty;
                set.cameras_gone = gone;
            };
        };
        constexpr int kToldByTheDevice = 30;  // sets
        for (int i = 0; i < kToldByTheDevice; ++i) rig.Next(silent(0));
        for (int i = 0; i < 30; ++i) rig.Next(silent(1U << kFaulty));
        EXPECT_TRUE(rig.Told().empty()) << rate_hz << " Hz: told by the device already";
    }
}

}  // namespace
}  // namespace hitchview::app

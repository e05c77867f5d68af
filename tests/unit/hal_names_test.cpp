#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "hal/camera.hpp"
#include "hal/camera_state.hpp"
#include "hal/event.hpp"
#include "hal/frame.hpp"
#include "hal/publisher.hpp"
#include "hal/result.hpp"

namespace hitchview::hal {
namespace {

constexpr std::array kErrors{Error::kTimeout,   Error::kEndOfStream, Error::kDisconnected,
                             Error::kCorrupted, Error::kUnsupported, Error::kNotFound,
                             Error::kTooLarge,  Error::kFailed};
constexpr std::array kLosses{CameraLoss::kDisconnected, CameraLoss::kSilent,
                             CameraLoss::kNoSignal,     CameraLoss::kOtherFormat,
                             CameraLoss::kIoError,      CameraLoss::kBusy,
                             CameraLoss::kForbidden};
constexpr std::array kSeamStates{SeamState::kNoOverlap, SeamState::kReacquire, SeamState::kCoast,
                                 SeamState::kLocked};

/// Of no enumeration; asked at run time.
int NoValue() {
    static volatile int none = 127;
    return none;
}

/// The names go into logs, messages and reports, where they are told apart by their text alone.
template <typename Value, std::size_t kCount>
void ExpectNamesOfTheirOwn(const std::array<Value, kCount>& values, const std::string& unknown) {
    std::set<std::string> names{unknown};
    for (const Value value : values)
        EXPECT_TRUE(names.insert(ToString(value)).second) << ToString(value);
    EXPECT_EQ(ToString(static_cast<Value>(NoValue())), unknown);
}

TEST(NamesTest, EachValueHasItsOwnAndNoValueHasNone) {
    ExpectNamesOfTheirOwn(kErrors, "unknown");
    ExpectNamesOfTheirOwn(kLosses, "unknown");
    ExpectNamesOfTheirOwn(kCameraStates, "unknown");
    ExpectNamesOfTheirOwn(kEventCodes, "unknown");
    ExpectNamesOfTheirOwn(kSeamStates, "UNKNOWN");
}

TEST(PixelFormatTest, AFormatThatDoesNotExistHasNoBytes) {
    constexpr std::array<std::uint8_t, 64> kBytes{};
    const FrameFormat none{4, 4, static_cast<PixelFormat>(NoValue()), Range::kFull};
    EXPECT_EQ(FrameBytes(none), 0U);
    for (const Plane& plane : PackedPlanes(none, kBytes.data())) EXPECT_EQ(plane.data, nullptr);
}

}  // namespace
}  // namespace hitchview::hal

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/config.hpp"

/// The video devices of this machine as `hitchview cameras` sees them.
namespace hitchview::app {

/// From `slowest_hz` to `fastest_hz`; the same twice: one rate.
struct OfferedRates {
    double slowest_hz = 0;
    double fastest_hz = 0;
};

/// From `smallest` to `largest`; the same twice: one size.
struct OfferedSizes {
    Size smallest{};
    Size largest{};
    std::vector<OfferedRates> rates{};  ///< empty: the device does not tell
};

struct OfferedFormat {
    std::string fourcc{};
    std::string name{};  ///< as in a rig file; empty: not a format that is taken
    std::string description{};
    std::vector<OfferedSizes> sizes{};  ///< empty: not taken, or the device does not tell
};

/// What is asked of a device.
struct CameraWish {
    LiveCameraConfig live{};  ///< as in a rig file; without a device: of whichever
    double rate_hz = 30;
};

/// What would be taken of the offers.
struct CameraPick {
    std::string format{};  ///< name as in a rig file
    Size size_px{};
    double rate_hz = 0;
    bool by_name = false;               ///< the rig file names the format
    std::vector<std::string> others{};  ///< formats that would do too, the best first
};

/// Of the processor, from one buffer of the device and from as much ordinary memory.
struct ReadSpeed {
    double buffer_gb_per_s = 0;
    double ordinary_gb_per_s = 0;
};

struct CameraDevice {
    enum class State {
        kFree,
        kBusy,       ///< a program streams from it
        kForbidden,  ///< this user may not open it
        kRefused,    ///< cannot be opened for another reason
    };
    enum class Stamps { kUnknown, kStartOfExposure, kEndOfFrame, kNotMonotonic };

    std::string path{};                ///< /dev/video0
    std::vector<std::string> names{};  ///< links that lead to it and last, best first
    std::string driver{};
    std::string card{};
    std::string bus{};
    State state = State::kFree;
    std::string refusal{};  ///< the system's words
    Stamps stamps = Stamps::kUnknown;
    std::vector<OfferedFormat> formats{};  ///< in the device's order
    std::optional<CameraPick> pick{};
    std::string no_pick{};             ///< what was wanted; with no pick only
    std::string unsettable{};          ///< of the wish's input, mirrors or controls; empty: nothing
    std::optional<ReadSpeed> speed{};  ///< where it was measured
    std::string not_measured{};        ///< why not, where it was tried

    [[nodiscard]] bool IsOpen() const { return state == State::kFree || state == State::kBusy; }
    /// `name` is its path, one of its names, or any other link to it.
    [[nodiscard]] bool IsNamed(const std::string& name) const;
};

/// free, busy, forbidden, refused.
const char* ToString(CameraDevice::State state);
/// unknown, start of exposure, end of frame, not monotonic.
const char* ToString(CameraDevice::Stamps stamps);
/// 29.97 -> "29.97", 30 -> "30".
std::string RateText(double rate_hz);
/// "1280x720".
std::string SizeText(const Size& size);
/// What the user can do about a device that is not open; empty for one that is.
std::string Remedy(const CameraDevice& device);

}  // namespace hitchview::app

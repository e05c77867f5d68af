#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/v4l2_controls.hpp"
#include "drivers/v4l2_device.hpp"
#include "drivers/v4l2_offers.hpp"
#include "drivers/v4l2_settings.hpp"

namespace hitchview::drivers {

struct V4l2CameraOptions {
    std::string name;  ///< in the log
    std::string path;  ///< /dev/v4l/by-path/..., a link of udev's, /dev/videoN
    V4l2Wish wish{{1280, 720}, 30, "best"};
    /// Frames that the program holds at a time, and three: one that the device fills, one that
    /// waits for it, one that is about to be lent. With fewer, frames are lost while all are lent.
    /// [2, 32].
    int buffers = 8;
    int input = -1;      ///< of a device with several; -1: the one selected
    int line_bytes = 0;  ///< from line to line at least, where a GPU asks for it; 0: as it is
    bool export_dmabuf = true;  ///< false: for a driver whose exported buffers are of no use
    V4l2Orientation orientation;
    std::vector<V4l2ControlWish> controls;
    /// Periods without a frame after which the stream is restarted once, and after as many more
    /// given up. >= 2.
    int silence_periods = 15;
};

/// What a device has agreed to.
struct V4l2Granted {
    V4l2Layout layout;
    double rate_hz = 0;
    bool rate_is_set = false;  ///< false: the device has no such setting, its rate is its own
    std::optional<hal::Instant> maybe_exposure;  ///< as it is now
};

/// Why a device cannot be had.
struct V4l2Refusal {
    std::string words;
    V4l2Failure failure{};
    /// What was asked of it is wrong, and stays so whenever the device is asked again.
    bool is_wish_wrong = false;
};

/// Brings a device to give what the options ask for, and to the same again when it comes back.
/// Thread: one at a time.
class V4l2Negotiation {
 public:
    V4l2Negotiation(const V4l2CameraOptions& options, V4l2Kernel& kernel)
        : options_(options), device_(kernel) {}

    /// Opens the device and chooses its format. The error names what was wanted, what was got and
    /// what is offered.
    hal::Result<V4l2Granted, V4l2Refusal> Agree();

    /// In place of Agree, for a device that is not there yet: what it may be expected to give.
    /// `others` have agreed. Where the options leave the format open it is the format of another
    /// of this size, or of any; controls are set as others set the same to the same value.
    V4l2Granted Expect(std::span<const V4l2Negotiation* const> others);

    /// The same format again, after the device was closed, or the one expected. kUnsupported:
    /// another device is there, or another format is all it gives. No memory from the heap.
    V4l2Result<V4l2Granted> AgreeAgain();

    [[nodiscard]] V4l2Device& device() { return device_; }
    [[nodiscard]] const V4l2Device& device() const { return device_; }
    /// As it was when it agreed first.
    [[nodiscard]] const V4l2Identity& identity() const { return identity_; }
    [[nodiscard]] const V4l2PixelFormat& pixel_format() const { return *pixel_format_; }
    /// The device tells when its source changes.
    [[nodiscard]] bool source_may_change() const { return input_.may_change; }

 private:
    V4l2Result<hal::Done> Connect();
    V4l2Result<V4l2Granted> Configure();
    hal::Result<hal::Done, V4l2Refusal> Choose();
    V4l2Result<hal::Done> Meet();
    [[nodiscard]] const V4l2Negotiation* MostLike(
        std::span<const V4l2Negotiation* const> others) const;
    [[nodiscard]] const V4l2ControlValue* FindValue(const V4l2ControlWish& wish) const;
    [[nodiscard]] hal::Checked<hal::Done> Check(const V4l2Granted& granted) const;
    [[nodiscard]] bool IsSameDevice() const;
    [[nodiscard]] bool IsSameFormat(const V4l2Granted& granted) const;

    V4l2CameraOptions options_;
    V4l2Device device_;
    V4l2Input input_;
    V4l2Identity identity_;
    const V4l2PixelFormat* pixel_format_ = nullptr;
    V4l2Mirrors mirrors_;  ///< of a device that was expected
    /// Of the orientation, unless it was expected; then of the wishes.
    std::vector<V4l2ControlValue> control_values_;
    bool met_ = false;            ///< it has been there once
    bool controls_known_ = true;  ///< false: a wish that no other camera has too
    bool has_exposure_ = false;
    V4l2Granted first_;
};

}  // namespace hitchview::drivers

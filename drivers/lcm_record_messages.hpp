#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/can_bus.hpp"
#include "hal/frame.hpp"

namespace hitchview::drivers {

// Messages that only recordings have: types in lcmtypes/ say what the values mean. Encoders write
// into memory of the caller, take none, and return the bytes written, 0 if they do not fit. Any
// thread.

/// A camera's frame as it goes into a log.
struct CameraPicture {
    std::int64_t utime_us = 0;  ///< of captured_at
    hal::FrameFormat format{};
    bool compressed = false;  ///< `data` is a JPEG; otherwise the frame, tightly packed, not I420
    std::uint32_t sequence = 0;
    hal::Instant captured_at{};
    std::span<const std::uint8_t> data{};
};
/// At least what the message takes.
std::size_t MostBytesOf(const CameraPicture& picture);
std::size_t Encode(const CameraPicture& picture, std::span<std::uint8_t> out);

inline constexpr std::size_t kMostCanFrameBytes = 256;
/// `bus`: at most 63 characters.
std::size_t Encode(const hal::CanFrame& frame, std::int64_t utime_us, const char* bus,
                   std::span<std::uint8_t> out);

inline constexpr std::size_t kClockBytes = 24;
std::size_t EncodeClock(std::int64_t utime_us, hal::Instant monotonic, std::span<std::uint8_t> out);

/// The rig that a log is recorded with.
struct RecordedRig {
    std::string rig_yaml{};
    std::string calibration_yaml{};
    std::string calibration_id{};
    std::vector<std::string> cameras{};  ///< names, in the order of the bits of cameras_missing
    std::vector<std::string> camera_channels{};  ///< as many
    double period_ms = 0;
};

/// The RIG message of a recording, encoded once; only its time is changed afterwards.
class RigMessage {
 public:
    explicit RigMessage(const RecordedRig& rig);
    /// Valid until the next call. Takes no memory.
    std::span<const std::uint8_t> At(std::int64_t utime_us);

 private:
    std::vector<std::uint8_t> bytes_;
};

}  // namespace hitchview::drivers

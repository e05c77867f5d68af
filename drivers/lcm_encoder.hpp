#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/clock.hpp"
#include "hal/publisher.hpp"

namespace hitchview::drivers {

class LcmImageProperties;

struct LcmEncoderOptions {
    std::string panorama_channel = "PANORAMA";
    std::string status_channel = "PANORAMA_STATUS";
    std::string hitch_angle_channel = "HITCH_ANGLE";
    std::string event_channel = "PANORAMA_EVENT";
    std::string health_channel = "PANORAMA_HEALTH";
    std::string overlay_channel = "PANORAMA_OVERLAY";
    int max_image_bytes = 1 << 20;  ///< largest JPEG. [1024, 8388608]
};

/// A message as LCM carries it; borrowed from the encoder until its next call.
struct LcmMessage {
    const char* channel = "";
    std::int64_t utime_us = 0;  ///< the message's own, since the epoch
    std::span<const std::uint8_t> bytes{};
};

/// What is published as messages: pictures as bot_core.image_t, all else as hitchview types.
/// Encodes into one buffer taken at construction and takes no memory. Hitch angles, events and
/// health are numbered in the order in which they come. Thread: one.
class LcmEncoder {
 public:
    /// `clock` must outlive the encoder. The error names what is outside its range.
    static hal::Checked<std::unique_ptr<LcmEncoder>> Create(const LcmEncoderOptions& options,
                                                            const hal::Clock& clock);

    /// kTooLarge: it does not fit max_image_bytes.
    hal::Result<LcmMessage> Encode(const hal::PanoramaImage& image);
    hal::Result<LcmMessage> Encode(const hal::PanoramaStatus& status);
    hal::Result<LcmMessage> Encode(const hal::HitchAngle& angle);
    hal::Result<LcmMessage> Encode(const hal::Event& event);
    hal::Result<LcmMessage> Encode(const hal::Health& health);
    hal::Result<LcmMessage> Encode(const hal::ViewportImage& viewport);
    hal::Result<LcmMessage> Encode(const hal::PreviewImage& preview);
    hal::Result<LcmMessage> Encode(const hal::Overlay& overlay);

 private:
    LcmEncoder(const LcmEncoderOptions& options, const hal::Clock& clock);

    hal::Result<LcmMessage> EncodeImage(const char* channel, const hal::PanoramaImage& image,
                                        LcmImageProperties& properties);
    template <typename Message>
    hal::Result<LcmMessage> Write(const char* channel, const Message& message,
                                  int (*encode)(void*, int, int, const Message*));

    LcmEncoderOptions options_;
    const hal::Clock& clock_;
    std::vector<std::uint8_t> buffer_;        // of images
    std::vector<std::uint8_t> other_buffer_;  // of all else
    std::uint32_t hitch_angle_sequence_ = 0;
    std::uint32_t event_sequence_ = 0;
    std::uint32_t health_sequence_ = 0;
};

}  // namespace hitchview::drivers

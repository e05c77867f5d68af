#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/lcm_handle.hpp"
#include "drivers/lcm_url.hpp"
#include "hal/clock.hpp"
#include "hal/publisher.hpp"

namespace hitchview::drivers {

/// Says that a publisher has started, and nothing else.
inline constexpr const char* kLcmStartChannel = "HITCHVIEW_START";

struct LcmPublisherOptions {
    std::string url = kDefaultLcmUrl;
    std::string panorama_channel = "PANORAMA";
    std::string status_channel = "PANORAMA_STATUS";
    std::string hitch_angle_channel = "HITCH_ANGLE";
    std::string event_channel = "PANORAMA_EVENT";
    int max_image_bytes = 1 << 20;  ///< largest JPEG. [1024, 8388608]
};

/// Panorama as bot_core.image_t, status, hitch angle and events as hitchview types, over LCM.
/// Messages are encoded into one buffer taken at construction; publishing takes no memory.
class LcmPublisher final : public hal::Publisher {
 public:
    /// Sends one empty message on kLcmStartChannel. `clock` must outlive the publisher.
    static hal::Checked<std::unique_ptr<LcmPublisher>> Create(const LcmPublisherOptions& options,
                                                              const hal::Clock& clock);

 private:
    LcmPublisher(const LcmPublisherOptions& options, LcmHandle lcm, const hal::Clock& clock);

    hal::Result<hal::Done> DoPublish(const hal::PanoramaImage& image) override;
    hal::Result<hal::Done> DoPublish(const hal::PanoramaStatus& status) override;
    hal::Result<hal::Done> DoPublish(const hal::HitchAngle& angle) override;
    hal::Result<hal::Done> DoPublish(const hal::Event& event) override;

    template <typename Message>
    hal::Result<hal::Done> Send(const std::string& channel, const Message& message,
                                int (*encode)(void*, int, int, const Message*));

    LcmPublisherOptions options_;
    LcmHandle lcm_;
    const hal::Clock& clock_;
    std::vector<std::uint8_t> buffer_;
    std::uint32_t hitch_angle_sequence_ = 0;
    std::uint32_t event_sequence_ = 0;
};

}  // namespace hitchview::drivers

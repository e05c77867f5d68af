#pragma once

#include <memory>
#include <string>

#include "drivers/lcm_encoder.hpp"
#include "drivers/lcm_handle.hpp"
#include "drivers/lcm_url.hpp"
#include "hal/publisher.hpp"

namespace hitchview::drivers {

/// Says that a publisher has started, and nothing else.
inline constexpr const char* kLcmStartChannel = "HITCHVIEW_START";

struct LcmPublisherOptions {
    std::string url = kDefaultLcmUrl;
    LcmEncoderOptions messages{};
};

/// Sends what an LcmEncoder makes of all that a publisher carries over LCM.
/// Publishing takes no memory.
class LcmPublisher final : public hal::Publisher {
 public:
    /// Sends one empty message on kLcmStartChannel. `clock` must outlive the publisher.
    static hal::Checked<std::unique_ptr<LcmPublisher>> Create(const LcmPublisherOptions& options,
                                                              const hal::Clock& clock);

 private:
    LcmPublisher(std::unique_ptr<LcmEncoder> encoder, LcmHandle lcm)
        : encoder_(std::move(encoder)), lcm_(std::move(lcm)) {}

    hal::Result<hal::Done> DoPublish(const hal::PanoramaImage& image) override {
        return Send(encoder_->Encode(image));
    }
    hal::Result<hal::Done> DoPublish(const hal::PanoramaStatus& status) override {
        return Send(encoder_->Encode(status));
    }
    hal::Result<hal::Done> DoPublish(const hal::HitchAngle& angle) override {
        return Send(encoder_->Encode(angle));
    }
    hal::Result<hal::Done> DoPublish(const hal::Event& event) override {
        return Send(encoder_->Encode(event));
    }
    hal::Result<hal::Done> DoPublish(const hal::Health& health) override {
        return Send(encoder_->Encode(health));
    }
    hal::Result<hal::Done> DoPublish(const hal::ViewportImage& viewport) override {
        return Send(encoder_->Encode(viewport));
    }
    hal::Result<hal::Done> DoPublish(const hal::PreviewImage& preview) override {
        return Send(encoder_->Encode(preview));
    }
    hal::Result<hal::Done> DoPublish(const hal::Overlay& overlay) override {
        return Send(encoder_->Encode(overlay));
    }
    hal::Result<hal::Done> Send(const hal::Result<LcmMessage>& message);

    std::unique_ptr<LcmEncoder> encoder_;
    LcmHandle lcm_;
};

}  // namespace hitchview::drivers

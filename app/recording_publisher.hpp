#pragma once

#include <memory>
#include <utility>

#include "app/recorder.hpp"
#include "drivers/lcm_encoder.hpp"
#include "hal/publisher.hpp"

namespace hitchview::app {

/// Records what is published, but for what is made of recorded pictures anyway: viewports, previews
/// and overlays. What the recording has no room for is its matter: it counts it.
class RecordingPublisher final : public hal::Publisher {
 public:
    /// `recorder` must outlive it.
    RecordingPublisher(std::unique_ptr<drivers::LcmEncoder> encoder, Recorder& recorder)
        : encoder_(std::move(encoder)), recorder_(recorder) {}

 private:
    hal::Result<hal::Done> DoPublish(const hal::PanoramaImage& image) override {
        return Keep(encoder_->Encode(image));
    }
    hal::Result<hal::Done> DoPublish(const hal::PanoramaStatus& status) override {
        return Keep(encoder_->Encode(status));
    }
    hal::Result<hal::Done> DoPublish(const hal::HitchAngle& angle) override {
        return Keep(encoder_->Encode(angle));
    }
    hal::Result<hal::Done> DoPublish(const hal::Event& event) override {
        recorder_.Note(event);
        return Keep(encoder_->Encode(event));
    }
    hal::Result<hal::Done> DoPublish(const hal::Health& health) override {
        hal::Health then = health;
        then.measured_at = recorder_.intake().Now();
        return Keep(encoder_->Encode(then));
    }
    hal::Result<hal::Done> Keep(const hal::Result<drivers::LcmMessage>& message) {
        if (!message) return message.error();
        recorder_.intake().Put(message.value());
        return hal::Done{};
    }

    std::unique_ptr<drivers::LcmEncoder> encoder_;
    Recorder& recorder_;
};

}  // namespace hitchview::app

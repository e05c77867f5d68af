#pragma once

#include <memory>
#include <utility>

#include "hal/publisher.hpp"

namespace hitchview::app {

/// Publishes everything twice. What the first one refuses is told, and goes to the second all the
/// same.
class TeePublisher final : public hal::Publisher {
 public:
    TeePublisher(std::unique_ptr<hal::Publisher> first, std::unique_ptr<hal::Publisher> second)
        : first_(std::move(first)), second_(std::move(second)) {}

 private:
    hal::Result<hal::Done> DoPublish(const hal::PanoramaImage& image) override {
        return Both(image);
    }
    hal::Result<hal::Done> DoPublish(const hal::PanoramaStatus& status) override {
        return Both(status);
    }
    hal::Result<hal::Done> DoPublish(const hal::HitchAngle& angle) override { return Both(angle); }
    hal::Result<hal::Done> DoPublish(const hal::Event& event) override { return Both(event); }
    hal::Result<hal::Done> DoPublish(const hal::Health& health) override { return Both(health); }
    hal::Result<hal::Done> DoPublish(const hal::ViewportImage& viewport) override {
        return Both(viewport);
    }
    hal::Result<hal::Done> DoPublish(const hal::PreviewImage& preview) override {
        return Both(preview);
    }
    hal::Result<hal::Done> DoPublish(const hal::Overlay& overlay) override { return Both(overlay); }

    template <typename Value>
    hal::Result<hal::Done> Both(const Value& value) {
        const auto outcome = first_->Publish(value);
        const auto other = second_->Publish(value);
        return outcome ? other : outcome;
    }

    std::unique_ptr<hal::Publisher> first_;
    std::unique_ptr<hal::Publisher> second_;
};

}  // namespace hitchview::app

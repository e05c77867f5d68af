#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/publisher.hpp"

namespace hitchview::hal {

/// Keeps a copy of what it was given, or counts it. Read the members when the publishing thread is
/// at rest.
class FakePublisher final : public Publisher {
 public:
    struct Image {
        PanoramaImage image;  ///< its borrowed parts are empty; the copies are below
        std::string calibration_id;
        std::vector<std::uint8_t> jpeg;
    };
    std::vector<Image> images;
    std::vector<PanoramaStatus> statuses;
    std::vector<HitchAngle> angles;
    std::vector<Event> events;
    std::vector<Health> healths;
    int viewports = 0;  ///< how many came; of these three nothing is kept
    int previews = 0;
    int overlays = 0;
    std::optional<Error> refusal;  ///< while set, every Publish answers this and keeps nothing

 private:
    Result<Done> DoPublish(const PanoramaImage& image) override {
        Image copy{
            image, std::string(image.calibration_id), {image.jpeg.begin(), image.jpeg.end()}};
        copy.image.calibration_id = {};
        copy.image.jpeg = {};
        return Keep(images, copy);
    }
    Result<Done> DoPublish(const PanoramaStatus& status) override { return Keep(statuses, status); }
    Result<Done> DoPublish(const HitchAngle& angle) override { return Keep(angles, angle); }
    Result<Done> DoPublish(const Event& event) override { return Keep(events, event); }
    Result<Done> DoPublish(const Health& health) override { return Keep(healths, health); }
    Result<Done> DoPublish(const ViewportImage& /*viewport*/) override { return Count(viewports); }
    Result<Done> DoPublish(const PreviewImage& /*preview*/) override { return Count(previews); }
    Result<Done> DoPublish(const Overlay& /*overlay*/) override { return Count(overlays); }

    template <typename T>
    Result<Done> Keep(std::vector<T>& kept, const T& message) {
        if (refusal) return *refusal;
        kept.push_back(message);
        return Done{};
    }
    Result<Done> Count(int& came) const {
        if (refusal) return *refusal;
        ++came;
        return Done{};
    }
};

}  // namespace hitchview::hal

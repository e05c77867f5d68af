#pragma once

#include <cstdint>
#include <optional>

#include "app/picture_age.hpp"
#include "hal/publisher.hpp"

namespace hitchview::app {

/// What a display unit would say of a panorama that came.
enum class PictureVerdict : std::uint8_t {
    kShown,     ///< it is good
    kRepeated,  ///< its number does not go on from the one before
    kOld,       ///< captured more than PictureJudge::kMaxAge ago, as PictureAge tells
    kNoCamera,  ///< no camera gives it a picture, or it is not known how many there are
};

/// Judges panoramas in the order in which they come. Thread: one.
class PictureJudge {
 public:
    static constexpr hal::Instant kMaxAge = std::chrono::seconds(1);

    /// `cameras`: of the rig; empty while it is not known, and then a panorama that lacks any is
    /// not called good.
    PictureVerdict Judge(const hal::PanoramaImage& image, hal::Instant now,
                         std::optional<int> cameras);

 private:
    PictureAge age_;
    std::optional<std::uint32_t> sequence_;
};

}  // namespace hitchview::app

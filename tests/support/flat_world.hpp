#pragma once

#include <optional>
#include <vector>

#include "algo/camera_frame.hpp"
#include "tests/support/nv12_picture.hpp"
#include "tests/support/sine_texture.hpp"

namespace hitchview::tests {

/// One frame set of a plane rig; owns its pixels.
struct PlaneFrames {
    std::vector<Nv12Picture> pictures;
    algo::RigFrames frames;
};

/// A flat grey world and the two cameras of a plane rig that look at it, without distance between
/// them: what both see is the same, shifted. Whole pixels.
class FlatWorld {
 public:
    FlatWorld(cv::Size view, std::uint64_t seed)
        : view_(view), world_(SineTexture(seed).Shifted({900, 420}, 0, 0)) {}

    /// Each unit sees the part of the world from this top-left pixel on; no picture without one.
    [[nodiscard]] PlaneFrames Look(const algo::PerUnit<std::optional<cv::Point>>& corner) const {
        PlaneFrames set;
        for (const algo::Unit unit : algo::kUnits) {
            if (!corner[unit]) continue;
            set.pictures.emplace_back(world_(cv::Rect(*corner[unit], view_)));
            set.frames[unit][0] = set.pictures.back().frame();
        }
        return set;
    }

 private:
    cv::Size view_;
    cv::Mat1b world_;
};

}  // namespace hitchview::tests

#pragma once

#include <array>
#include <span>
#include <vector>

#include "algo/camera_frame.hpp"

namespace hitchview::algo {

/// Grey of a small square of a camera's picture, in cells, so that a shifted edge shows.
struct GreyPatch {
    static constexpr int kCells = 2;   ///< to a side
    static constexpr int kCellPx = 4;  ///< camera px
    std::array<float, kCells * kCells> cell{};

    /// Mean absolute difference, grey levels.
    [[nodiscard]] float Difference(const GreyPatch& other) const;
};

/// Round pixel (x, y) of a picture, moved inwards where it would reach beyond the edge.
GreyPatch ReadGreyPatch(const CameraFrame& frame, float gain, float x, float y);
/// Has the memory of a patch that is read soon brought near: patches lie far apart in a picture.
void FetchGreyPatch(const CameraFrame& frame, float x, float y);

struct SeamCostOptions {
    float follow = 0.35F;       ///< share of the newest difference
    float motion_weight = 2;    ///< of how much the difference changes from frame to frame
    float motion_decay = 0.9F;  ///< per frame: what has moved by is not safe at once
    float bend_weight = 40;     ///< grey levels for a field that bends by 1 px per px
    float doubt_weight = 25;    ///< grey levels for a field that may be off by 1 px
    float unseen = 24;          ///< grey levels, where only one unit sees the scene
};

/// What the stitching field is like at a corner.
struct FieldRisk {
    float bend = 0;      ///< px per px
    float doubt_px = 0;  ///< how far it may be off
};

/// How much a change from one unit to the other would show, at each corner of a grid; grey levels.
/// It shows where the pictures differ, where the difference changes (something moves, and moves
/// differently in the two), and where the stitching field bends steeply: there it stretches over
/// an object that does not lie on the plane round it; and where the field may be wrong.
class SeamCost {
 public:
    SeamCost(int corners, const SeamCostOptions& options);

    /// One corner that both units see, once per frame.
    void ObserveBoth(std::size_t corner, const GreyPatch& tractor, const GreyPatch& trailer,
                     const FieldRisk& risk);
    void ObserveOne(std::size_t corner);

    [[nodiscard]] std::span<const float> cost() const { return cost_; }

 private:
    struct History {
        float newest = 0;
        float difference = 0;
        float motion = 0;
        bool known = false;
    };

    SeamCostOptions options_;
    std::vector<History> history_;
    std::vector<float> cost_;
};

}  // namespace hitchview::algo

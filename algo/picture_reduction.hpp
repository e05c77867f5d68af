#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algo/box_mean.hpp"
#include "algo/camera_frame.hpp"
#include "algo/task_runner.hpp"
#include "algo/unit_geometry.hpp"

namespace hitchview::algo {

/// Shrinks the pictures of cameras that have far more pixels than the canvas shows of them: what is
/// too fine to be shown would twinkle, and reading it costs. Memory is taken at construction; not
/// thread-safe.
class PictureReduction {
 public:
    /// Views of the units have the scale of the canvas.
    explicit PictureReduction(const PerUnit<std::optional<UnitGeometry>>& units);

    /// Camera pixels to one that is drawn, each way: 1, 2 or 4.
    [[nodiscard]] int side(Unit unit, int camera) const {
        return reduced_[unit][static_cast<std::size_t>(camera)].side;
    }

    /// The same pictures, those that are too fine made smaller: in memory of this, until the next
    /// call. Others are passed on as they are.
    const RigFrames& Update(const RigFrames& frames, TaskRunner& runner);

 private:
    struct Reduced {
        int side = 1;
        int width_px = 0;  ///< even
        int height_px = 0;
        std::vector<std::uint8_t> nv12;
        std::vector<BoxMean> means;  ///< one, where there is something to do
    };

    static void Allocate(const UnitGeometry& geometry, int camera, Reduced& reduced);
    static CameraFrame Reduce(const CameraFrame& frame, Reduced& reduced);

    PerUnit<std::array<Reduced, kMaxCameras>> reduced_;
    RigFrames frames_;
};

}  // namespace hitchview::algo

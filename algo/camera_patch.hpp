#pragma once

#include <Eigen/Core>

#include "algo/camera_frame.hpp"

namespace hitchview::algo {

/// A square of a camera's picture whose mean colour is wanted, looked at in kSamples x kSamples
/// places `step_px` apart. Its middle lies in the picture; where the square reaches outside, the
/// nearest samples count.
struct CameraPatch {
    static constexpr int kSamples = 4;

    const CameraFrame* frame = nullptr;
    float x_px = 0;
    float y_px = 0;
    int step_px = 1;

    /// Asks for the memory; worth it some time before the patch is read.
    void Prefetch() const;
    /// Luma, u, v as they are shown times `gain`, and 1. Grey where the camera has no colour.
    [[nodiscard]] Eigen::Array4f Mean(float gain) const;
};

}  // namespace hitchview::algo

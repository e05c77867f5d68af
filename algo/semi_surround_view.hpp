#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "algo/camera_frame.hpp"
#include "algo/grey_reduction.hpp"
#include "algo/unit_geometry.hpp"

namespace hitchview::algo {

/// One unit's cameras composed into one grey picture at reduced size, for motion estimation only
/// (paper, section 'Semi-Surround View'). No blending: each pixel comes from one camera, and the
/// mask leaves out the joints, where a feature could belong to neither.
class SemiSurroundView {
 public:
    /// Takes all memory. `scale`: analysis size / view size, (0, 1].
    SemiSurroundView(const UnitGeometry& geometry, double scale);

    /// Writes the view; a missing camera's part keeps the value 0 and is masked out.
    void Compose(const UnitFrames& frames, cv::Mat1b& view);

    /// Non-zero where features may lie in the last composed view.
    [[nodiscard]] const cv::Mat1b& mask() const { return mask_; }
    [[nodiscard]] int width_px() const { return calibrated_mask_.cols; }
    [[nodiscard]] int height_px() const { return calibrated_mask_.rows; }

    /// Pixel of the full-size view of a pixel of the analysis view, and back.
    [[nodiscard]] Eigen::Vector2d ToView(const Eigen::Vector2f& analysis) const {
        return (analysis.cast<double>().array() + 0.5) / scale_ - 0.5;
    }
    [[nodiscard]] Eigen::Vector2f ToAnalysis(const Eigen::Vector2d& view) const {
        return (((view.array() + 0.5) * scale_) - 0.5).cast<float>();
    }
    [[nodiscard]] double scale() const { return scale_; }
    /// Camera that the pixel nearest to `analysis` is taken from; empty where there is none.
    [[nodiscard]] std::optional<int> CameraAt(const Eigen::Vector2f& analysis) const;

 private:
    static constexpr std::uint8_t kNoCamera = 255;
    /// Where a pixel of the view lies in its camera's reduced picture: that many 1/32 px right of
    /// and below a pixel, which is given by its number.
    struct Source {
        std::int32_t offset = 0;
        std::uint8_t right = 0;
        std::uint8_t below = 0;
    };

    /// Pixels of one row of the view that come from one camera.
    struct Run {
        int y;
        int first;
        int end;
        int camera;
        bool copied;  ///< from as many pixels beside each other
    };

    void BuildMap(const UnitGeometry& geometry);
    void MaskJoints();
    void FindRuns();
    [[nodiscard]] Run RunFrom(int y, int first) const;
    void FindUsed();
    void Reduce(const CameraFrame& frame, int camera);
    void ComposeRun(const Run& run, cv::Mat1b& view) const;
    void UpdateMask(const UnitFrames& frames);

    int cameras_;
    double scale_;
    int reduction_ = 1;  ///< camera pixels per reduced pixel, a power of two
    GreyReduction reducer_;
    std::array<cv::Mat1b, kMaxCameras> reduced_;
    cv::Mat_<std::uint8_t> camera_;
    std::vector<Source> sources_;
    std::vector<Run> runs_;
    std::array<cv::Rect, kMaxCameras> used_;  ///< part of each reduced picture
    cv::Mat1b calibrated_mask_;
    cv::Mat1b mask_;
    unsigned masked_cameras_ = ~0U;
};

}  // namespace hitchview::algo

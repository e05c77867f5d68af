#pragma once

#include "algo/camera_frame.hpp"
#include "algo/composed_map.hpp"

namespace hitchview::algo {

/// Brightness of the cameras relative to each other, from what neighbours both see: minimises, over
/// the logarithms g of the gains,
///     sum_pairs n_ij (g_i + log I_ij - g_j - log I_ji)^2 + prior sum_i g_i^2
/// with I_ij the mean grey of camera i where it shares the scene with j (Brown and Lowe, IJCV
/// 2007), and follows the result slowly, so that nothing flickers.
class ExposureGains {
 public:
    explicit ExposureGains(double follow = 0.08) : follow_(follow) {}

    /// Looks at one corner of the map in 16, at others the next time; at first at one in four.
    void Update(const ComposedMap& map, const RigFrames& frames);
    void Reset();
    [[nodiscard]] CameraGains gains() const;

 private:
    static constexpr int kSources = 2 * static_cast<int>(kMaxCameras);
    using Table = Eigen::Matrix<double, kSources, kSources>;

    void Collect(const ComposedMap& map, const RigFrames& frames, Table& sum, Table& count) const;
    void MoveOn();

    double follow_;
    int first_row_ = 0;
    int first_col_ = 0;
    bool known_ = false;
    Eigen::Matrix<double, kSources, 1> log_gain_ = Eigen::Matrix<double, kSources, 1>::Zero();
};

}  // namespace hitchview::algo

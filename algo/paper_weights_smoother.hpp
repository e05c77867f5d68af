#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "algo/profile_smoothing.hpp"

namespace hitchview::algo {

/// The paper's stage 1 as causal smoothing of one path of three components: the frames emitted
/// before are fixed, and at each step the stabilisation energy is minimised over the newest frame
/// and the `lookahead` ones behind it; the newest is emitted. With the whole rest of a recording in
/// the lookahead this is stage 1 itself. All sums are of differences to the path at the newest
/// frame, so no absolute path is needed and nothing drifts. A steady pan is followed with a lag:
/// 13.1 frames with lambda 1.2 and no lookahead.
class PaperWeightsSmoother {
 public:
    /// lookahead_frames >= 0. All memory is taken here: about radius * lookahead^2 numbers.
    PaperWeightsSmoother(const ProfileSmoothingOptions& options, int lookahead_frames);

    /// What is known when frame t is emitted; relative to the path at t.
    struct Window {
        /// x_{t-1} - T_t, x_{t-2} - T_t, ...: as many as there were, at most radius_frames count.
        std::span<const Eigen::Vector3d> outputs;
        /// T_{t+1} - T_t, T_{t+2} - T_t, ...: fewer than the lookahead where the path ends.
        std::span<const Eigen::Vector3d> ahead;
    };

    /// The offset S_t = x_t - T_t. Takes no memory.
    [[nodiscard]] Eigen::Vector3d Next(const Window& window) const;

    /// S_t = sum of outputs(d) h(d) + sum of ahead(j) g(j), for so many outputs and frames ahead:
    /// h of outputs in their order, then g(0), which is of the path at t itself, then g of ahead.
    [[nodiscard]] std::span<const double> Taps(int outputs, int ahead) const;

 private:
    [[nodiscard]] std::vector<double> Solve(int outputs, int ahead) const;

    ProfileSmoothingOptions options_;
    int lookahead_frames_;
    std::vector<std::vector<double>> taps_;  // by outputs and frames ahead
};

/// The outputs emitted last, relative to the path at the newest frame: newest first, at most
/// `radius_frames`. Memory is taken at construction.
class OutputHistory {
 public:
    explicit OutputHistory(int radius_frames);

    /// The path moved by T_t - T_{t-1}: a new newest frame.
    void Move(const Eigen::Vector3d& motion);
    /// The newest frame was emitted with this offset.
    void Push(const Eigen::Vector3d& offset);
    void Reset() { count_ = 0; }

    [[nodiscard]] std::span<const Eigen::Vector3d> outputs() const {
        return {outputs_.data(), count_};
    }

 private:
    std::vector<Eigen::Vector3d> outputs_;
    std::size_t count_ = 0;
};

}  // namespace hitchview::algo

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "algo/camera_frame.hpp"
#include "algo/composed_map.hpp"
#include "algo/fixed_vector.hpp"
#include "algo/task_runner.hpp"

namespace hitchview::algo {

/// Multi-band blending (Burt and Adelson, 1983) of the cameras of a composed map, at the cost of
/// its corners near a joint. With L_k the picture of camera k, G_b its low pass of level b, m_k its
/// weights in the map and m_k^b those blurred like level b:
///     out = sum_k m_k (L_k - G_0 L_k) + sum_b sum_k m_k^(b+1) (G_b - G_(b+1)) L_k
///         = sum_k m_k (L_k + shift_k),   shift_k = B - G_0 L_k
/// where B, all bands but the finest, is smooth: it is known at the corners, and a renderer that
/// blends by the map's weights need only add shift_k, interpolated. Away from every joint shift_k
/// is 0. Level 0 is as coarse as a block of the map; what no camera shows has no weight.
class MultibandBlend {
 public:
    static constexpr int kLevels = 3;                  ///< coarse bands
    static constexpr int kReach = (1 << kLevels) - 1;  ///< corners to each side of a joint
    using Colour = Eigen::Array4f;                     ///< luma, u, v, nothing

    /// For maps of the size of `map`.
    explicit MultibandBlend(const ComposedMap& map);

    void Update(const ComposedMap& map, const RigPictures& pictures, TaskRunner& runner);

    /// False where nothing is added at any corner of a block.
    [[nodiscard]] bool Shifts(int row, int col) const {
        return (shown_[At(row, col)] | shown_[At(row, col + 1)] | shown_[At(row + 1, col)] |
                shown_[At(row + 1, col + 1)]) != 0;
    }
    /// Added to what a camera of the map shows at a corner, before it is weighted.
    [[nodiscard]] Colour shift(int source, int row, int col) const {
        const std::size_t at = At(row, col);
        if (!Shown(source, at)) return Colour::Zero();
        return coarse_[at] - finest_[static_cast<std::size_t>(source)][at];
    }

 private:
    static constexpr int kSources = 2 * static_cast<int>(kMaxCameras);
    using Masks = Eigen::Array<float, kSources, 1>;
    using Layer = std::vector<Colour>;  // per corner

    struct Neighbour {
        std::size_t at;
        float weight;
    };
    using Neighbours = FixedVector<Neighbour, 9>;

    void ReadMasks(const ComposedMap& map, const RigFrames& frames, int row);
    void FindJoints();
    [[nodiscard]] bool IsJoint(int row, int col) const;
    void WidenJoints(std::size_t first, std::size_t step, int count, bool round);
    void BlurMasks(int level, int row);
    void ReadColours(const ComposedMap& map, const RigPictures& pictures, int row);
    void AddBand(int level, int row);
    [[nodiscard]] Colour Blurred(int source, const Neighbours& neighbours) const;
    /// Those that lie on the grid, `spacing` apart, with the weights of (1 2 1) x (1 2 1).
    [[nodiscard]] Neighbours NeighboursOf(int row, int col, int spacing) const;
    [[nodiscard]] bool NearJoint(std::size_t at) const { return joint_[at] != Joint::kFar; }
    [[nodiscard]] bool Shown(int source, std::size_t at) const {
        return (shown_[at] >> source & 1U) != 0;
    }
    [[nodiscard]] std::size_t At(int row, int col) const {
        return static_cast<std::size_t>(row * cols_ + (col < cols_ ? col : 0));
    }

    enum class Joint : std::uint8_t { kFar, kHere, kBeside, kAbove };

    bool ring_;
    int sources_;
    int rows_;
    int cols_;                          // a ring's last column of corners is its first one
    std::vector<std::int8_t> most_;     // source with the largest share, -1: none
    std::vector<Joint> joint_;          // whether one is within reach
    std::vector<std::uint32_t> shown_;  // bit s: source s has a pixel, and a share within reach
    std::array<std::vector<Masks>, kLevels + 1> mask_;  // m, m^1, m^2 ...
    std::vector<Layer> finest_;                         // G_0, by source
    std::vector<Layer> level_;                          // G_b
    std::vector<Layer> next_level_;
    Layer coarse_;  // B
};

}  // namespace hitchview::algo

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
    static constexpr int kLevels = 3;  ///< coarse bands
    using Colour = Eigen::Array4f;     ///< luma, u, v, and 1 where there is a colour

    /// For maps of the size of `map`.
    explicit MultibandBlend(const ComposedMap& map);

    void Update(const ComposedMap& map, const RigPictures& pictures, TaskRunner& runner);

    /// False where nothing is added at any corner of a block.
    [[nodiscard]] bool Shifts(int row, int col) const {
        return (shown_[At(row, col)] | shown_[At(row, col + 1)] | shown_[At(row + 1, col)] |
                shown_[At(row + 1, col + 1)]) != 0;
    }
    /// Added to what a camera of the map shows at a corner, before it is weighted: luma, u, v.
    [[nodiscard]] Colour shift(int source, int row, int col) const {
        const std::size_t at = At(row, col);
        if (!Shown(source, at)) return Colour::Zero();
        return coarse_[at] - level_[0][static_cast<std::size_t>(source)][at];
    }

 private:
    static constexpr int kSources = 2 * static_cast<int>(kMaxCameras);
    /// Columns beside a row's first and last one, so that every corner has neighbours.
    static constexpr int kPad = 1 << (kLevels - 1);
    using Layer = std::vector<Colour>;  // per corner

    /// First corners of a row and of those that are blurred into it.
    struct Around {
        std::size_t above;
        std::size_t here;
        std::size_t below;
    };

    void ReadMasks(const ComposedMap& map, const RigFrames& frames, int row);
    void BlurMasks(std::size_t source);
    void FindShown(int row);
    void ReadColours(const ComposedMap& map, const RigPictures& pictures, int row);
    void AddBand(std::size_t level, int row);
    template <typename T>
    void Continue(T* row) const;
    [[nodiscard]] Around AroundRow(int row, int spacing) const;
    [[nodiscard]] static Colour Blurred(const Layer& layer, const Around& around, int col,
                                        int spacing);
    [[nodiscard]] bool Shown(int source, std::size_t at) const {
        return (shown_[at] >> source & 1U) != 0;
    }
    [[nodiscard]] std::size_t At(int row, int col) const {
        return static_cast<std::size_t>(row * stride_ + kPad + (col < cols_ ? col : 0));
    }

    bool ring_;
    int sources_;
    int rows_;
    int cols_;    // a ring's last column of corners is its first one
    int stride_;  // corners from one row to the next
    /// Bit s: source s has a pixel, and a share within reach that others share.
    std::vector<std::uint32_t> shown_;
    std::array<std::vector<std::vector<float>>, kLevels + 1> mask_;  // m, m^1, m^2 ... by source
    std::array<std::vector<Layer>, kLevels - 1> level_;  // G_0, G_1 ... by source; 0: not shown
    Layer coarse_;                                       // B
};

}  // namespace hitchview::algo

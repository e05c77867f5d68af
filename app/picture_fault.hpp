#pragma once

#include <cstdint>
#include <vector>

#include "algo/camera_frame.hpp"

namespace hitchview::app {

/// The luma of a picture that may be written.
struct WritableLuma {
    std::uint8_t* first = nullptr;
    int stride_bytes = 0;
    int step_bytes = 1;
    int cols = 0;
    int rows = 0;

    [[nodiscard]] std::uint8_t& at(int x, int y) const {
        return first[static_cast<std::ptrdiff_t>(y) * stride_bytes + x * step_bytes];
    }
};

/// Spoils pictures of one size as a lens or sensor would, with a sensor's noise: a picture is never
/// twice the same. Takes memory at construction only. Thread: one.
class PictureFault {
 public:
    PictureFault(int cols, int rows);

    void Blacken(const WritableLuma& luma);
    void Blind(const WritableLuma& luma);
    /// Out of focus by a fortieth of the width.
    void Blur(const WritableLuma& luma);
    /// Blurred and greyed behind three smears that stay where they are.
    void Smear(const WritableLuma& luma);

 private:
    void Reduce(const WritableLuma& luma);
    [[nodiscard]] float Blurred(int x, int y) const;
    /// -1, 0, 0 or 1.
    int Noise();

    int side_;  ///< of the squares that are averaged
    int grid_cols_;
    int grid_rows_;
    std::vector<float> grid_;
    std::uint32_t random_ = 0x9E3779B9;
};

}  // namespace hitchview::app

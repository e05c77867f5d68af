#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "algo/projection.hpp"

namespace hitchview::algo {

/// Distance between the corners of a fine regular grid over a canvas: even, and about as many
/// corners on a wide canvas as on a narrow one.
inline int CornerSpacing_px(const Projection& canvas) {
    return canvas.width_px > 2048 ? 16 : 8;
}

/// Something known at the corners of a fine regular grid over the canvas: corner (row, col) lies at
/// pixel (col spacing_px - 0.5, row spacing_px - 0.5). Memory is taken at construction.
template <typename T>
class CornerGrid {
 public:
    CornerGrid() = default;  ///< without corners
    CornerGrid(const Projection& canvas, const T& value)
        : spacing_px_(CornerSpacing_px(canvas)),
          rows_(CornersOver(canvas.height_px, spacing_px_)),
          cols_(CornersOver(canvas.width_px, spacing_px_)),
          values_(static_cast<std::size_t>(rows_ * cols_), value) {}

    /// Rows or columns of corners for this many pixels.
    static constexpr int CornersOver(int length_px, int spacing_px) {
        return (length_px + spacing_px - 1) / spacing_px + 1;
    }
    [[nodiscard]] int spacing_px() const { return spacing_px_; }
    [[nodiscard]] bool empty() const { return values_.empty(); }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] int cols() const { return cols_; }
    T& at(int row, int col) { return values_[Index(row, col)]; }
    const T& at(int row, int col) const { return values_[Index(row, col)]; }
    void Fill(const T& value) { std::fill(values_.begin(), values_.end(), value); }
    /// Without corners, like a new one; the memory stays for what is assigned later.
    void Clear() {
        rows_ = cols_ = 0;
        values_.clear();
    }

    [[nodiscard]] Eigen::Vector2d Pixel(int row, int col) const {
        return {1.0 * col * spacing_px_ - 0.5, 1.0 * row * spacing_px_ - 0.5};
    }

    /// Bilinear; outside the nearest edge's value. Not without corners.
    [[nodiscard]] T Sample(const Eigen::Vector2d& canvas_px) const {
        const double u = std::clamp((canvas_px.x() + 0.5) / spacing_px_, 0.0, cols_ - 1.0);
        const double v = std::clamp((canvas_px.y() + 0.5) / spacing_px_, 0.0, rows_ - 1.0);
        const int col = std::min(static_cast<int>(u), cols_ - 2);
        const int row = std::min(static_cast<int>(v), rows_ - 2);
        const auto s = static_cast<float>(u - col);
        const auto t = static_cast<float>(v - row);
        const T top = (1 - s) * at(row, col) + s * at(row, col + 1);
        const T bottom = (1 - s) * at(row + 1, col) + s * at(row + 1, col + 1);
        return (1 - t) * top + t * bottom;
    }

 private:
    [[nodiscard]] std::size_t Index(int row, int col) const {
        return static_cast<std::size_t>(row * cols_ + col);
    }

    int spacing_px_ = 0;
    int rows_ = 0;
    int cols_ = 0;
    std::vector<T> values_;
};

using CornerField = CornerGrid<Eigen::Vector2f>;
using CornerScalars = CornerGrid<float>;

}  // namespace hitchview::algo

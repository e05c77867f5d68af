#include "algo/view_on_canvas.hpp"

#include <algorithm>

namespace hitchview::algo {

using Eigen::Matrix3d;
using Eigen::Vector2d;

ViewOnCanvas::ViewOnCanvas(const Projection& view, const Projection& canvas)
    : view_(view),
      canvas_(canvas),
      rows_(view.height_px / kPitch_px + 2),
      cols_(view.width_px / kPitch_px + 2),
      nodes_(static_cast<std::size_t>(rows_ * cols_), Vector2d::Zero()) {}

void ViewOnCanvas::Update(const Matrix3d& M_canvas_view) {
    for (int row = 0; row < rows_; ++row) {
        for (int col = 0; col < cols_; ++col) {
            Vector2d& node = Node(row, col);
            node = canvas_.Pixel(M_canvas_view * view_.Ray(kPitch_px * Vector2d(col, row)));
            if (row == 0 && col == 0) continue;
            const Vector2d& before = col > 0 ? Node(row, col - 1) : Node(row - 1, col);
            node = before + canvas_.Difference(node, before);
        }
    }
}

Vector2d ViewOnCanvas::At(const Vector2d& view_px) const {
    const int col = std::clamp(static_cast<int>(view_px.x()) / kPitch_px, 0, cols_ - 2);
    const int row = std::clamp(static_cast<int>(view_px.y()) / kPitch_px, 0, rows_ - 2);
    const double s = view_px.x() / kPitch_px - col;
    const double t = view_px.y() / kPitch_px - row;
    const Vector2d* top = nodes_.data() + static_cast<std::ptrdiff_t>(row) * cols_ + col;
    const Vector2d* bottom = top + cols_;
    return (1 - t) * ((1 - s) * top[0] + s * top[1]) + t * ((1 - s) * bottom[0] + s * bottom[1]);
}

}  // namespace hitchview::algo

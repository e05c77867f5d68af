#include "algo/picture_map.hpp"

#include <algorithm>

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

/// A finer picture bends no more over as many pixels.
int PitchFor(const Projection& from) {
    return from.width_px > 2048 ? 32 : 16;
}

}  // namespace

PictureMap::PictureMap(const Projection& from, const Projection& to)
    : to_(to),
      to_mesh_(to),
      pitch_px_(PitchFor(from)),
      nodes_per_px_(1.0 / pitch_px_),
      rows_(from.height_px / pitch_px_ + 2),
      cols_(from.width_px / pitch_px_ + 2),
      nodes_(static_cast<std::size_t>(rows_ * cols_), Vector2d::Zero()) {
    for (int row = 0; row < rows_; ++row) {
        for (int col = 0; col < cols_; ++col)
            rays_.push_back(from.Ray(pitch_px_ * Vector2d(col, row)));
    }
}

void PictureMap::Update(const Matrix3d& M_to_from, TaskRunner& runner) {
    UpdateWith(M_to_from, nullptr, runner);
}

void PictureMap::Update(const Matrix3d& M_to_from, const VertexField& offset, TaskRunner& runner) {
    UpdateWith(M_to_from, &offset, runner);
}

void PictureMap::UpdateWith(const Matrix3d& M_to_from, const VertexField* offset,
                            TaskRunner& runner) {
    runner.Run(rows_, [&](int row) { PlaceRow(M_to_from, offset, row); });
    Unwrap();
}

void PictureMap::PlaceRow(const Matrix3d& M_to_from, const VertexField* offset, int row) {
    for (int col = 0; col < cols_; ++col) {
        Vector2d& node = nodes_[Index(row, col)];
        node = to_.Pixel(M_to_from * rays_[Index(row, col)]);
        if (offset != nullptr) node -= Sample(to_mesh_, *offset, node);
    }
}

void PictureMap::Unwrap() {
    if (!to_.IsRing()) return;
    for (int row = 0; row < rows_; ++row) {
        for (int col = row == 0 ? 1 : 0; col < cols_; ++col) {
            const Vector2d& before = nodes_[col > 0 ? Index(row, col - 1) : Index(row - 1, col)];
            Vector2d& node = nodes_[Index(row, col)];
            node = before + to_.Difference(node, before);
        }
    }
}

Vector2d PictureMap::At(const Vector2d& pixel) const {
    const double u = pixel.x() * nodes_per_px_;
    const double v = pixel.y() * nodes_per_px_;
    const int col = std::clamp(static_cast<int>(u), 0, cols_ - 2);
    const int row = std::clamp(static_cast<int>(v), 0, rows_ - 2);
    const double s = u - col;
    const double t = v - row;
    const Vector2d* top = nodes_.data() + Index(row, col);
    const Vector2d* bottom = top + cols_;
    return (1 - t) * ((1 - s) * top[0] + s * top[1]) + t * ((1 - s) * bottom[0] + s * bottom[1]);
}

}  // namespace hitchview::algo

#include "algo/picture_map.hpp"

#include <cmath>

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
      nodes_(static_cast<std::size_t>(rows_ * cols_), Eigen::Vector2f::Zero()) {
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
        Vector2d place = to_.Pixel(M_to_from * rays_[Index(row, col)]);
        if (offset != nullptr) place -= Sample(to_mesh_, *offset, place);
        nodes_[Index(row, col)] = place.cast<float>();
    }
}

void PictureMap::Unwrap() {
    if (!to_.IsRing()) return;
    const auto width_px = static_cast<float>(to_.width_px);
    for (int row = 0; row < rows_; ++row) {
        for (int col = row == 0 ? 1 : 0; col < cols_; ++col) {
            const float before_x = nodes_[col > 0 ? Index(row, col - 1) : Index(row - 1, col)].x();
            float& x = nodes_[Index(row, col)].x();
            x -= width_px * std::round((x - before_x) / width_px);
        }
    }
}

}  // namespace hitchview::algo

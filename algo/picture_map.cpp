#include "algo/picture_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// A finer picture bends no more over as many pixels.
int PitchFor(const Projection& from) {
    return from.width_px > 2048 ? 32 : 16;
}

/// Rays, and then the pixels where they lie.
struct RayRun {
    static constexpr int kMost = 64;
    template <typename T>
    using Of = std::array<T, kMost>;

    alignas(64) Of<double> x;
    alignas(64) Of<double> y;
    alignas(64) Of<double> z;
    int count;
};

void Turn(const Matrix3d& M_to_from, const Vector3d* from, RayRun& rays) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(rays.count); ++i) {
        const Vector3d ray = M_to_from * from[i];
        rays.x[i] = ray.x();
        rays.y[i] = ray.y();
        rays.z[i] = ray.z();
    }
}

/// atan(t) / t for t^2 in 0..1, to 1e-8: a polynomial through nine Chebyshev points.
inline double ArcTangentShare(double t2) {
    constexpr std::array<double, 9> kCoefficients{0.9999999818,  -0.3333303671,  0.1999187203,
                                                  -0.1419779779, 0.1061837064,   -0.07456854826,
                                                  0.04213762359, -0.01573124912, 0.002766283501};
    double sum = kCoefficients[8];
    for (std::size_t i = 8; i-- > 0;) sum = sum * t2 + kCoefficients[i];
    return sum;
}

/// Projection::Pixel of a cylinder, to 1e-4 px, with columns that may be a turn off.
HV_MULTIVERSION
void PlaceOnCylinder(const Projection& cylinder, RayRun& rays) {
    const double focal_px = cylinder.focal_px;
    const double horizon_y_px = cylinder.horizon_y_px;
    const double front_x_px = cylinder.Centre().x() + focal_px * cylinder.azimuth_centre_rad;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rays.count); ++i) {
        const double x = rays.x[i];
        const double y = rays.y[i];
        const double along = std::abs(x);
        const double beside = std::abs(y);
        const double t = std::min(along, beside) / std::max(1e-12, std::max(along, beside));
        const double octant = t * ArcTangentShare(t * t);
        const double quadrant = beside > along ? 0.5 * std::numbers::pi - octant : octant;
        const double half = x < 0 ? std::numbers::pi - quadrant : quadrant;
        const double across = std::sqrt(std::max(1e-18, x * x + y * y));
        rays.x[i] = front_x_px - focal_px * (y < 0 ? -half : half);
        rays.y[i] = horizon_y_px - focal_px * rays.z[i] / across;
    }
}

void PlaceOnPlane(RayRun& rays) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(rays.count); ++i) {
        rays.x[i] /= rays.z[i];
        rays.y[i] /= rays.z[i];
    }
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
    RayRun run;
    for (int first = 0; first < cols_; first += RayRun::kMost) {
        run.count = std::min(RayRun::kMost, cols_ - first);
        const std::size_t at = Index(row, first);
        Turn(M_to_from, rays_.data() + at, run);
        if (to_.IsRing()) {
            PlaceOnCylinder(to_, run);
        } else {
            PlaceOnPlane(run);
        }
        for (std::size_t i = 0; i < static_cast<std::size_t>(run.count); ++i) {
            Vector2d place(run.x[i], run.y[i]);
            if (offset != nullptr) place -= Sample(to_mesh_, *offset, place);
            nodes_[at + i] = place.cast<float>();
        }
    }
}

void PictureMap::Unwrap() {
    if (!to_.IsRing()) return;
    const auto width_px = static_cast<float>(to_.width_px);
    for (int row = 0; row < rows_; ++row) {
        for (int col = row == 0 ? 1 : 0; col < cols_; ++col) {
            const float before_x = nodes_[col > 0 ? Index(row, col - 1) : Index(row - 1, col)].x();
            float& x = nodes_[Index(row, col)].x();
            if (std::abs(x - before_x) <= 0.5F * width_px) continue;  // as most are
            x -= width_px * std::round((x - before_x) / width_px);
        }
    }
}

}  // namespace hitchview::algo

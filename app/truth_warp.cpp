#include "app/truth_warp.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <optional>

namespace hitchview::app {
namespace {

using algo::ComposedMap;
using algo::Unit;
using Eigen::Matrix2d;
using Eigen::Vector2d;

bool Shows(const ComposedMap& map, const RigGeometry& geometry, int source,
           const ComposedMap::Corner& corner) {
    const algo::UnitGeometry& unit = *geometry.units[map.unit_of(source)];
    const int camera = map.camera_of(source);
    return corner.sees && corner.x >= 0 && corner.y >= 0 &&
           corner.x <= static_cast<float>(unit.camera_width_px(camera) - 1) &&
           corner.y <= static_cast<float>(unit.camera_height_px(camera) - 1);
}

/// Pixel of the ray on the canvas if nothing moved, from any camera that shows it.
std::optional<Vector2d> Unmoved(const ComposedMap& map, const RigGeometry& geometry, Unit unit,
                                int row, int col) {
    for (int s = 0; s < map.cameras(); ++s) {
        const ComposedMap::Corner& corner = map.corner(s, row, col);
        if (map.unit_of(s) != unit || !Shows(map, geometry, s, corner)) continue;
        const auto ray =
            geometry.units[unit]->ViewRay(map.camera_of(s), Vector2d(corner.x, corner.y));
        if (ray) return geometry.canvas.Pixel(*ray);
    }
    return std::nullopt;
}

/// Of the cell's two edges in each direction, averaged.
Matrix2d JacobianOf(const WarpGrid& warp, int row, int col) {
    const Vector2d& a = warp.motion_px[warp.At(row, col)];
    const Vector2d& b = warp.motion_px[warp.At(row, col + 1)];
    const Vector2d& c = warp.motion_px[warp.At(row + 1, col)];
    const Vector2d& d = warp.motion_px[warp.At(row + 1, col + 1)];
    Matrix2d jacobian = Matrix2d::Identity();
    jacobian.col(0) += 0.5 / warp.spacing_px * (b - a + d - c);
    jacobian.col(1) += 0.5 / warp.spacing_px * (c - a + d - b);
    return jacobian;
}

double StretchRatio(const Matrix2d& jacobian) {
    const Vector2d stretches = jacobian.jacobiSvd().singularValues();
    return stretches[0] > 0 ? stretches[1] / stretches[0] : 0;
}

double Cross(const Vector2d& a, const Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

bool Folded(const WarpGrid& warp, int row, int col) {
    const double s = warp.spacing_px;
    const Vector2d& a = warp.motion_px[warp.At(row, col)];
    const Vector2d& b = warp.motion_px[warp.At(row, col + 1)];
    const Vector2d& c = warp.motion_px[warp.At(row + 1, col)];
    const Vector2d& d = warp.motion_px[warp.At(row + 1, col + 1)];
    const Vector2d right(s, 0);
    const Vector2d down(0, s);
    return Cross(right + b - a, down + c - a) <= 0 || Cross(right + d - c, down + d - b) <= 0;
}

Vector2d CanvasPixel(const WarpGrid& warp, int row, int col) {
    return {col * warp.spacing_px - 0.5, row * warp.spacing_px - 0.5};
}

}  // namespace

WarpGrid::WarpGrid(int row_count, int col_count, double spacing)
    : rows(row_count),
      cols(col_count),
      spacing_px(spacing),
      motion_px(static_cast<std::size_t>(rows * cols), Vector2d::Zero()),
      known(static_cast<std::size_t>(rows * cols), 0) {}

bool WarpGrid::HasCell(int row, int col) const {
    return known[At(row, col)] != 0 && known[At(row, col + 1)] != 0 &&
           known[At(row + 1, col)] != 0 && known[At(row + 1, col + 1)] != 0;
}

bool HasData(const ComposedMap& map, const RigGeometry& geometry, Unit unit, int row, int col,
             std::uint32_t missing) {
    for (int s = 0; s < map.cameras(); ++s) {
        const bool present = (missing >> s & 1U) == 0;
        if (map.unit_of(s) == unit && present && Shows(map, geometry, s, map.corner(s, row, col)))
            return true;
    }
    return false;
}

bool IsRendered(const ComposedMap& map, const RigGeometry& geometry, int row, int col,
                std::uint32_t missing) {
    for (int s = 0; s < map.cameras(); ++s) {
        const ComposedMap::Corner& corner = map.corner(s, row, col);
        const bool present = (missing >> s & 1U) == 0;
        if (present && corner.weight > 0 && Shows(map, geometry, s, corner)) return true;
    }
    return false;
}

WarpGrid WarpOf(const ComposedMap& map, const RigGeometry& geometry, Unit unit, int step) {
    const double spacing = static_cast<double>(map.block_px() * step);
    WarpGrid warp(map.block_rows() / step + 1, map.block_cols() / step + 1, spacing);
    for (int row = 0; row < warp.rows; ++row) {
        for (int col = 0; col < warp.cols; ++col) {
            const auto to = Unmoved(map, geometry, unit, row * step, col * step);
            if (!to) continue;
            warp.motion_px[warp.At(row, col)] =
                geometry.canvas.Difference(*to, CanvasPixel(warp, row, col));
            warp.known[warp.At(row, col)] = 1;
        }
    }
    return warp;
}

/// The turn by Kabsch's algorithm on rays.
WarpGrid WithoutTurn(const WarpGrid& warp, const algo::Projection& canvas) {
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    const auto known = std::count(warp.known.begin(), warp.known.end(), 1);
    if (known < 3) return warp;
    const auto visit = [&](const auto& act) {
        for (int row = 0; row < warp.rows; ++row) {
            for (int col = 0; col < warp.cols; ++col) {
                const Vector2d from = CanvasPixel(warp, row, col);
                const Vector2d to = from + warp.motion_px[warp.At(row, col)];
                if (warp.known[warp.At(row, col)] != 0) act(warp.At(row, col), from, to);
            }
        }
    };
    visit([&](std::size_t, const Vector2d& from, const Vector2d& to) {
        products += canvas.Ray(from).normalized() * canvas.Ray(to).normalized().transpose();
    });
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d U = svd.matrixU();
    if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) *= -1;
    const Eigen::Matrix3d R_from_to = U * svd.matrixV().transpose();
    WarpGrid rest = warp;
    visit([&](std::size_t at, const Vector2d& from, const Vector2d& to) {
        rest.motion_px[at] = canvas.Difference(canvas.Pixel(R_from_to * canvas.Ray(to)), from);
    });
    return rest;
}

int FoldedCells(const WarpGrid& warp) {
    int folded = 0;
    for (int row = 0; row + 1 < warp.rows; ++row) {
        for (int col = 0; col + 1 < warp.cols; ++col)
            folded += warp.HasCell(row, col) && Folded(warp, row, col) ? 1 : 0;
    }
    return folded;
}

double LeastCellRatio(const WarpGrid& warp, const WarpGrid& other) {
    double least = 1;
    for (int row = 0; row + 1 < warp.rows; ++row) {
        for (int col = 0; col + 1 < warp.cols; ++col) {
            if (warp.HasCell(row, col) && !other.HasCell(row, col))
                least = std::min(least, StretchRatio(JacobianOf(warp, row, col)));
        }
    }
    return least;
}

double AffineRatio(const WarpGrid& warp) {
    Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
    int corners = 0;
    for (int row = 0; row < warp.rows; ++row) {
        for (int col = 0; col < warp.cols; ++col) {
            if (warp.known[warp.At(row, col)] == 0) continue;
            const Eigen::Vector3d from(col, row, 1);
            left += from * from.transpose();
            right += from * warp.motion_px[warp.At(row, col)].transpose() / warp.spacing_px;
            ++corners;
        }
    }
    if (corners < 3) return 1;
    const Eigen::Matrix<double, 3, 2> fit = left.ldlt().solve(right);
    return StretchRatio(Matrix2d::Identity() + fit.topRows<2>().transpose());
}

}  // namespace hitchview::app

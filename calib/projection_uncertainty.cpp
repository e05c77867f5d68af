#include "calib/projection_uncertainty.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Eigen::Matrix;
using Eigen::Vector2d;
using Eigen::Vector3d;
using LensJacobian = Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxLensParameters>;
using TurnJacobian = Matrix<double, 2, 3>;

double& Parameter(CameraModel& model, int index) {
    switch (index) {
        case 0:
            return model.fx_px;
        case 1:
            return model.fy_px;
        case 2:
            return model.cx_px;
        case 3:
            return model.cy_px;
        default:
            return model.distortion.at(static_cast<std::size_t>(index - 4));
    }
}

CameraModel Everywhere(CameraModel model) {
    model.max_theta_rad = 3.14;
    return model;
}

/// Central differences of the pixel that sees `direction`; `Change` is applied with both signs.
template <typename Change>
Vector2d Difference(double step, const Change& project) {
    return (project(step) - project(-step)) / (2 * step);
}

LensJacobian ByLens(const CameraModel& model, const Vector3d& direction, int count) {
    LensJacobian jacobian(2, count);
    for (int i = 0; i < count; ++i) {
        const double step = i < 4 ? 1e-3 : 1e-6;
        jacobian.col(i) = Difference(step, [&](double change) {
            CameraModel changed = model;
            Parameter(changed, i) += change;
            return changed.Project(direction).value_or(Vector2d::Zero());
        });
    }
    return jacobian;
}

TurnJacobian ByTurn(const CameraModel& model, const Vector3d& direction) {
    TurnJacobian jacobian;
    for (int i = 0; i < 3; ++i) {
        jacobian.col(i) = Difference(1e-6, [&](double change) {
            const Vector3d turned =
                direction + change * Vector3d::Unit(i).cross(direction);  // first order
            return model.Project(turned).value_or(Vector2d::Zero());
        });
    }
    return jacobian;
}

}  // namespace

std::vector<PixelUncertainty> ProjectionUncertainty(const CameraModel& model,
                                                    const LensCovariance& covariance, int columns,
                                                    int rows) {
    const CameraModel everywhere = Everywhere(model);
    const auto count = static_cast<int>(covariance.rows());
    std::vector<PixelUncertainty> places;
    std::vector<LensJacobian> by_lens;
    std::vector<TurnJacobian> by_turn;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxLensParameters> turned(3, count);
    turned.setZero();
    for (int i = 0; i < columns * rows; ++i) {
        const Vector2d at((i % columns + 0.5) * model.width_px / columns - 0.5,
                          (i / columns + 0.5) * model.height_px / rows - 0.5);
        const auto direction = model.Unproject(at);
        if (!direction) continue;
        places.push_back({at, 0});
        by_lens.push_back(ByLens(everywhere, *direction, count));
        by_turn.push_back(ByTurn(everywhere, *direction));
        normal += by_turn.back().transpose() * by_turn.back();
        turned += by_turn.back().transpose() * by_lens.back();
    }
    if (places.empty()) return places;
    const auto best_turn = normal.ldlt().solve(turned).eval();
    for (std::size_t i = 0; i < places.size(); ++i) {
        const LensJacobian rest = by_lens[i] - by_turn[i] * best_turn;
        places[i].sigma_px = std::sqrt((rest * covariance * rest.transpose()).trace() / 2);
    }
    return places;
}

}  // namespace hitchview::calib

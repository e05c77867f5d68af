#include "algo/profile_smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hitchview::algo {

using Eigen::Index;
using Eigen::VectorXd;

double TemporalWeight(Index distance_frames, int radius_frames) {
    if (std::abs(distance_frames) > radius_frames) return 0;
    const double d = 3 * static_cast<double>(distance_frames) / radius_frames;
    return std::exp(-d * d);
}

Profiles AccumulateMotion(const Profiles& motion) {
    Profiles T = motion;
    for (Index i = 1; i < T.rows(); ++i) T.row(i) += T.row(i - 1);
    return T;
}

SymmetricBand SmoothnessMatrix(Index frames, int radius_frames, double weight) {
    SymmetricBand L(frames, radius_frames);
    for (Index i = 0; i < frames; ++i) {
        for (Index j = L.FirstColumn(i); j < i; ++j) {
            L.AddDifference(i, j, weight * TemporalWeight(i - j, radius_frames));
        }
    }
    return L;
}

SymmetricBand StabilizationMatrix(Index frames, const ProfileSmoothingOptions& options) {
    SymmetricBand A = SmoothnessMatrix(frames, options.radius_frames, 2 * options.lambda);
    A.AddDiagonal(VectorXd::Ones(frames));
    return A;
}

SymmetricBand StabilizationMatrix(const Eigen::Ref<const VectorXd>& lambda, int radius_frames) {
    SymmetricBand A(lambda.size(), radius_frames);
    for (Index i = 0; i < A.size(); ++i) {
        for (Index j = A.FirstColumn(i); j < i; ++j) {
            A.AddDifference(i, j, (lambda(i) + lambda(j)) * TemporalWeight(i - j, radius_frames));
        }
    }
    A.AddDiagonal(VectorXd::Ones(A.size()));
    return A;
}

double StabilizationEnergy(const Eigen::Ref<const VectorXd>& x, const Eigen::Ref<const VectorXd>& T,
                           const ProfileSmoothingOptions& options) {
    const Index r = options.radius_frames;
    double roughness = 0;
    for (Index i = 0; i < x.size(); ++i) {
        const Index last = std::min(x.size() - 1, i + r);
        for (Index j = std::max(Index{0}, i - r); j <= last; ++j) {
            roughness += TemporalWeight(i - j, options.radius_frames) * std::pow(x(i) - x(j), 2);
        }
    }
    return (x - T).squaredNorm() + options.lambda * roughness;
}

Profiles SmoothProfiles(const Profiles& T, const ProfileSmoothingOptions& options) {
    return BandedCholesky(StabilizationMatrix(T.rows(), options)).Solve(T);
}

double SmoothingGain(double cycles_per_frame, const ProfileSmoothingOptions& options) {
    double damping = 0;
    for (int d = 1; d <= options.radius_frames; ++d) {
        damping += TemporalWeight(d, options.radius_frames) *
                   (1 - std::cos(2 * std::numbers::pi * cycles_per_frame * d));
    }
    return 1 / (1 + 4 * options.lambda * damping);
}

}  // namespace hitchview::algo

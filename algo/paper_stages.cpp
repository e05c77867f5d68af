#include "algo/paper_stages.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Stage 2 as written: argmin |Vhat - V + S|^2.
Profiles AlignLiterally(const OverlapProfiles& unit, const Profiles& T_hat) {
    return unit.V - (T_hat - unit.T);
}

/// Stage 3 as written: argmin L_stab(x) + beta |Vhat - V + x - T|^2.
Profiles RefineLiterally(const OverlapProfiles& unit, const Profiles& V_hat,
                         const PaperStagesOptions& options) {
    const Index frames = unit.T.rows();
    SymmetricBand A = StabilizationMatrix(frames, options.smoothing);
    A.AddDiagonal(VectorXd::Constant(frames, options.beta));
    return BandedCholesky(A).Solve(unit.T + options.beta * (unit.T + unit.V - V_hat));
}

/// Stage 2 corrected: U = V - share (S - S_other), share = kappa of the tractor, 1 - kappa of the
/// trailer; then smoothed in time where mu > 0.
Profiles Align(const OverlapProfiles& unit, const Profiles& S, const Profiles& S_other,
               const Profiles& confidence, double share, const PaperStagesOptions& options) {
    const Profiles U = unit.V - share * (S - S_other);
    return SmoothByConfidence(U, confidence, options.mu, options.smoothing.radius_frames);
}

/// Stage 3 corrected: argmin L_stab(x) + beta sum_i c_i (Vhat - V + share (x - T - S_other))^2, for
/// every column with its own confidence c.
Profiles Refine(const OverlapProfiles& unit, const Profiles& V_hat, const Profiles& S_other,
                const Profiles& confidence, double share, const PaperStagesOptions& options) {
    const SymmetricBand stabilization = StabilizationMatrix(unit.T.rows(), options.smoothing);
    Profiles x(unit.T.rows(), unit.T.cols());
    for (Index k = 0; k < x.cols(); ++k) {
        const VectorXd pull = options.beta * share * confidence.col(k);
        SymmetricBand A = stabilization;
        A.AddDiagonal(share * pull);
        const VectorXd target =
            share * (unit.T.col(k) + S_other.col(k)) + unit.V.col(k) - V_hat.col(k);
        x.col(k) = BandedCholesky(A).Solve(unit.T.col(k) + pull.cwiseProduct(target));
    }
    return x;
}

using Optimized = PerUnit<OptimizedProfiles>;

void RoundLiterally(const PerUnit<OverlapProfiles>& profiles, const PaperStagesOptions& options,
                    Optimized& found) {
    for (const Unit unit : kUnits) {
        found[unit].V_hat = AlignLiterally(profiles[unit], found[unit].T_hat);
        found[unit].T_hat = RefineLiterally(profiles[unit], found[unit].V_hat, options);
    }
}

void AlignBoth(const PerUnit<OverlapProfiles>& profiles, const Profiles& confidence,
               const PerUnit<double>& share, const PaperStagesOptions& options, Optimized& found) {
    const PerUnit<Profiles> S{{Profiles(found[Unit::kTractor].T_hat - profiles[Unit::kTractor].T),
                               Profiles(found[Unit::kTrailer].T_hat - profiles[Unit::kTrailer].T)}};
    for (const Unit unit : kUnits) {
        found[unit].V_hat =
            Align(profiles[unit], S[unit], S[Other(unit)], confidence, share[unit], options);
    }
}

void RefineBoth(const PerUnit<OverlapProfiles>& profiles, const Profiles& confidence,
                const PerUnit<double>& share, const PaperStagesOptions& options, Optimized& found) {
    for (const Unit unit : kUnits) {
        const Unit other = Other(unit);
        const Profiles S_other = found[other].T_hat - profiles[other].T;
        found[unit].T_hat =
            Refine(profiles[unit], found[unit].V_hat, S_other, confidence, share[unit], options);
    }
}

}  // namespace

Profiles SmoothByConfidence(const Profiles& U, const Profiles& confidence, double mu,
                            int radius_frames) {
    if (mu == 0) return (confidence.array() > 0).select(U, 0.0);
    const SymmetricBand smoothness = SmoothnessMatrix(U.rows(), radius_frames, 2 * mu);
    Profiles x = Profiles::Zero(U.rows(), U.cols());
    for (Index k = 0; k < U.cols(); ++k) {
        if (!(confidence.col(k).maxCoeff() > 0)) continue;
        SymmetricBand A = smoothness;
        A.AddDiagonal(confidence.col(k));
        const BandedCholesky factor(A);
        if (factor.positive_definite())
            x.col(k) = factor.Solve(confidence.col(k).cwiseProduct(U.col(k)));
    }
    return x;
}

PerUnit<OptimizedProfiles> SolvePaperStages(const PerUnit<OverlapProfiles>& profiles,
                                            const Profiles& confidence, Coupling coupling,
                                            const PaperStagesOptions& options) {
    const PerUnit<double> share{{options.kappa, 1 - options.kappa}};
    Optimized found;
    for (const Unit unit : kUnits)
        found[unit].T_hat = SmoothProfiles(profiles[unit].T, options.smoothing);
    for (int round = 0; round < options.rounds; ++round) {
        if (coupling == Coupling::kLiteral) {
            RoundLiterally(profiles, options, found);
        } else {
            AlignBoth(profiles, confidence, share, options, found);
            RefineBoth(profiles, confidence, share, options, found);
        }
    }
    return found;
}

}  // namespace hitchview::algo

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "calib/intrinsics.hpp"
#include "calib/median.hpp"

namespace hitchview::calib {
namespace {

constexpr int kFewestViews = 6;
constexpr double kLeastTilt_rad = 20 * std::numbers::pi / 180;
constexpr double kLeastCovered = 0.4;
constexpr double kMostRms_px = 1.0;
/// Errors in new views against those that were fitted: more is a fit to noise.
constexpr double kMostOverfit = 2.0;
constexpr double kMostBlur_px = 2.5;
constexpr double kMostFocalSigma = 0.01;  // of the focal length
constexpr double kMostUncertainty_px = 1.0;

template <typename... Values>
std::string Text(const char* format, Values... values) {
    char text[256];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

void JudgeViews(Intrinsics& found) {
    const auto used = std::ranges::count_if(found.views, &ViewOutcome::is_used);
    if (used < kFewestViews) {
        found.reasons.push_back(Text("only %d views can be used: take at least %d, from all sides",
                                     static_cast<int>(used), kFewestViews));
    }
    if (found.spread.most_tilt_rad < kLeastTilt_rad) {
        found.reasons.push_back(
            Text("all boards face the camera (at most %.0f degrees tilted): tilt some by 30 to 60 "
                 "degrees, or the focal length cannot be told from the distance",
                 found.spread.most_tilt_rad * 180 / std::numbers::pi));
    }
    if (found.spread.covered < kLeastCovered) {
        found.reasons.push_back(
            Text("corners cover %.0f %% of the picture: hold the board into its edges and corners "
                 "until it is %.0f %%",
                 100 * found.spread.covered, 100 * kLeastCovered));
    }
}

void JudgeFit(Intrinsics& found) {
    if (!(found.rms_px <= kMostRms_px)) {
        found.reasons.push_back(
            Text("the corners are %.2f px off on average, at most %.1f may be: "
                 "wrong model of the lens, wrong board, or blurred pictures",
                 found.rms_px, kMostRms_px));
    }
    if (!found.heldout_rms_px) {
        found.reasons.push_back("too few views to leave one out and see how well it is foretold");
    } else if (*found.heldout_rms_px > std::max(0.3, kMostOverfit * found.rms_px)) {
        found.reasons.push_back(
            Text("views that were left out are %.2f px off, the others %.2f: "
                 "the views are too much alike, take more",
                 *found.heldout_rms_px, found.rms_px));
    }
}

void JudgeSharpness(Intrinsics& found) {
    std::vector<double> blurs_px;
    for (const ViewOutcome& view : found.views)
        if (view.is_used() && view.blur_px) blurs_px.push_back(*view.blur_px);
    if (blurs_px.empty()) return;
    const double usual_px = Median(std::move(blurs_px));
    if (usual_px <= kMostBlur_px) return;
    found.reasons.push_back(
        Text("the board's edges are smeared over %.1f px (standard deviation), at most %.1f may "
             "be: focus the camera, clean its lens, hold the board still",
             usual_px, kMostBlur_px));
}

void JudgeUncertainty(Intrinsics& found) {
    if (found.sigma.empty()) {
        found.reasons.push_back("the views do not determine the lens: take more, tilted and near");
        return;
    }
    if (found.sigma[0] > kMostFocalSigma * found.model.fx_px) {
        found.reasons.push_back(
            Text("the focal length is known to %.1f %% only: tilt the board "
                 "more and come nearer",
                 100 * found.sigma[0] / found.model.fx_px));
    }
    const auto certain = std::ranges::count_if(found.uncertainty, [](const PixelUncertainty& p) {
        return p.sigma_px <= kMostUncertainty_px;
    });
    if (2 * certain < std::ssize(found.uncertainty)) {
        found.reasons.push_back(
            Text("over most of the picture the lens is known worse than to "
                 "%.1f px: take more views there",
                 kMostUncertainty_px));
    }
}

}  // namespace

std::string IntrinsicsLimits() {
    return Text(
        "%d views, tilt %.0f degrees, covered %.0f %%, rms %.3g px, blur %.3g px, lens known "
        "to %.3g px over half the picture",
        kFewestViews, kLeastTilt_rad * 180 / std::numbers::pi, 100 * kLeastCovered, kMostRms_px,
        kMostBlur_px, kMostUncertainty_px);
}

void JudgeIntrinsics(Intrinsics& found) {
    found.reasons.clear();
    JudgeViews(found);
    JudgeFit(found);
    JudgeSharpness(found);
    JudgeUncertainty(found);
    found.verdict = found.reasons.empty() ? Verdict::kPass : Verdict::kFail;
}

}  // namespace hitchview::calib

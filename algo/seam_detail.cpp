#include "algo/seam_detail.hpp"

#include <algorithm>
#include <cmath>

#include "algo/smooth_step.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

/// Most that a unit's part may be stretched from row to row, and sheared, px per px. With 0.7 along
/// a row and 0.05 across it, the Jacobian determinant is at least .3 x .65 - .05 x 3.5 = .02.
constexpr float kMostStretchDown = 0.35F;
constexpr float kMostShear = 3.5F;

/// 1 up to the core, 0 beyond the fade.
double ShareAt(double distance_px, const SeamDetailOptions& options) {
    return 1 - SmoothStep((distance_px - options.core_px) / options.fade_px);
}

class RowFader {
 public:
    RowFader(const CornerField& coarse, const CornerField& detail, const SeamDetailOptions& options,
             CornerField& shown)
        : coarse_(coarse),
          detail_(detail),
          options_(options),
          limit_(Vector2f(static_cast<float>(options.stretch), static_cast<float>(options.tilt)) *
                 static_cast<float>(detail.spacing_px()) /
                 static_cast<float>(std::max(options.kappa, 1 - options.kappa))),
          shown_(shown) {}

    /// Columns `first` to `last` of a row, on both sides of the seam.
    void Fade(int row, double seam_px, int first, int last) const {
        const auto nearest = static_cast<int>(std::lround((seam_px + 0.5) / detail_.spacing_px()));
        const int start = std::clamp(nearest, first, last);
        shown_.at(row, start) = Wanted(row, start, seam_px);
        Walk(row, start, last, 1, seam_px);
        Walk(row, start, first, -1, seam_px);
    }

 private:
    [[nodiscard]] Vector2f Wanted(int row, int col, double seam_px) const {
        const double distance_px = std::abs(detail_.Pixel(row, col).x() - seam_px);
        if (distance_px >= options_.core_px + options_.fade_px) return Vector2f::Zero();
        return static_cast<float>(ShareAt(distance_px, options_)) * detail_.at(row, col);
    }
    /// From the corner at `start` to that at `end`, `away` at a time.
    void Walk(int row, int start, int end, int away, double seam_px) const {
        for (int before = start; before != end; before += away) {
            const int col = before + away;
            const Vector2f change = coarse_.at(row, col) - coarse_.at(row, before);
            const Vector2f step = Wanted(row, col, seam_px) - shown_.at(row, before) + change;
            shown_.at(row, col) =
                shown_.at(row, before) - change + step.cwiseMax(-limit_).cwiseMin(limit_);
        }
    }

    const CornerField& coarse_;
    const CornerField& detail_;
    const SeamDetailOptions& options_;
    Vector2f limit_;
    CornerField& shown_;
};

/// Bounds the change of the whole discrepancy from row to row, beginning at the middle row. What is
/// cut lies between its neighbours' cuts, so the bounds along the rows still hold.
class ColumnBound {
 public:
    ColumnBound(const CornerField& coarse, const SeamDetailOptions& options, CornerField& shown)
        : coarse_(coarse),
          limit_(Vector2f(kMostShear, kMostStretchDown) * static_cast<float>(coarse.spacing_px()) /
                 static_cast<float>(std::max(options.kappa, 1 - options.kappa))),
          shown_(shown) {}

    void Bound(int col) const {
        const int middle = shown_.rows() / 2;
        for (int row = middle + 1; row < shown_.rows(); ++row) Follow(row, row - 1, col);
        for (int row = middle - 1; row >= 0; --row) Follow(row, row + 1, col);
    }

 private:
    void Follow(int row, int before, int col) const {
        const Vector2f change = coarse_.at(row, col) - coarse_.at(before, col);
        const Vector2f step = shown_.at(row, col) - shown_.at(before, col) + change;
        const Vector2f cut = step.cwiseMax(-limit_).cwiseMin(limit_);
        if (cut != step) shown_.at(row, col) += cut - step;
    }

    const CornerField& coarse_;
    Vector2f limit_;
    CornerField& shown_;
};

}  // namespace

void FadeFromSeams(const CornerField& coarse, const CornerField& detail, const UnitSeams& seams,
                   const SeamDetailOptions& options, TaskRunner& runner, CornerField& shown) {
    const RowFader fader(coarse, detail, options, shown);
    const int half = detail.cols() / 2;
    runner.Run(detail.rows(), [&](int row) {
        fader.Fade(row, seams.path(Overlap::kLeft).x_px(row), 0, half - 1);
        fader.Fade(row, seams.path(Overlap::kRight).x_px(row), half, detail.cols() - 1);
    });
    const ColumnBound bound(coarse, options, shown);
    runner.Run(detail.cols(), [&](int col) { bound.Bound(col); });
}

}  // namespace hitchview::algo

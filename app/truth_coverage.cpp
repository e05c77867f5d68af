#include "app/truth_coverage.hpp"

#include <cmath>
#include <numbers>

#include "app/truth_warp.hpp"

namespace hitchview::app {
namespace {

using algo::Unit;

constexpr double kDegree = std::numbers::pi / 180;
/// A column belongs to an overlap if both units cover this share of what any of them covers.
constexpr double kBothShare = 0.6;
/// Narrower than this nothing can be matched.
constexpr int kNarrowest_px = 48;

bool AnyData(const algo::ComposedMap& map, const RigGeometry& geometry, int row, int col,
             std::uint32_t missing) {
    return HasData(map, geometry, Unit::kTractor, row, col, missing) ||
           HasData(map, geometry, Unit::kTrailer, row, col, missing);
}

}  // namespace

TruthCoverage::TruthCoverage(const RigGeometry& geometry)
    : geometry_(geometry), map_(geometry_.canvas, geometry_.units, algo::SeamOptions{}) {}

const TruthCoverage::Reference& TruthCoverage::At(double articulation_rad, std::uint32_t missing) {
    const int degrees = static_cast<int>(std::lround(articulation_rad / kDegree));
    const auto [known, is_new] = references_.try_emplace({degrees, missing});
    if (is_new) known->second = Make(degrees * kDegree, missing);
    return known->second;
}

TruthCoverage::Reference TruthCoverage::Make(double articulation_rad, std::uint32_t missing) {
    algo::Composition composition;
    composition.M_canvas_view[Unit::kTrailer] =
        Eigen::AngleAxisd(articulation_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    algo::SerialRunner runner;
    map_.Build(composition, runner);
    Reference reference;
    for (int row = 0; row <= map_.block_rows(); ++row) {
        for (int col = 0; col <= map_.block_cols(); ++col)
            reference.covered.push_back(AnyData(map_, geometry_, row, col, missing) ? 1 : 0);
    }
    const int middle = map_.block_cols() / 2;
    reference.there[algo::Overlap::kLeft] = Overlaps(0, middle, missing);
    reference.there[algo::Overlap::kRight] = Overlaps(middle, map_.block_cols(), missing);
    return reference;
}

bool TruthCoverage::Overlaps(int from_col, int to_col, std::uint32_t missing) const {
    int width_px = 0;
    for (int col = from_col; col < to_col; ++col) {
        int both = 0;
        int any = 0;
        for (int row = 0; row <= map_.block_rows(); ++row) {
            const bool tractor = HasData(map_, geometry_, Unit::kTractor, row, col, missing);
            const bool trailer = HasData(map_, geometry_, Unit::kTrailer, row, col, missing);
            both += tractor && trailer ? 1 : 0;
            any += tractor || trailer ? 1 : 0;
        }
        if (any > 0 && both >= kBothShare * any) width_px += map_.block_px();
    }
    return width_px >= kNarrowest_px;
}

double TruthCoverage::ShareOf(const algo::ComposedMap& map, const Reference& reference,
                              std::uint32_t missing) const {
    int of = 0;
    int covered = 0;
    for (int row = 0; row <= map.block_rows(); ++row) {
        for (int col = 0; col <= map.block_cols(); ++col) {
            const auto at = static_cast<std::size_t>(row * (map.block_cols() + 1) + col);
            if (reference.covered[at] == 0) continue;
            ++of;
            covered += IsRendered(map, geometry_, row, col, missing) ? 1 : 0;
        }
    }
    return of > 0 ? static_cast<double>(covered) / of : 1;
}

}  // namespace hitchview::app

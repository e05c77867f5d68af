#include "app/truth_overlap.hpp"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "app/evaluation_statistics.hpp"
#include "app/truth_field.hpp"
#include "app/truth_warp.hpp"

namespace hitchview::app {
namespace {

using algo::ComposedMap;
using algo::Overlap;
using algo::Unit;
using Eigen::Vector2d;
using nlohmann::json;

/// Shares below this do not show.
constexpr float kLeastShare = 0.02F;
/// Every so many corners of the map: in the strip of the rows, in the whole overlap of both.
constexpr int kStep = 2;
/// Weight of the oracle's smoothness against about nine samples to a cell.
constexpr double kSmoothness = 0.05;
constexpr double kFar_m = 10;
constexpr double kNear_m = 4;

float ShareOf(const ComposedMap& map, Unit unit, int row, int col) {
    float share = 0;
    for (int s = 0; s < map.cameras(); ++s) {
        if (map.unit_of(s) == unit) share += map.corner(s, row, col).weight;
    }
    return share;
}

/// The camera of the tractor that shows most of a corner; -1 if none has it inside its picture.
int Shower(const ComposedMap& map, const RigGeometry& geometry, int row, int col) {
    const algo::UnitGeometry& tractor = *geometry.units[Unit::kTractor];
    for (int s = 0; s < map.cameras(); ++s) {
        const ComposedMap::Corner& corner = map.corner(s, row, col);
        if (map.unit_of(s) != Unit::kTractor || !corner.sees) continue;
        const auto ray = tractor.ViewRay(map.camera_of(s), Vector2d(corner.x, corner.y));
        if (!ray) continue;
        algo::UnitGeometry::Sights sights;
        tractor.See(*ray, sights);
        const auto most =
            std::max_element(sights.begin(), sights.end(),
                             [](const auto& a, const auto& b) { return a.weight < b.weight; });
        return most != sights.end() && most->weight > 0 ? most->camera : -1;
    }
    return -1;
}

using Filter = std::function<bool(const OverlapSample&)>;
using Measure = std::function<double(const OverlapSample&)>;

json Spread(const std::vector<OverlapSample>& samples, const Filter& counts,
            const Measure& measure) {
    std::vector<double> values;
    for (const OverlapSample& sample : samples) {
        if (counts(sample)) values.push_back(measure(sample));
    }
    if (values.empty()) return nullptr;
    return {{"median_px", *Quantile(values, 0.5)},
            {"p95_px", *Quantile(values, 0.95)},
            {"samples", values.size()}};
}

/// By distance.
json Bins(const std::vector<OverlapSample>& samples, const Filter& counts, const Measure& measure) {
    const auto bin = [&](double from_m, double to_m) {
        return Spread(
            samples,
            [&](const OverlapSample& s) {
                return counts(s) && s.distance_m >= from_m && s.distance_m < to_m;
            },
            measure);
    };
    return {{"all", Spread(samples, counts, measure)},
            {"beyond_10_m", bin(kFar_m, 1e9)},
            {"4_to_10_m", bin(kNear_m, kFar_m)},
            {"below_4_m", bin(0, kNear_m)}};
}

/// Per overlap and together.
json ByOverlap(const std::vector<OverlapSample>& samples, const Filter& counts,
               const Measure& measure) {
    json result{{"both", Bins(samples, counts, measure)}};
    for (const Overlap overlap : algo::kOverlaps) {
        result[ToString(overlap)] = Bins(
            samples, [&](const OverlapSample& s) { return counts(s) && s.overlap == overlap; },
            measure);
    }
    return result;
}

/// Medians over all distances, estimated against oracle.
json Ratio(const json& estimated, const json& oracle) {
    if (estimated.is_null() || oracle.is_null()) return nullptr;
    return estimated["median_px"].get<double>() / oracle["median_px"].get<double>();
}

}  // namespace

void TruthOverlap::Observe(const ShownPanorama& shown, const algo::Composition& used,
                           const ComposedMap& map) {
    const std::size_t first = samples_.size();
    for (int row = 0; row <= map.block_rows(); row += kStep) {
        for (int col = 0; col < map.block_cols(); ++col) ObserveCorner(shown, used, map, row, col);
    }
    AskOracle(first);
}

void TruthOverlap::ObserveCorner(const ShownPanorama& shown, const algo::Composition& used,
                                 const ComposedMap& map, int row, int col) {
    const RigGeometry& geometry = sight_.geometry();
    const bool in_strip = ShareOf(map, Unit::kTractor, row, col) > kLeastShare &&
                          ShareOf(map, Unit::kTrailer, row, col) > kLeastShare;
    const bool on_grid = col % kStep == 0;
    if (!in_strip && !on_grid) return;
    if (!HasData(map, geometry, Unit::kTractor, row, col, shown.cameras_missing) ||
        !HasData(map, geometry, Unit::kTrailer, row, col, shown.cameras_missing))
        return;
    const int camera = Shower(map, geometry, row, col);
    const int frame = static_cast<int>(shown.picture.header.sequence);
    if (camera < 0 || (shown.cameras_missing >> camera & 1U) != 0) return;
    const ComposedMap::Corner& corner = map.corner(camera, row, col);
    const auto point =
        sight_.WorldPointAt(Unit::kTractor, camera, frame, Vector2d(corner.x, corner.y));
    if (!point) return;
    const Sighting other =
        sight_.Find(Unit::kTrailer, frame, point->p_world_m, TruthSight::Occlusion::kTested, used);
    if (other.camera < 0) return;
    const Vector2d canvas_px = map.block_px() * Vector2d(col, row) - Vector2d::Constant(0.5);
    const Overlap overlap = col < map.block_cols() / 2 ? Overlap::kLeft : Overlap::kRight;
    samples_.push_back({.overlap = overlap,
                        .frame = frame,
                        .canvas_px = canvas_px,
                        .misalignment_px = geometry.canvas.Difference(other.canvas_px, canvas_px),
                        .distance_m = point->distance_m,
                        .in_strip = in_strip,
                        .on_grid = on_grid,
                        .locked = shown.composition->seams[overlap] == algo::SeamState::kLocked});
}

/// Of the samples of one frame, from `first` on.
void TruthOverlap::AskOracle(std::size_t first) {
    std::vector<FieldSample> known;
    for (std::size_t i = first; i < samples_.size(); ++i) {
        if (samples_[i].on_grid)
            known.push_back({samples_[i].canvas_px, samples_[i].misalignment_px});
    }
    if (known.empty()) return;
    const algo::Mesh mesh(sight_.geometry().canvas);
    const algo::VertexField field = FitField(mesh, known, kSmoothness);
    for (std::size_t i = first; i < samples_.size(); ++i) {
        OverlapSample& s = samples_[i];
        s.oracle_px = (s.misalignment_px - algo::Sample(mesh, field, s.canvas_px)).norm();
    }
}

double TruthOverlap::NewestStripError_px(Overlap overlap) const {
    double sum = 0;
    int count = 0;
    for (auto s = samples_.rbegin(); s != samples_.rend() && s->frame == samples_.back().frame;
         ++s) {
        if (s->overlap != overlap || !s->in_strip || s->distance_m < kFar_m) continue;
        sum += s->misalignment_px.norm();
        ++count;
    }
    return count > 0 ? sum / count : 0;
}

json ToJson(const std::vector<OverlapSample>& samples) {
    const Measure error = [](const OverlapSample& s) { return s.misalignment_px.norm(); };
    const Measure oracle = [](const OverlapSample& s) { return s.oracle_px; };
    const Filter strip = [](const OverlapSample& s) { return s.in_strip; };
    const Filter locked_strip = [](const OverlapSample& s) { return s.in_strip && s.locked; };
    const Filter grid = [](const OverlapSample& s) { return s.on_grid; };
    const Filter locked_grid = [](const OverlapSample& s) { return s.on_grid && s.locked; };
    json whole{{"all_frames", ByOverlap(samples, grid, error)},
               {"locked", ByOverlap(samples, locked_grid, error)},
               {"oracle_all_frames", ByOverlap(samples, grid, oracle)},
               {"oracle_locked", ByOverlap(samples, locked_grid, oracle)}};
    for (const char* when : {"all_frames", "locked"}) {
        whole[std::string("ratio_") + when] =
            Ratio(whole[when]["both"]["all"], whole[std::string("oracle_") + when]["both"]["all"]);
    }
    return {{"strip",
             {{"all_frames", ByOverlap(samples, strip, error)},
              {"locked", ByOverlap(samples, locked_strip, error)}}},
            {"overlap", whole}};
}

}  // namespace hitchview::app

#include "app/safety_meter.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numeric>

#include "algo/multiband_blend.hpp"
#include "algo/panorama_renderer.hpp"
#include "algo/picture_reduction.hpp"

namespace hitchview::app {
namespace {

using algo::ComposedMap;
using algo::Overlap;
using nlohmann::json;

char Letter(algo::SeamState state) {
    switch (state) {
        case algo::SeamState::kNoOverlap:
            return 'N';
        case algo::SeamState::kReacquire:
            return 'R';
        case algo::SeamState::kCoast:
            return 'C';
        case algo::SeamState::kLocked:
            return 'L';
    }
    return '?';
}

bool Inside(const ComposedMap::Corner& corner, int width_px, int height_px) {
    return corner.x >= 0 && corner.y >= 0 && corner.x <= static_cast<float>(width_px - 1) &&
           corner.y <= static_cast<float>(height_px - 1);
}

/// The four corners of a cell: top left, top right, bottom left, bottom right.
using Cell = std::array<const ComposedMap::Corner*, 4>;

double Cross(const ComposedMap::Corner& from, const ComposedMap::Corner& right_end,
             const ComposedMap::Corner& top, const ComposedMap::Corner& bottom) {
    const double right_x = right_end.x - from.x;
    const double right_y = right_end.y - from.y;
    const double down_x = bottom.x - top.x;
    const double down_y = bottom.y - top.y;
    return right_x * down_y - right_y * down_x;
}

/// A bilinear map has its least Jacobian determinant at a corner.
bool IsFolded(const Cell& cell) {
    const auto& [a, b, c, d] = cell;
    return Cross(*a, *b, *a, *c) <= 0 || Cross(*a, *b, *b, *d) <= 0 || Cross(*c, *d, *a, *c) <= 0 ||
           Cross(*c, *d, *b, *d) <= 0;
}

/// Of the frames in the first or the last second, px.
json MeanOfSecond(const std::vector<double>& values, double rate_hz, bool last) {
    const auto count =
        static_cast<std::ptrdiff_t>(std::min(values.size(), static_cast<std::size_t>(rate_hz)));
    if (count == 0) return nullptr;
    const auto from = last ? values.end() - count : values.begin();
    return std::accumulate(from, from + count, 0.0) / static_cast<double>(count);
}

json ToJson(const algo::OffsetShares& shares) {
    return {{"stabilization", shares.stabilization},
            {"placement", shares.placement},
            {"view_offset", shares.view_offset},
            {"discrepancy", shares.discrepancy},
            {"detail", shares.detail}};
}

long DifferentBytes(const std::vector<std::uint8_t>& a, const std::uint8_t* b) {
    long different = 0;
    for (std::size_t i = 0; i < a.size(); ++i) different += a[i] != b[i] ? 1 : 0;
    return different;
}

}  // namespace

long FoldedDrawnCells(const ComposedMap& map, const RigGeometry& geometry) {
    long folded = 0;
    for (int s = 0; s < map.cameras(); ++s) {
        const algo::UnitGeometry& unit = *geometry.units[map.unit_of(s)];
        const int width_px = unit.camera_width_px(map.camera_of(s));
        const int height_px = unit.camera_height_px(map.camera_of(s));
        for (int row = 0; row < map.block_rows(); ++row) {
            for (int col = 0; col < map.block_cols(); ++col) {
                const Cell cell{&map.corner(s, row, col), &map.corner(s, row, col + 1),
                                &map.corner(s, row + 1, col), &map.corner(s, row + 1, col + 1)};
                const auto all = [&](auto&& is) {
                    return std::all_of(cell.begin(), cell.end(), [&](auto* c) { return is(*c); });
                };
                const bool shown = std::any_of(cell.begin(), cell.end(),
                                               [](const auto* c) { return c->weight > 0; });
                if (!all([](const auto& c) { return c.sees; })) continue;
                if (!shown && !all([&](const auto& c) { return Inside(c, width_px, height_px); }))
                    continue;
                folded += IsFolded(cell) ? 1 : 0;
            }
        }
    }
    return folded;
}

SafetyMeter::SafetyMeter(const drivers::SimulatedRig& rig, const RigGeometry& geometry)
    : geometry_(geometry),
      bounds_(algo::BoundsOf(geometry.canvas, geometry.units[algo::Unit::kTractor]->view())),
      rig_(rig),
      jump_(rig, geometry),
      coverage_(geometry),
      rate_hz_(1 / std::chrono::duration<double>(rig.options().period).count()) {}

void SafetyMeter::Observe(const ShownPanorama& shown, const ComposedMap& map,
                          const algo::RigPictures& pictures) {
    algo::Composition used = *shown.composition;
    used.detail = map.shown_detail();
    folded_cells_ += FoldedDrawnCells(map, geometry_);
    largest_.TakeLarger(
        algo::SharesOf(used, bounds_, geometry_.units[algo::Unit::kTractor]->view()));
    const int frame = static_cast<int>(shown.picture.header.sequence);
    jump_.Observe(frame, used, map);
    const auto& there = coverage_.At(rig_.HitchAngleAt(frame), shown.cameras_missing).there;
    for (const Overlap overlap : algo::kOverlaps)
        ObserveSeam(overlap, used.seams[overlap], there[overlap]);
    if (shown.cameras_missing != 0 || frames_ % kPixelsEvery == 0)
        ObservePixels(shown, map, pictures);
    ++frames_;
}

void SafetyMeter::ObserveSeam(Overlap overlap, algo::SeamState state, bool there) {
    frames_locked_away_ += !there && state == algo::SeamState::kLocked ? 1 : 0;
    std::vector<Stay>& stays = stays_[overlap];
    if (stays.empty() || stays.back().state != state) stays.push_back({state, 0});
    ++stays.back().frames;
}

/// A renderer without a past can show nothing old.
void SafetyMeter::ObservePixels(const ShownPanorama& shown, const ComposedMap& map,
                                const algo::RigPictures& pictures) {
    algo::SerialRunner runner;
    algo::MultibandBlend bands(map);
    algo::PictureReduction reduction(geometry_.units);
    algo::PanoramaRenderer renderer;
    bands.Update(map, pictures, runner);
    renderer.SetGains(pictures.gains);
    const hal::FrameFormat& format = shown.picture.format;
    const std::size_t luma =
        static_cast<std::size_t>(format.width_px) * static_cast<std::size_t>(format.height_px);
    std::vector<std::uint8_t> anew(hal::FrameBytes(format));
    renderer.RenderBlended(map, reduction.Update(pictures.frames, runner), bands,
                           {.width_px = format.width_px,
                            .height_px = format.height_px,
                            .y = anew.data(),
                            .y_stride_bytes = format.width_px,
                            .u = anew.data() + luma,
                            .v = anew.data() + luma + luma / 4,
                            .chroma_stride_bytes = format.width_px / 2},
                           runner);
    stale_bytes_ += DifferentBytes(anew, shown.picture.planes[0].data);
    ++pictures_;
}

std::string SafetyMeter::StatesOf(Overlap overlap) const {
    std::string states;
    for (const Stay& stay : stays_[overlap]) {
        if (!states.empty()) states += ' ';
        states += Letter(stay.state) + std::to_string(stay.frames);
    }
    return states;
}

json SafetyMeter::Figures() const {
    double largest_jump_px = 0;
    json seams;
    for (const Overlap overlap : algo::kOverlaps) {
        const TruthJump::Figures& jump = jump_.figures(overlap);
        largest_jump_px =
            std::max({largest_jump_px, jump.largest_seam_px, jump.largest_placement_px});
        seams[ToString(overlap)] = {{"states", StatesOf(overlap)},
                                    {"frames_compared", jump.frames},
                                    {"largest_seam_jump_px", jump.largest_seam_px},
                                    {"largest_placement_jump_px", jump.largest_placement_px},
                                    {"placement_error_first_second_px",
                                     MeanOfSecond(jump.placement_errors_px, rate_hz_, false)},
                                    {"placement_error_last_second_px",
                                     MeanOfSecond(jump.placement_errors_px, rate_hz_, true)}};
    }
    return {{"folded_cells", folded_cells_},
            {"largest_offset_share", largest_.Largest()},
            {"offset_shares", ToJson(largest_)},
            {"largest_locked_jump_px", largest_jump_px},
            {"stale_bytes", stale_bytes_},
            {"pictures_compared", pictures_},
            {"frames_locked_away", frames_locked_away_},
            {"frames", frames_},
            {"seam", seams}};
}

}  // namespace hitchview::app

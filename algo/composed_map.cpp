#include "algo/composed_map.hpp"

#include <algorithm>
#include <cmath>

#include "algo/seam_detail.hpp"
#include "algo/unified_options.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

/// Share of the unit beyond the seam: it fills what the preferred unit leaves uncovered.
constexpr float kFiller = 1e-3F;
/// Share of a camera without a picture where it would have seen something: the renderer then
/// knows, and any other camera outweighs it.
constexpr float kAbsent = 1e-6F;

}  // namespace

ComposedMap::UnitMap::UnitMap(const Projection& canvas, const UnitGeometry& unit_geometry)
    : geometry(unit_geometry), on_view(canvas, unit_geometry.view()), table(unit_geometry) {}

ComposedMap::ComposedMap(const Projection& canvas,
                         const PerUnit<std::optional<UnitGeometry>>& geometry,
                         const SeamOptions& seam)
    : canvas_(canvas),
      canvas_mesh_(canvas),
      coarse_(canvas, Vector2f::Zero()),
      whole_(canvas, Vector2f::Zero()),
      rows_(whole_.rows()),
      cols_(whole_.cols()),
      seams_(canvas, rows_, cols_, whole_.spacing_px(), seam),
      seam_cost_(rows_ * cols_, SeamCostOptionsOf(canvas)),
      shown_detail_(canvas, Vector2f::Zero()) {
    shown_detail_.Clear();
    const auto corners = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_);
    for (const Unit unit : kUnits) {
        first_source_[unit] = static_cast<int>(sources_.size());
        covered_[unit].assign(corners, 0);
        main_camera_[unit].assign(corners, 0);
        if (!geometry[unit]) continue;
        units_[unit] = std::make_unique<UnitMap>(canvas, *geometry[unit]);
        for (int i = 0; i < geometry[unit]->cameras(); ++i) {
            sources_.push_back(
                {unit, i, std::vector<Corner>(corners), std::vector<float>(corners),
                 std::vector<Columns>(static_cast<std::size_t>(rows_), Columns{cols_, -1}),
                 std::vector<Columns>(static_cast<std::size_t>(rows_))});
        }
    }
}

void ComposedMap::Build(const Composition& composition, TaskRunner& runner) {
    for (const Unit unit : kUnits) present_[unit].set();
    BuildFor(composition, nullptr, runner);
}

void ComposedMap::Build(const Composition& composition, const RigPictures& pictures,
                        TaskRunner& runner) {
    for (const Unit unit : kUnits) {
        for (std::size_t i = 0; i < kMaxCameras; ++i)
            present_[unit][i] = pictures.frames[unit][i].present();
    }
    BuildFor(composition, &pictures, runner);
}

void ComposedMap::BuildFor(const Composition& composition, const RigPictures* pictures,
                           TaskRunner& runner) {
    for (const Unit unit : kUnits) {
        if (!units_[unit]) continue;
        units_[unit]->on_view.Update(composition.M_canvas_view[unit].inverse(),
                                     composition.view_offset[unit], runner);
    }
    runner.Run(rows_, [&](int row) {
        MeasureDiscrepancy(composition, row);
        Locate(composition, row, {0, cols_ - 1});
    });
    UpdateSeams(composition, pictures, runner);
    FadeDetail(composition, runner);
    selected_.reset();
    runner.Run(rows_, [&](int row) { WeightRow(row); });
}

void ComposedMap::MeasureDiscrepancy(const Composition& composition, int row) {
    canvas_mesh_.SampleRow(composition.discrepancy, row, coarse_);
    for (int col = 0; col < cols_; ++col) {
        whole_.at(row, col) = coarse_.at(row, col);
        if (!composition.detail.empty()) whole_.at(row, col) += composition.detail.at(row, col);
    }
}

/// The seams were chosen with all of the detail everywhere.
void ComposedMap::FadeDetail(const Composition& composition, TaskRunner& runner) {
    shown_detail_ = composition.detail;
    if (shown_detail_.empty() || !units_[Unit::kTrailer]) return;
    FadeFromSeams(coarse_, composition.detail, seams_,
                  ShownDetailOptions(canvas_, composition.kappa), runner, shown_detail_);
    runner.Run(rows_, [&](int row) { LocateFadedRow(composition, row); });
}

void ComposedMap::LocateFadedRow(const Composition& composition, int row) {
    constexpr float kNoChange_px = 0.02F;
    const auto half = [&](int first, int last) {
        Columns changed{cols_, -1};
        for (int col = first; col <= last; ++col) {
            const Vector2f hidden = composition.detail.at(row, col) - shown_detail_.at(row, col);
            if (hidden.cwiseAbs().maxCoeff() < kNoChange_px) continue;
            whole_.at(row, col) -= hidden;
            changed = {std::min(changed.first, col), col};
        }
        Locate(composition, row, changed);
    };
    half(0, cols_ / 2 - 1);
    half(cols_ / 2, cols_ - 1);
}

void ComposedMap::Locate(const Composition& composition, int row, const Columns& columns) {
    PixelRun view;
    SightRuns sights;
    for (const Unit unit : kUnits) {
        if (!units_[unit]) continue;
        const double moves = unit == Unit::kTractor ? -composition.kappa : 1 - composition.kappa;
        for (int first = columns.first; first <= columns.last; first += PixelRun::kMost) {
            view.count = std::min(PixelRun::kMost, columns.last + 1 - first);
            PlaceOnView(*units_[unit], moves, row, first, view);
            units_[unit]->table.See(view, present_[unit], sights);
            TakeSights(unit, row, first, view.count, sights);
        }
    }
}

void ComposedMap::PlaceOnView(const UnitMap& unit, double moves, int row, int first_col,
                              PixelRun& view) const {
    for (int i = 0; i < view.count; ++i) {
        const Vector2f& e = whole_.at(row, first_col + i);
        const Vector2d view_px =
            unit.on_view.At(whole_.Pixel(row, first_col + i) + moves * e.cast<double>());
        view.x_px[static_cast<std::size_t>(i)] = static_cast<float>(view_px.x());
        view.y_px[static_cast<std::size_t>(i)] = static_cast<float>(view_px.y());
    }
}

void ComposedMap::TakeSights(Unit unit, int row, int first_col, int count, SightRuns& sights) {
    const std::size_t first = At(row, first_col);
    std::fill_n(covered_[unit].begin() + static_cast<std::ptrdiff_t>(first), count,
                std::uint8_t{0});
    std::array<Columns, kMaxCameras> taken;
    Shares most{};
    for (const CameraSightRun& run : sights.cameras()) {
        taken[static_cast<std::size_t>(run.camera)] = {first_col + run.first,
                                                       first_col + run.end - 1};
        TakeSights(unit, first, run, most);
    }
    for (int i = 0; i < units_[unit]->geometry.cameras(); ++i) {
        sources_[static_cast<std::size_t>(first_source_[unit] + i)].Replace(
            At(row, 0), {first_col, first_col + count - 1}, taken[static_cast<std::size_t>(i)],
            row);
    }
}

void ComposedMap::TakeSights(Unit unit, std::size_t first, const CameraSightRun& sights,
                             Shares& most) {
    const UnitGeometry& geometry = units_[unit]->geometry;
    const bool present = present_[unit][static_cast<std::size_t>(sights.camera)];
    const auto right_px = static_cast<float>(geometry.camera_width_px(sights.camera) - 1);
    const auto bottom_px = static_cast<float>(geometry.camera_height_px(sights.camera) - 1);
    Source& source = sources_[static_cast<std::size_t>(first_source_[unit] + sights.camera)];
    for (auto i = static_cast<std::size_t>(sights.first); i < static_cast<std::size_t>(sights.end);
         ++i) {
        const std::size_t at = first + i;
        const float x = sights.x_px[i];
        const float y = sights.y_px[i];
        const float share = sights.share[i];
        const bool sees = !std::isnan(x);
        const bool inside = sees && x >= 0 && y >= 0 && x <= right_px && y <= bottom_px;
        source.corners[at] = {sees ? x : 0, sees ? y : 0, 0, sees};
        source.share[at] = inside && !present ? kAbsent : share;
        if (!inside || share <= most[i]) continue;
        most[i] = share;
        covered_[unit][at] = 1;
        main_camera_[unit][at] = static_cast<std::int8_t>(sights.camera);
    }
}

/// Forgets what was seen in other columns than those just taken, of those looked at.
void ComposedMap::Source::Replace(std::size_t row_at, const Columns& looked_at,
                                  const Columns& taken, int row) {
    Columns& old = seen[static_cast<std::size_t>(row)];
    const auto forget = [&](int first, int last) {
        for (int col = std::max(first, old.first); col <= std::min(last, old.last); ++col) {
            corners[row_at + static_cast<std::size_t>(col)] = {};
            share[row_at + static_cast<std::size_t>(col)] = 0;
        }
    };
    if (taken.last < taken.first) {
        forget(looked_at.first, looked_at.last);
        return;
    }
    forget(looked_at.first, taken.first - 1);
    forget(taken.last + 1, looked_at.last);
    old = {std::min(old.first, taken.first), std::max(old.last, taken.last)};
}

void ComposedMap::UpdateSeams(const Composition& composition, const RigPictures* pictures,
                              TaskRunner& runner) {
    if (!units_[Unit::kTrailer]) return;
    seams_.FindOverlaps(covered_);
    if (pictures != nullptr)
        runner.Run(rows_, [&](int row) { CompareUnits(composition, *pictures, row); });
    if (!canvas_.IsRing()) {
        PerUnit<double> middle_px;
        for (const Unit unit : kUnits) {
            const Projection& view = units_[unit]->geometry.view();
            middle_px[unit] =
                canvas_.Pixel(composition.M_canvas_view[unit] * view.Ray(view.Centre())).x();
        }
        seams_.PlaceViews(middle_px);
    }
    seams_.Follow(pictures != nullptr ? seam_cost_.cost() : std::span<const float>());
}

void ComposedMap::CompareUnits(const Composition& composition, const RigPictures& pictures,
                               int row) {
    constexpr int kAhead = 8;  // corners
    for (const Overlap overlap : kOverlaps) {
        const SeamPath::Range& range = seams_.overlap(overlap);
        for (int col = range.first; col <= range.last; ++col) {
            const std::size_t at = At(row, col);
            if (col + kAhead <= range.last) FetchPatches(pictures, at + kAhead);
            if (!SeenByBoth(at)) {
                seam_cost_.ObserveOne(at);
                continue;
            }
            seam_cost_.ObserveBoth(at, PatchOf(pictures, Unit::kTractor, at),
                                   PatchOf(pictures, Unit::kTrailer, at),
                                   {BendAt(composition, row, col), DoubtAt(composition, row, col)});
        }
    }
}

void ComposedMap::FetchPatches(const RigPictures& pictures, std::size_t at) const {
    if (!SeenByBoth(at)) return;
    for (const Unit unit : kUnits) {
        const Corner& corner = MainCorner(unit, at);
        FetchGreyPatch(pictures.frames[unit][static_cast<std::size_t>(main_camera_[unit][at])],
                       corner.x, corner.y);
    }
}

/// From the main camera; the unit covers the corner.
GreyPatch ComposedMap::PatchOf(const RigPictures& pictures, Unit unit, std::size_t at) const {
    const auto camera = static_cast<std::size_t>(main_camera_[unit][at]);
    const Corner& corner = MainCorner(unit, at);
    return ReadGreyPatch(pictures.frames[unit][camera], pictures.gains[unit][camera], corner.x,
                         corner.y);
}

float ComposedMap::DoubtAt(const Composition& composition, int row, int col) const {
    return composition.doubt_px.empty() ? 0 : composition.doubt_px.at(row, col);
}

/// Slope of the whole discrepancy. Without detail it is smooth, and looked at more widely.
float ComposedMap::BendAt(const Composition& composition, int row, int col) const {
    const int reach = composition.detail.empty() ? 2 : 1;
    const auto slope = [&](int down, int across) {
        const int top = std::max(row - down, 0);
        const int bottom = std::min(row + down, rows_ - 1);
        const int left = std::max(col - across, 0);
        const int right = std::min(col + across, cols_ - 1);
        const int apart = bottom - top + right - left;
        return (whole_.at(bottom, right) - whole_.at(top, left)).norm() /
               static_cast<float>(apart * whole_.spacing_px());
    };
    return slope(0, reach) + slope(reach, 0);
}

void ComposedMap::WeightRow(int row) {
    for (Source& source : sources_) source.used[static_cast<std::size_t>(row)] = {cols_, -1};
    PerUnit<Shares> shares;
    for (int first = 0; first < cols_; first += PixelRun::kMost) {
        const Columns columns{first, std::min(first + PixelRun::kMost, cols_) - 1};
        ShareBetweenUnits(row, columns, shares);
        for (Source& source : sources_) source.Weight(row, At(row, 0), columns, shares);
    }
}

/// What each unit is to show of some columns of a row.
void ComposedMap::ShareBetweenUnits(int row, const Columns& columns,
                                    PerUnit<Shares>& shares) const {
    const bool two = units_[Unit::kTrailer] != nullptr;
    for (int col = columns.first; col <= columns.last; ++col) {
        const std::size_t at = At(row, col);
        const auto tractor =
            static_cast<float>(two ? seams_.TractorShare(row, whole_.Pixel(row, col).x()) : 1.0);
        PerUnit<float> share{{tractor, 1 - tractor}};
        if (selected_) {
            share[*selected_] = 1;
            share[Other(*selected_)] = 0;
        } else if (two) {
            for (const Unit unit : kUnits) {
                if (covered_[Other(unit)][at] == 0) share[unit] = std::max(share[unit], kFiller);
            }
        }
        const auto i = static_cast<std::size_t>(col - columns.first);
        for (const Unit unit : kUnits) shares[unit][i] = share[unit];
    }
}

void ComposedMap::Source::Weight(int row, std::size_t row_at, const Columns& columns,
                                 const PerUnit<Shares>& shares) {
    const Columns& looked_at = seen[static_cast<std::size_t>(row)];
    Columns& weighted = used[static_cast<std::size_t>(row)];
    const int last = std::min(columns.last, looked_at.last);
    for (int col = std::max(columns.first, looked_at.first); col <= last; ++col) {
        const std::size_t at = row_at + static_cast<std::size_t>(col);
        const float weight =
            shares[unit][static_cast<std::size_t>(col - columns.first)] * share[at];
        corners[at].weight = weight;
        if (weight > 0) weighted = {std::min(weighted.first, col), col};
    }
}

void ComposedMap::SelectUnit(Unit unit) {
    selected_ = unit;
    for (int row = 0; row < rows_; ++row) WeightRow(row);
}

void ComposedMap::SelectBoth() {
    selected_.reset();
    for (int row = 0; row < rows_; ++row) WeightRow(row);
}

}  // namespace hitchview::algo

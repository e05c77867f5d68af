#include "algo/sight_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

/// How far a view may be tilted, so that more of it is seen above or below: the trailer's by its
/// pitch and roll against the tractor and, as the tractor's, by what steadies it.
constexpr double kTilt_rad = 30 * std::numbers::pi / 180;
/// So far from the horizon it is tabulated at most.
constexpr double kSteepest_rad = 80 * std::numbers::pi / 180;
/// Instead of a margin, which is not less than 0; so low that no share is left.
constexpr float kNoShare = -1;
constexpr float kLeastSum = 1e-6F;  // without a share
constexpr auto kBlendWidth = static_cast<float>(UnitGeometry::kBlendWidth);
constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

int RowsOver(double length_px, double pitch_px) {
    return std::max(1, static_cast<int>(std::ceil(length_px / pitch_px)));
}

/// How far from the horizon a tilted view reaches that reaches `length_px` when it is level.
double ReachTilted_px(double length_px, double focal_px) {
    const double level_rad = std::atan2(length_px, focal_px);
    return focal_px * std::tan(std::max(level_rad, std::min(level_rad + kTilt_rad, kSteepest_rad)));
}

/// Into `share`: distance to the nearer side edge, as a share of the width; kNoShare where the
/// picture cannot be shown.
HV_MULTIVERSION
void TakeMargins(float width_px, float height_px, bool present, CameraSightRun& run) {
    const float per_px = 1 / width_px;
    for (auto i = static_cast<std::size_t>(run.first); i < static_cast<std::size_t>(run.end); ++i) {
        const float x = run.x_px[i];
        const float y = run.y_px[i];
        const float margin = std::min(x, width_px - 1 - x) * per_px;
        const bool shows = present && margin >= 0 && y >= 0 && y <= height_px - 1;
        run.share[i] = shows ? margin : kNoShare;
    }
}

/// As UnitGeometry::ShareByMargins.
HV_MULTIVERSION
void ShareByMargins(SightRuns& sights) {
    alignas(64) PixelRun::Of<float> best{};
    alignas(64) PixelRun::Of<float> sum{};
    for (const CameraSightRun& run : sights.cameras()) {
        for (auto i = static_cast<std::size_t>(run.first); i < static_cast<std::size_t>(run.end);
             ++i)
            best[i] = std::max(best[i], run.share[i]);
    }
    for (CameraSightRun& run : sights.cameras()) {
        for (auto i = static_cast<std::size_t>(run.first); i < static_cast<std::size_t>(run.end);
             ++i) {
            run.share[i] = std::max(0.0F, run.share[i] - best[i] + kBlendWidth);
            sum[i] += run.share[i];
        }
    }
    for (CameraSightRun& run : sights.cameras()) {
        for (auto i = static_cast<std::size_t>(run.first); i < static_cast<std::size_t>(run.end);
             ++i)
            run.share[i] /= std::max(kLeastSum, sum[i]);
    }
}

}  // namespace

SightTable::SightTable(const UnitGeometry& geometry)
    : ring_(geometry.view().IsRing()),
      pitch_px_(1.0 * geometry.view().width_px / kCols),
      edge_px_(geometry.SurfaceEdge_px()) {
    if (!ring_) return;
    const Projection& view = geometry.view();
    const double horizon_px = view.horizon_y_px;
    const double above_px = ReachTilted_px(horizon_px, view.focal_px);
    const double below_px = ReachTilted_px(view.height_px - horizon_px, view.focal_px);
    rows_to_edge_ = RowsOver(edge_px_ - horizon_px + above_px, pitch_px_);
    rows_ = rows_to_edge_ + 1 + RowsOver(horizon_px - edge_px_ + below_px, pitch_px_);
    Fill(geometry);
}

void SightTable::Fill(const UnitGeometry& geometry) {
    const auto cameras = static_cast<std::size_t>(geometry.cameras());
    std::vector<std::vector<Node>> whole(
        cameras,
        std::vector<Node>(static_cast<std::size_t>(rows_ * kCols), Node::Constant(kUnseen)));
    const Projection& view = geometry.view();
    Vector2d pixel;
    for (int row = 0; row < rows_; ++row) {
        for (int col = 0; col < kCols; ++col) {
            const Vector2d node(pitch_px_ * col, edge_px_ + pitch_px_ * (row - rows_to_edge_));
            const auto at = static_cast<std::size_t>(row * kCols + col);
            for (std::size_t i = 0; i < cameras; ++i) {
                if (!geometry.Project(static_cast<int>(i), view.Ray(node), pixel)) continue;
                whole[i][at] = pixel.array().cast<float>();
            }
        }
    }
    cameras_.resize(cameras);
    seeing_.assign(static_cast<std::size_t>((rows_ / kBandRows + 1) * kCols), 0);
    for (std::size_t i = 0; i < cameras; ++i) {
        NoteSeeing(whole[i], static_cast<std::uint8_t>(1U << i));
        cameras_[i].width_px = static_cast<float>(geometry.camera_width_px(static_cast<int>(i)));
        cameras_[i].height_px = static_cast<float>(geometry.camera_height_px(static_cast<int>(i)));
        Crop(whole[i], cameras_[i]);
    }
}

void SightTable::NoteSeeing(const std::vector<Node>& whole, std::uint8_t camera_bit) {
    for (int row = 0; row + 1 < rows_; ++row) {
        for (int col = 0; col < kCols; ++col) {
            if (Sees(whole, row, col) && Sees(whole, row, col + 1) && Sees(whole, row + 1, col) &&
                Sees(whole, row + 1, col + 1))
                seeing_[Band(row, col)] |= camera_bit;
        }
    }
}

/// Columns beyond the last are those from the first on: it is a ring.
bool SightTable::Sees(const std::vector<Node>& whole, int row, int col) {
    return !whole[static_cast<std::size_t>(row * kCols + col % kCols)].hasNaN();
}

bool SightTable::SeesColumn(const std::vector<Node>& whole, int col) const {
    for (int row = 0; row < rows_; ++row) {
        if (Sees(whole, row, col)) return true;
    }
    return false;
}

/// Keeps what lies beside the widest run of columns that it does not see.
void SightTable::Crop(const std::vector<Node>& whole, Camera& camera) const {
    int longest = 0;
    int run = 0;
    for (int i = 0; i < 2 * kCols; ++i) {
        run = SeesColumn(whole, i) ? 0 : std::min(run + 1, kCols);
        if (run <= longest) continue;
        longest = run;
        camera.first = (i + 1) % kCols;
    }
    // A camera that sees all round has the first column once more behind the last.
    camera.cols = longest == 0 ? kCols + 1 : kCols - longest;
    for (int row = 0; row < rows_; ++row) {
        for (int col = 0; col < camera.cols; ++col) {
            camera.nodes.push_back(
                whole[static_cast<std::size_t>(row * kCols + (camera.first + col) % kCols)]);
        }
    }
}

HV_MULTIVERSION
void SightTable::Place(const PixelRun& view, Places& places) const {
    const auto nodes_per_px = static_cast<float>(1 / pitch_px_);
    const auto edge_px = static_cast<float>(edge_px_);
    const auto rows_to_edge = static_cast<float>(rows_to_edge_);
    const auto last_row = static_cast<float>(rows_ - 1);
    for (std::size_t i = 0; i < static_cast<std::size_t>(view.count); ++i) {
        const float u = view.x_px[i] * nodes_per_px;
        const float turns = std::floor(u * (1.0F / kCols));
        const float around = std::clamp(u - kCols * turns, 0.0F, kCols - 1e-3F);
        const float v = (view.y_px[i] - edge_px) * nodes_per_px + rows_to_edge;
        const float inside = std::clamp(v, 0.0F, last_row - 1);
        places.col[i] = static_cast<std::int32_t>(around);
        places.row[i] = static_cast<std::int32_t>(inside);
        places.s[i] = around - static_cast<float>(places.col[i]);
        places.t[i] = v - static_cast<float>(places.row[i]);
    }
}

void SightTable::FindCameras(const Places& places, int count, SightRuns& sights) const {
    std::array<int, kMaxCameras> first;
    std::array<int, kMaxCameras> end{};
    first.fill(count);
    for (int i = 0; i < count; ++i) {
        const auto place = static_cast<std::size_t>(i);
        const std::size_t band = Band(places.row[place], places.col[place]);
        for (unsigned rest = seeing_[band]; rest != 0; rest &= rest - 1) {
            const auto camera = static_cast<std::size_t>(std::countr_zero(rest));
            first[camera] = std::min(first[camera], i);
            end[camera] = i + 1;
        }
    }
    sights.count = 0;
    for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
        if (end[camera] == 0) continue;
        CameraSightRun& run = sights.camera[static_cast<std::size_t>(sights.count++)];
        run.camera = static_cast<int>(camera);
        run.first = first[camera];
        run.end = end[camera];
    }
}

void SightTable::ReadPixels(const Places& places, CameraSightRun& sights) const {
    using Pair = Eigen::Array4f;  // a node and the one right of it
    const Camera& camera = cameras_[static_cast<std::size_t>(sights.camera)];
    const float* nodes = camera.nodes.data()->data();
    for (auto i = static_cast<std::size_t>(sights.first); i < static_cast<std::size_t>(sights.end);
         ++i) {
        const int right = places.col[i] - camera.first;
        const int wanted = right + (right < 0 ? kCols : 0);
        const int col = std::min(wanted, camera.cols - 2);
        const bool between = wanted == col && places.t[i] >= 0 && places.t[i] < 1;
        const float s = between ? places.s[i] : kUnseen;
        const float* top = nodes + 2 * (places.row[i] * camera.cols + col);
        const Pair above = Eigen::Map<const Pair>(top);
        const Pair below = Eigen::Map<const Pair>(top + 2 * camera.cols);
        const Pair mixed = above + places.t[i] * (below - above);
        const Node pixel = mixed.head<2>() + s * (mixed.tail<2>() - mixed.head<2>());
        sights.x_px[i] = pixel.x();
        sights.y_px[i] = pixel.y();
    }
}

void SightTable::See(const PixelRun& view, const CameraMask& present, SightRuns& sights) const {
    if (!ring_) {
        sights.count = 1;
        CameraSightRun& run = sights.camera[0];
        run.camera = run.first = 0;
        run.end = view.count;
        run.x_px = view.x_px;
        run.y_px = view.y_px;
        run.share.fill(present[0] ? 1.0F : 0.0F);
        return;
    }
    Places places;
    Place(view, places);
    FindCameras(places, view.count, sights);
    for (CameraSightRun& run : sights.cameras()) {
        ReadPixels(places, run);
        const auto i = static_cast<std::size_t>(run.camera);
        TakeMargins(cameras_[i].width_px, cameras_[i].height_px, present[i], run);
    }
    ShareByMargins(sights);
}

}  // namespace hitchview::algo

#include "algo/sight_table.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

/// How far a stabilised view may be tilted, so that more of it is seen above or below.
constexpr double kTilt_rad = 0.2;

int RowsOver(double length_px, double pitch_px) {
    return std::max(1, static_cast<int>(std::ceil(length_px / pitch_px)));
}

}  // namespace

SightTable::SightTable(const UnitGeometry& geometry)
    : ring_(geometry.view().IsRing()),
      pitch_px_(1.0 * geometry.view().width_px / kCols),
      edge_px_(geometry.SurfaceEdge_px()),
      rows_to_edge_(RowsOver(edge_px_ + kTilt_rad * geometry.view().focal_px, pitch_px_)),
      rows_(rows_to_edge_ + 1 +
            RowsOver(geometry.view().height_px - edge_px_ + kTilt_rad * geometry.view().focal_px,
                     pitch_px_)) {
    if (ring_) Fill(geometry);
}

void SightTable::Fill(const UnitGeometry& geometry) {
    const auto cameras = static_cast<std::size_t>(geometry.cameras());
    std::vector<std::vector<Node>> whole(
        cameras, std::vector<Node>(static_cast<std::size_t>(rows_ * kCols)));
    const Projection& view = geometry.view();
    Vector2d pixel;
    for (int row = 0; row < rows_; ++row) {
        for (int col = 0; col < kCols; ++col) {
            const Vector2d node(pitch_px_ * col, edge_px_ + pitch_px_ * (row - rows_to_edge_));
            const auto at = static_cast<std::size_t>(row * kCols + col);
            for (std::size_t i = 0; i < cameras; ++i) {
                if (!geometry.Project(static_cast<int>(i), view.Ray(node), pixel)) continue;
                whole[i][at] = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), true};
            }
        }
    }
    cameras_.resize(cameras);
    for (std::size_t i = 0; i < cameras; ++i) {
        cameras_[i].width_px = geometry.camera_width_px(static_cast<int>(i));
        cameras_[i].height_px = geometry.camera_height_px(static_cast<int>(i));
        Crop(whole[i], cameras_[i]);
        for (int col = 0; col + 1 < cameras_[i].cols; ++col)
            seeing_[static_cast<std::size_t>((cameras_[i].first + col) % kCols)].set(i);
    }
}

bool SightTable::SeesColumn(const std::vector<Node>& whole, int col) const {
    for (int row = 0; row < rows_; ++row) {
        if (whole[static_cast<std::size_t>(row * kCols + col)].sees) return true;
    }
    return false;
}

/// Keeps what lies beside the widest run of columns that it does not see.
void SightTable::Crop(const std::vector<Node>& whole, Camera& camera) const {
    int longest = 0;
    int run = 0;
    for (int i = 0; i < 2 * kCols; ++i) {
        run = SeesColumn(whole, i % kCols) ? 0 : std::min(run + 1, kCols);
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

void SightTable::See(const Vector2d& view_px, const CameraMask& present,
                     UnitGeometry::Sights& sights) const {
    sights.clear();
    if (!ring_) {
        sights.push_back({0, view_px, present[0] ? 1.0 : 0.0});
        return;
    }
    double u = view_px.x() / pitch_px_;
    if (u < 0 || u >= kCols) u -= kCols * std::floor(u / kCols);
    const double v = (view_px.y() - edge_px_) / pitch_px_ + rows_to_edge_;
    if (!(v >= 0 && v < rows_ - 1)) return;
    const int view_col = static_cast<int>(u);
    const int row = static_cast<int>(v);
    const auto s = static_cast<float>(u - view_col);
    const auto t = static_cast<float>(v - row);
    const CameraMask& seeing = seeing_[static_cast<std::size_t>(view_col)];
    if (seeing.none()) return;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        if (!seeing[i]) continue;
        const Camera& camera = cameras_[i];
        const int col = view_col - camera.first + (view_col < camera.first ? kCols : 0);
        const Node* top =
            camera.nodes.data() + static_cast<std::ptrdiff_t>(row) * camera.cols + col;
        const Node* bottom = top + camera.cols;
        if (!top[0].sees || !top[1].sees || !bottom[0].sees || !bottom[1].sees) continue;
        const auto mix = [&](float Node::*part) {
            const float above = top[0].*part + s * (top[1].*part - top[0].*part);
            const float below = bottom[0].*part + s * (bottom[1].*part - bottom[0].*part);
            return above + t * (below - above);
        };
        const Vector2d pixel(mix(&Node::x_px), mix(&Node::y_px));
        sights.push_back({static_cast<int>(i), pixel,
                          present[i] ? SideMargin(camera.width_px, camera.height_px, pixel) : -1});
    }
    UnitGeometry::ShareByMargins(sights);
}

}  // namespace hitchview::algo

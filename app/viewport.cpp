#include "app/viewport.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace hitchview::app {
namespace {

constexpr int kSmallestSide_px = 16;

int RoundToEven(double px) {
    return 2 * static_cast<int>(std::lround(px / 2));
}

/// Pixels from `from` to `to` degrees; all the way round where they are the same.
int ColumnsBetween(const algo::Projection& canvas, const std::array<double, 2>& azimuth_deg) {
    double turn_deg = std::fmod(azimuth_deg[0] - azimuth_deg[1], 360.0);
    if (turn_deg <= 0) turn_deg += 360;
    return RoundToEven(turn_deg / 360 * canvas.width_px);
}

int ColumnAt(const algo::Projection& canvas, double azimuth_deg) {
    const double azimuth_rad = azimuth_deg * std::numbers::pi / 180;
    // The edge between two pixels, half a pixel left of the right one's centre.
    const double x =
        canvas.Centre().x() - canvas.focal_px * (azimuth_rad - canvas.azimuth_centre_rad) + 0.5;
    const int column = RoundToEven(x) % canvas.width_px;
    return column < 0 ? column + canvas.width_px : column;
}

Viewport Place(const ViewportConfig& config, const algo::Projection& canvas) {
    Viewport viewport{
        .channel = config.channel, .every = config.every, .max_bytes = config.max_bytes};
    if (config.azimuth_deg) {
        viewport.x_px = ColumnAt(canvas, (*config.azimuth_deg)[0]);
        viewport.width_px = ColumnsBetween(canvas, *config.azimuth_deg);
    } else {
        const auto& [from, to] = *config.columns_px;
        viewport.x_px = RoundToEven(from);
        viewport.width_px = RoundToEven(to) - viewport.x_px;
    }
    const std::array<int, 2> rows_px = config.rows_px.value_or(std::array{0, canvas.height_px});
    viewport.y_px = RoundToEven(rows_px[0]);
    viewport.height_px = RoundToEven(rows_px[1]) - viewport.y_px;
    return viewport;
}

std::string Problem(const Viewport& viewport, const algo::Projection& canvas) {
    if (viewport.width_px < kSmallestSide_px || viewport.height_px < kSmallestSide_px)
        return "is smaller than 16 pixels";
    if (viewport.y_px + viewport.height_px > canvas.height_px)
        return "reaches below the canvas of " + std::to_string(canvas.height_px) + " rows";
    if (!canvas.IsRing() && viewport.x_px + viewport.width_px > canvas.width_px)
        return "reaches beyond the canvas of " + std::to_string(canvas.width_px) + " columns";
    return "";
}

/// Copies a rectangle of one plane, whose rows end where they begin.
void CropPlane(const hal::Plane& plane, int plane_width, const std::array<int, 4>& rectangle,
               std::uint8_t* out) {
    const auto [left, top, width, height] = rectangle;
    const int before_edge = std::min(width, plane_width - left);
    for (int row = 0; row < height; ++row, out += width) {
        const std::uint8_t* const in =
            plane.data + static_cast<std::ptrdiff_t>(top + row) * plane.stride_bytes;
        std::memcpy(out, in + left, static_cast<std::size_t>(before_edge));
        std::memcpy(out + before_edge, in, static_cast<std::size_t>(width - before_edge));
    }
}

}  // namespace

hal::Checked<std::vector<Viewport>> MakeViewports(const PublishConfig& publish,
                                                  const algo::Projection& canvas) {
    std::vector<Viewport> viewports;
    for (const ViewportConfig& config : publish.viewports) {
        viewports.push_back(Place(config, canvas));
        const std::string problem = Problem(viewports.back(), canvas);
        if (!problem.empty()) return "publish.viewports: " + config.name + " " + problem;
    }
    return viewports;
}

void CropViewport(const hal::FrameView& panorama, const Viewport& viewport,
                  std::span<std::uint8_t> crop) {
    const auto& [channel, x, y, width, height, every, max_bytes] = viewport;
    const int canvas_width = panorama.format.width_px;
    std::uint8_t* const chroma = crop.data() + static_cast<std::ptrdiff_t>(width) * height;
    const std::array<int, 4> half{x / 2, y / 2, width / 2, height / 2};
    CropPlane(panorama.planes[0], canvas_width, {x, y, width, height}, crop.data());
    CropPlane(panorama.planes[1], canvas_width / 2, half, chroma);
    CropPlane(panorama.planes[2], canvas_width / 2, half,
              chroma + static_cast<std::ptrdiff_t>(width / 2) * (height / 2));
}

}  // namespace hitchview::app

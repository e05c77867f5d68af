#include "algo/picture_reduction.hpp"

namespace hitchview::algo {
namespace {

/// More camera pixels to a canvas pixel make the bilinear samples of the renderer skip too much.
constexpr double kMostPixels = 1.6;
constexpr int kLargestSide = 4;

int SideFor(double camera_pixels) {
    int side = 1;
    while (side < kLargestSide && camera_pixels > kMostPixels * side) side *= 2;
    return side;
}

int EvenPart(int size_px, int side) {
    return size_px / (2 * side) * 2;
}

}  // namespace

PictureReduction::PictureReduction(const PerUnit<std::optional<UnitGeometry>>& units) {
    for (const Unit unit : kUnits) {
        if (!units[unit]) continue;
        for (int i = 0; i < units[unit]->cameras(); ++i)
            Allocate(*units[unit], i, reduced_[unit][static_cast<std::size_t>(i)]);
    }
}

void PictureReduction::Allocate(const UnitGeometry& geometry, int camera, Reduced& reduced) {
    reduced.side = SideFor(geometry.PixelsAtHorizon(camera));
    if (reduced.side == 1) return;
    reduced.width_px = EvenPart(geometry.camera_width_px(camera), reduced.side);
    reduced.height_px = EvenPart(geometry.camera_height_px(camera), reduced.side);
    reduced.nv12.resize(static_cast<std::size_t>(reduced.width_px * reduced.height_px / 2 * 3));
    reduced.means.emplace_back(reduced.width_px * reduced.side);
}

const RigFrames& PictureReduction::Update(const RigFrames& frames, TaskRunner& runner) {
    frames_ = frames;
    runner.Run(2 * static_cast<int>(kMaxCameras), [&](int i) {
        const Unit unit = kUnits[static_cast<std::size_t>(i) / kMaxCameras];
        const std::size_t camera = static_cast<std::size_t>(i) % kMaxCameras;
        Reduced& reduced = reduced_[unit][camera];
        CameraFrame& frame = frames_[unit][camera];
        if (reduced.side > 1 && frame.present()) frame = Reduce(frame, reduced);
    });
    return frames_;
}

CameraFrame PictureReduction::Reduce(const CameraFrame& frame, Reduced& reduced) {
    const int side = reduced.side;
    const int width = reduced.width_px;
    std::uint8_t* const luma = reduced.nv12.data();
    std::uint8_t* const chroma = luma + width * reduced.height_px;
    BoxMean& means = reduced.means.front();
    const SamplePlane from = frame.LumaSamples();
    const auto take_luma = [&](int y) {
        means.Take({from.row(y * side), from.stride_bytes, from.step_bytes}, {side, side}, width,
                   luma + y * width);
    };
    // Packed pixels have a row of colour for each row of grey.
    const int colour_rows = frame.is_packed() ? 2 * side : side;
    const auto take_chroma = [&](int y) {
        const SamplePlane u = frame.ChromaSamples(0);
        means.Take({u.row(y * colour_rows), u.stride_bytes, u.step_bytes / 2},
                   {side, colour_rows, 2}, width / 2, chroma + y * width);
    };
    // Both of the same rows, while the processor still has them at hand.
    for (int y = 0; y < reduced.height_px; y += 2) {
        take_luma(y);
        take_luma(y + 1);
        if (frame.has_chroma()) take_chroma(y / 2);
    }
    return {.width_px = width,
            .height_px = reduced.height_px,
            .luma = luma,
            .luma_stride_bytes = width,
            .chroma = chroma,
            .chroma_stride_bytes = width,
            .layout = frame.has_chroma() ? PixelLayout::kNv12 : PixelLayout::kGrey,
            .range = frame.range,
            .side = side};
}

}  // namespace hitchview::algo

#include "algo/panorama_block.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "algo/block_kernel.hpp"

namespace hitchview::algo {
namespace {

std::uint8_t Round(float value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F) + 0.5F);
}

/// The grey of a block, or its colour at half the size: what differs between them.
struct Luma {
    static constexpr int kScale = 1;  // canvas pixels to a sample
    static constexpr std::size_t kChannels = 1;
    static constexpr std::size_t kFirstShift = 0;

    static auto Read(const CameraSampler& camera, float x, float y) { return camera.Luma(x, y); }
    static std::array<std::uint8_t*, kChannels> Planes(const PanoramaPlanes& out) {
        return {out.y};
    }
    static int Stride_bytes(const PanoramaPlanes& out) { return out.y_stride_bytes; }
    static std::uint8_t Hatched(int diagonal) {
        constexpr std::uint8_t kDark = 40;
        constexpr std::uint8_t kLight = 72;
        return ((diagonal >> 3) & 1) != 0 ? kLight : kDark;
    }
    static std::uint8_t Empty(bool hatched, int diagonal) {
        return hatched ? Hatched(diagonal) : 0;
    }
};

struct Chroma {
    static constexpr int kScale = 2;
    static constexpr std::size_t kChannels = 2;
    static constexpr std::size_t kFirstShift = 1;

    static auto Read(const CameraSampler& camera, float x, float y) { return camera.Chroma(x, y); }
    static std::array<std::uint8_t*, kChannels> Planes(const PanoramaPlanes& out) {
        return {out.u, out.v};
    }
    static int Stride_bytes(const PanoramaPlanes& out) { return out.chroma_stride_bytes; }
    static std::uint8_t Empty(bool /*hatched*/, int /*diagonal*/) { return 128; }
};

/// Makes one kind of samples of a block that the kernel cannot make, pixel by pixel: where a
/// picture ends, where a camera is missing, or where it is reduced much.
template <typename Kind>
class EdgeRows {
 public:
    EdgeRows(const PanoramaBlock& block, bool hatched, const PanoramaPlanes& out)
        : block_(block),
          hatched_(hatched),
          planes_(Kind::Planes(out)),
          stride_bytes_(Kind::Stride_bytes(out)) {}

    void Blend() const {
        for (int row = 0; row < kSide; ++row) BlendRow(row);
    }

 private:
    static constexpr int kSide = kSegmentLanes / Kind::kScale;
    static constexpr std::size_t kChannels = Kind::kChannels;
    using Row = std::array<float, kSide>;
    using Rows = std::array<Row, kChannels>;

    /// Values at the samples of a row, between the corners.
    static void Interpolate(const Corners& corner, int row, Row& values) {
        const float v = (static_cast<float>(row) + 0.5F) / kSide;
        const float left = corner[0] + v * (corner[2] - corner[0]);
        const float right = corner[1] + v * (corner[3] - corner[1]);
        const float step = (right - left) / kSide;
        for (int i = 0; i < kSide; ++i) {
            values[static_cast<std::size_t>(i)] = left + step * (static_cast<float>(i) + 0.5F);
        }
    }
    static void InterpolateShift(const BlockSource& source, int row, Rows& shifts) {
        for (std::size_t k = 0; k < kChannels; ++k)
            Interpolate(source.shift[Kind::kFirstShift + k], row, shifts[k]);
    }

    void BlendRow(int row) const {
        Rows sum{};
        Row weight{};
        for (const BlockSource& source : block_.sources) AddRow(source, row, sum, weight);
        const auto to = RowOf(row);
        for (std::size_t i = 0; i < kSide; ++i) {
            for (std::size_t k = 0; k < kChannels; ++k)
                to[k][i] = weight[i] > 0 ? Round(sum[k][i] / weight[i]) : Empty(row, i);
        }
    }

    static void AddRow(const BlockSource& source, int row, Rows& sum, Row& weight) {
        Row xs;
        Row ys;
        Row ws;
        Rows shifts{};
        Interpolate(source.x, row, xs);
        Interpolate(source.y, row, ys);
        Interpolate(source.weight, row, ws);
        if (source.shifted) InterpolateShift(source, row, shifts);
        for (std::size_t i = 0; i < kSide; ++i) {
            if (ws[i] <= 0 || !source.camera->Sees(xs[i], ys[i])) continue;
            const auto values = Kind::Read(*source.camera, xs[i], ys[i]);
            for (std::size_t k = 0; k < kChannels; ++k)
                sum[k][i] += ws[i] * (values[k] + shifts[k][i]);
            weight[i] += ws[i];
        }
    }

    [[nodiscard]] std::array<std::uint8_t*, kChannels> RowOf(int row) const {
        const auto at = static_cast<std::ptrdiff_t>(block_.y / Kind::kScale + row) * stride_bytes_ +
                        block_.x / Kind::kScale;
        std::array<std::uint8_t*, kChannels> to;
        for (std::size_t k = 0; k < kChannels; ++k) to[k] = planes_[k] + at;
        return to;
    }
    [[nodiscard]] std::uint8_t Empty(int row, std::size_t col) const {
        return Kind::Empty(hatched_, block_.phase_px + static_cast<int>(col) + row);
    }

    const PanoramaBlock& block_;
    bool hatched_;
    std::array<std::uint8_t*, kChannels> planes_;
    int stride_bytes_;
};

/// Values at the corners of a quarter.
Corners QuarterOf(const Corners& whole, int down, int across) {
    const auto at = [&](int v, int u) {
        const float top = whole[0] + 0.5F * static_cast<float>(u) * (whole[1] - whole[0]);
        const float bottom = whole[2] + 0.5F * static_cast<float>(u) * (whole[3] - whole[2]);
        return top + 0.5F * static_cast<float>(v) * (bottom - top);
    };
    return {at(down, across), at(down, across + 1), at(down + 1, across), at(down + 1, across + 1)};
}

}  // namespace

bool BlockSource::SeesAll(float margin_px) const {
    return camera->Sees(x[0], y[0], margin_px) && camera->Sees(x[1], y[1], margin_px) &&
           camera->Sees(x[2], y[2], margin_px) && camera->Sees(x[3], y[3], margin_px);
}

bool BlockSource::LiesBeside() const {
    const auto beside = [](const Corners& along, int size_px) {
        const auto [least, greatest] = std::minmax_element(along.begin(), along.end());
        return *greatest < 0 || *least > static_cast<float>(size_px - 1);
    };
    return beside(x, camera->frame().width_px) || beside(y, camera->frame().height_px);
}

bool BlockSource::SuitsKernel(int side_px) const {
    const float most = kKernelReach_px * static_cast<float>(side_px / kSegmentLanes);
    const auto narrow = [&](const Corners& along) {
        return std::abs(along[1] - along[0]) <= most && std::abs(along[3] - along[2]) <= most;
    };
    const CameraFrame& frame = camera->frame();
    const auto near = [](const Corners& along, int size_px) {
        const auto [least, greatest] = std::minmax_element(along.begin(), along.end());
        return *least >= -kKernelOutside_px &&
               *greatest <= static_cast<float>(size_px) + kKernelOutside_px;
    };
    return narrow(x) && narrow(y) && near(x, frame.width_px) && near(y, frame.height_px) &&
           frame.width_px >= kKernelLeast_px && frame.height_px >= kKernelLeast_px;
}

bool PanoramaBlock::SourcesSuitKernel() const {
    return !sources.empty() && std::all_of(sources.begin(), sources.end(), [&](const auto& source) {
        return source.SuitsKernel(side_px);
    });
}

bool PanoramaBlock::SourcesSeeAll() const {
    return std::all_of(sources.begin(), sources.end(),
                       [](const auto& source) { return source.SeesAll(kKernelMargin_px); });
}

/// False if nothing has a weight at some corner.
bool PanoramaBlock::NormalizeWeights() {
    Corners total{};
    for (const BlockSource& source : sources) {
        for (std::size_t k = 0; k < total.size(); ++k) total[k] += source.weight[k];
    }
    if (*std::min_element(total.begin(), total.end()) <= 0) return false;
    for (BlockSource& source : sources) {
        for (std::size_t k = 0; k < total.size(); ++k) source.weight[k] /= total[k];
    }
    return true;
}

void PanoramaBlock::Prepare() {
    const bool plain = sources.size() == 1 && !camera_missing;
    suits_kernel_ = SourcesSuitKernel() && KernelRuns();
    on_edge_ = !suits_kernel_ || !SourcesSeeAll() || !(plain || NormalizeWeights());
    if (on_edge_ && camera_missing) suits_kernel_ = false;  // which knows no pattern
}

void PanoramaBlock::TakeQuarter(const PanoramaBlock& whole, int down, int across) {
    side_px = whole.side_px / 2;
    x = whole.x + across * side_px;
    y = whole.y + down * side_px;
    phase_px = whole.phase_px + (across + down) * side_px;
    camera_missing = whole.camera_missing;
    sources.clear();
    const auto quarter = [&](const Corners& of) { return QuarterOf(of, down, across); };
    for (const BlockSource& from : whole.sources) {
        BlockSource& source = sources.emplace_back();
        source.camera = from.camera;
        source.x = quarter(from.x);
        source.y = quarter(from.y);
        source.weight = quarter(from.weight);
        source.shifted = from.shifted;
        if (!from.shifted) continue;
        for (std::size_t k = 0; k < 3; ++k) source.shift[k] = quarter(from.shift[k]);
    }
    Prepare();
}

void PanoramaBlock::Clear(const PanoramaPlanes& out) const {
    const auto fill = [](std::uint8_t* to, int stride_bytes, int side, int value) {
        for (int row = 0; row < side; ++row)
            std::memset(to + static_cast<std::ptrdiff_t>(row) * stride_bytes, value,
                        static_cast<std::size_t>(side));
    };
    const auto chroma_at = static_cast<std::ptrdiff_t>(y / 2) * out.chroma_stride_bytes + x / 2;
    fill(out.y + static_cast<std::ptrdiff_t>(y) * out.y_stride_bytes + x, out.y_stride_bytes,
         side_px, Luma::Empty(false, 0));
    for (std::uint8_t* plane : {out.u, out.v})
        fill(plane + chroma_at, out.chroma_stride_bytes, side_px / 2, Chroma::Empty(false, 0));
}

void PanoramaBlock::RenderPixels(NoData no_data, const PanoramaPlanes& out) const {
    const bool hatched = no_data == NoData::kPattern && camera_missing;
    EdgeRows<Luma>(*this, hatched, out).Blend();
    EdgeRows<Chroma>(*this, hatched, out).Blend();
}

}  // namespace hitchview::algo

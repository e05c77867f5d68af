#include "app/bench_frames.hpp"

#include <cstring>

#include "app/scenario_frames.hpp"

namespace hitchview::app {
namespace {

/// The bytes of two pixels and their colour.
struct PackedPair {
    std::array<std::uint8_t, 4> bytes;
};

PackedPair Pack(hal::PixelFormat format, const std::uint8_t* luma, const std::uint8_t* chroma) {
    if (format == hal::PixelFormat::kUyvy) return {{chroma[0], luma[0], chroma[1], luma[1]}};
    return {{luma[0], chroma[0], luma[1], chroma[1]}};
}

/// 4:2:2 from NV12: rows of colour stand for two.
std::vector<std::uint8_t> Packed(const hal::FrameView& nv12, hal::PixelFormat format) {
    const int width = nv12.format.width_px;
    const int height = nv12.format.height_px;
    std::vector<std::uint8_t> packed(hal::FrameBytes({width, height, format, nv12.format.range}));
    std::uint8_t* out = packed.data();
    for (int y = 0; y < height; ++y) {
        const std::uint8_t* luma =
            nv12.planes[0].data + static_cast<std::ptrdiff_t>(y) * nv12.planes[0].stride_bytes;
        const std::uint8_t* chroma =
            nv12.planes[1].data + static_cast<std::ptrdiff_t>(y / 2) * nv12.planes[1].stride_bytes;
        for (int x = 0; x < width; x += 2, out += 4) {
            const PackedPair pair = Pack(format, luma + x, chroma + x);
            std::memcpy(out, pair.bytes.data(), pair.bytes.size());
        }
    }
    return packed;
}

std::vector<std::uint8_t> Bytes(const hal::FrameView& nv12, hal::PixelFormat format) {
    if (format != hal::PixelFormat::kNv12) return Packed(nv12, format);
    const std::uint8_t* first = nv12.planes[0].data;
    return {first, first + hal::FrameBytes(nv12.format)};
}

}  // namespace

BenchFrames::BenchFrames(const drivers::SimulatedRig& rig, int cameras, hal::PixelFormat format,
                         const std::filesystem::path& cache, algo::TaskRunner& runner)
    : format_(rig.format()) {
    format_.pixel_format = format;
    static_assert(kSets <= ScenarioFrames::kBatch);
    ScenarioFrames frames(rig, 1, cache, runner);
    for (int i = 0; i < kSets; ++i) Keep(frames.Peek(i), rig, cameras);
}

void BenchFrames::Keep(const FrameSet& set, const drivers::SimulatedRig& rig, int cameras) {
    std::vector<Picture>& pictures = sets_.emplace_back();
    algo::PerUnit<std::size_t> next;
    for (int i = 0; i < cameras; ++i) {
        const algo::Unit unit = rig.camera(i).unit;
        const std::size_t camera = next[unit]++;
        const hal::FrameView& view = set.leases[unit][camera].view();
        pictures.push_back({unit, camera, Bytes(view, format_.pixel_format)});
    }
}

FrameSet BenchFrames::Set(int index, hal::Instant at) {
    const int along = index % (2 * kSets - 2);
    const int shown = along < kSets ? along : 2 * kSets - 2 - along;
    FrameSet set;
    set.sequence = static_cast<std::uint32_t>(index);
    set.captured_from = set.captured_until = at;
    for (const Picture& picture : sets_[static_cast<std::size_t>(shown)]) {
        set.leases[picture.unit][picture.camera] = hal::FrameLease(
            *this, 0,
            {format_, {set.sequence, at}, hal::PackedPlanes(format_, picture.bytes.data())});
    }
    return set;
}

void BenchFrames::CopySet(int set, std::span<std::uint8_t> to) const {
    std::uint8_t* out = to.data();
    for (const Picture& picture : sets_[static_cast<std::size_t>(set)]) {
        std::memcpy(out, picture.bytes.data(), picture.bytes.size());
        out += picture.bytes.size();
    }
}

std::size_t BenchFrames::BytesPerSet() const {
    return sets_[0].size() * hal::FrameBytes(format_);
}

}  // namespace hitchview::app

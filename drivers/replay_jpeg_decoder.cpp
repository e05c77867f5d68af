#include "drivers/replay_jpeg_decoder.hpp"

#include <turbojpeg.h>

#include <filesystem>
#include <fstream>

#include "hal/expect.hpp"

namespace hitchview::drivers {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{256} << 20;

struct Shifts {
    int x;
    int y;
};

Shifts ChromaShifts(int subsampling) {
    switch (subsampling) {
        case TJSAMP_420:
            return {1, 1};
        case TJSAMP_422:
            return {1, 0};
        case TJSAMP_440:
            return {0, 1};
        case TJSAMP_411:
            return {2, 0};
        default:
            return {0, 0};
    }
}

}  // namespace

void JpegDecoder::Destroy::operator()(void* handle) const {
    tjDestroy(handle);
}

JpegDecoder::JpegDecoder(int width_px, int height_px)
    : width_px_(width_px), height_px_(height_px), handle_(tjInitDecompress()) {
    HV_EXPECT(handle_ != nullptr);
}

bool JpegDecoder::ReadFile(const std::string& path) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    if (error || bytes > kMaxFileBytes) return false;
    file_.resize(bytes);
    std::ifstream stream(path, std::ios::binary);
    return static_cast<bool>(
        stream.read(reinterpret_cast<char*>(file_.data()), static_cast<std::streamsize>(bytes)));
}

JpegDecoder::Outcome JpegDecoder::DecodeFile(const std::string& path) {
    return ReadFile(path) ? Decode(file_) : Outcome::kDamaged;
}

JpegDecoder::Outcome JpegDecoder::Decode(std::span<const std::uint8_t> jpeg) {
    const bool is_jpeg = jpeg.size() > 2 && jpeg[0] == 0xFF && jpeg[1] == 0xD8;
    if (!is_jpeg) return Outcome::kNotForUs;
    int width_px = 0;
    int height_px = 0;
    int subsampling = 0;
    int colour_space = 0;
    if (tjDecompressHeader3(handle_.get(), jpeg.data(), jpeg.size(), &width_px, &height_px,
                            &subsampling, &colour_space) != 0) {
        // After a picture that ends within its header TurboJPEG refuses the next one too.
        handle_.reset(tjInitDecompress());
        HV_EXPECT(handle_ != nullptr);
        return Outcome::kNotForUs;
    }
    const bool planar = colour_space == TJCS_YCbCr || colour_space == TJCS_GRAY;
    if (!planar) return Outcome::kNotForUs;
    // A damaged header may name any size: no memory is taken for it.
    if (width_px != width_px_ || height_px != height_px_) return Outcome::kDamaged;
    return DecodePlanes(jpeg, subsampling) ? Outcome::kDecoded : Outcome::kDamaged;
}

bool JpegDecoder::DecodePlanes(std::span<const std::uint8_t> jpeg, int subsampling) {
    std::array<unsigned char*, 3> starts{};
    std::array<int, 3> strides{};
    picture_ = {};
    const int planes = subsampling == TJSAMP_GRAY ? 1 : 3;
    for (int i = 0; i < planes; ++i) {
        const auto k = static_cast<std::size_t>(i);
        strides[k] = tjPlaneWidth(i, width_px_, subsampling);
        planes_[k].resize(tjPlaneSizeYUV(i, width_px_, strides[k], height_px_, subsampling));
        starts[k] = planes_[k].data();
        picture_.planes[k] = {starts[k], strides[k]};
    }
    const Shifts shifts = ChromaShifts(subsampling);
    picture_.chroma_shift_x = shifts.x;
    picture_.chroma_shift_y = shifts.y;
    return tjDecompressToYUVPlanes(handle_.get(), jpeg.data(), jpeg.size(), starts.data(),
                                   width_px_, strides.data(), height_px_, 0) == 0;
}

}  // namespace hitchview::drivers

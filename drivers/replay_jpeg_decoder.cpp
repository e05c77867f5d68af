#include "drivers/replay_jpeg_decoder.hpp"

#include <turbojpeg.h>

#include <fstream>

#include "hal/expect.hpp"

namespace hitchview::drivers {
namespace {

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

JpegDecoder::JpegDecoder() : handle_(tjInitDecompress()) {
    HV_EXPECT(handle_ != nullptr);
}

bool JpegDecoder::ReadFile(const std::string& path) {
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    const std::streamoff bytes = stream.tellg();
    if (bytes <= 0) return false;
    file_.resize(static_cast<std::size_t>(bytes));
    stream.seekg(0);
    return static_cast<bool>(stream.read(reinterpret_cast<char*>(file_.data()), bytes));
}

JpegDecoder::Outcome JpegDecoder::Decode(const std::string& path) {
    if (!ReadFile(path)) return Outcome::kDamaged;
    const bool is_jpeg = file_.size() > 2 && file_[0] == 0xFF && file_[1] == 0xD8;
    if (!is_jpeg) return Outcome::kNotForUs;
    int subsampling = 0;
    int colour_space = 0;
    if (tjDecompressHeader3(handle_.get(), file_.data(), file_.size(), &width_px_, &height_px_,
                            &subsampling, &colour_space) != 0) {
        return Outcome::kNotForUs;
    }
    const bool planar = colour_space == TJCS_YCbCr || colour_space == TJCS_GRAY;
    if (!planar) return Outcome::kNotForUs;
    return DecodePlanes(subsampling) ? Outcome::kDecoded : Outcome::kDamaged;
}

bool JpegDecoder::DecodePlanes(int subsampling) {
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
    return tjDecompressToYUVPlanes(handle_.get(), file_.data(), file_.size(), starts.data(),
                                   width_px_, strides.data(), height_px_, 0) == 0;
}

}  // namespace hitchview::drivers

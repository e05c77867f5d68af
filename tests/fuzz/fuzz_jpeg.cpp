#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include "app/frame_jpeg.hpp"
#include "drivers/frame_jpeg_decoder.hpp"
#include "drivers/lcm_log_picture.hpp"
#include "drivers/replay_jpeg_decoder.hpp"
#include "hal/expect.hpp"
#include "lcmtypes/bot_core_image_t.h"
#include "tests/fuzz/fuzz_bytes.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace hitchview;
using tests::FuzzBytes;
using Bytes = std::span<const std::uint8_t>;

/// Bytes behind which nothing may be read: the JPEG library has no sanitizer of its own.
class GuardedBytes {
 public:
    GuardedBytes()
        : pages_(
              static_cast<std::uint8_t*>(mmap(nullptr, kBytes + kGuardBytes, PROT_READ | PROT_WRITE,
                                              MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))) {
        HV_EXPECT(pages_ != MAP_FAILED);
        HV_EXPECT(mprotect(pages_ + kBytes, kGuardBytes, PROT_NONE) == 0);
    }

    Bytes Hold(Bytes bytes) {
        bytes = bytes.first(std::min(bytes.size(), kBytes));
        std::uint8_t* const first = pages_ + kBytes - bytes.size();
        std::ranges::copy(bytes, first);
        return {first, bytes.size()};
    }

 private:
    static constexpr std::size_t kBytes = std::size_t{1} << 16;
    static constexpr std::size_t kGuardBytes = std::size_t{1} << 16;

    std::uint8_t* pages_;
};

/// All decoders for pictures of one size, and a picture whose decoding is known.
class Decoders {
 public:
    explicit Decoders(const hal::FrameFormat& format)
        : format_(format),
          live_(format),
          replay_(format.width_px, format.height_px),
          nv12_(hal::FrameBytes(format)) {
        std::vector<std::uint8_t> pixels(hal::FrameBytes(format));
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = static_cast<std::uint8_t>(11 * i * i / 7);
        app::FrameJpeg encoder(format, 85);
        const auto jpeg = encoder.Compress({format, {}, hal::PackedPlanes(format, pixels.data())});
        sound_.assign(jpeg.begin(), jpeg.end());
        HV_EXPECT(live_.Decode(sound_, nv12_).ok());
        known_ = nv12_;
    }

    /// Whatever the bytes are, they leave no trace behind: the next sound picture is the known one.
    void DecodeLive(Bytes jpeg) {
        const bool first = live_.Decode(jpeg, nv12_).ok();
        const std::vector<std::uint8_t> decoded = nv12_;
        HV_EXPECT(live_.Decode(sound_, nv12_).ok() && nv12_ == known_);
        if (!first) return;
        HV_EXPECT(live_.Decode(jpeg, nv12_).ok() && nv12_ == decoded);
    }

    void DecodeReplayed(Bytes jpeg) {
        using Outcome = drivers::JpegDecoder::Outcome;
        if (replay_.Decode(jpeg) == Outcome::kDecoded)
            drivers::ToNv12(replay_.picture(), format_, nv12_);
        HV_EXPECT(replay_.Decode(sound_) == Outcome::kDecoded);
        const hal::Plane& luma = replay_.picture().planes[0];
        for (std::ptrdiff_t y = 0; y < format_.height_px; ++y)
            HV_EXPECT(std::equal(luma.data + y * luma.stride_bytes,
                                 luma.data + y * luma.stride_bytes + format_.width_px,
                                 known_.begin() + y * format_.width_px));
    }

    [[nodiscard]] const hal::FrameFormat& format() const { return format_; }

 private:
    hal::FrameFormat format_;
    drivers::FrameJpegDecoder live_;
    drivers::JpegDecoder replay_;
    std::vector<std::uint8_t> nv12_;
    std::vector<std::uint8_t> sound_{};
    std::vector<std::uint8_t> known_{};
};

/// A picture in a log: any kind of pixels, any stride, more or fewer bytes than it should have.
void DecodeLogged(FuzzBytes bytes, const hal::FrameFormat& format) {
    constexpr std::array kPixels{
        BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG, BOT_CORE_IMAGE_T_PIXEL_FORMAT_NV12,
        BOT_CORE_IMAGE_T_PIXEL_FORMAT_UYVY,  BOT_CORE_IMAGE_T_PIXEL_FORMAT_YUYV,
        BOT_CORE_IMAGE_T_PIXEL_FORMAT_GRAY,  BOT_CORE_IMAGE_T_PIXEL_FORMAT_RGB};
    drivers::LoggedImage image{.width_px = format.width_px, .height_px = format.height_px};
    image.fourcc = kPixels.at(bytes.Take<std::uint8_t>() % kPixels.size());
    image.row_stride_bytes = bytes.TakeIn(0, 128);
    image.data = bytes.rest();
    const auto kind = drivers::PictureKindOf(image);
    HV_EXPECT(kind.has_value() == (image.fourcc != BOT_CORE_IMAGE_T_PIXEL_FORMAT_RGB));
    if (!kind) return;
    std::vector<std::uint8_t> frame(hal::FrameBytes(kind->format));
    const bool whole = drivers::LcmLogPictureDecoder(*kind).Decode(image, frame).ok();
    HV_EXPECT(!whole || kind->compressed || image.data.size() >= frame.size());
    HV_EXPECT(whole || kind->compressed || image.row_stride_bytes > 0 ||
              image.data.size() < frame.size());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static GuardedBytes guarded;
    static std::array<Decoders, 3> decoders{Decoders({.width_px = 16, .height_px = 16}),
                                            Decoders({.width_px = 32, .height_px = 18}),
                                            Decoders({.width_px = 34, .height_px = 32})};
    FuzzBytes bytes(guarded.Hold({data, size}));
    const auto choice = bytes.Take<std::uint8_t>();
    Decoders& chosen = decoders.at(choice % decoders.size());
    switch (choice / decoders.size() % 4) {
        case 0:
        case 1:
            chosen.DecodeLive(bytes.rest());
            break;
        case 2:
            chosen.DecodeReplayed(bytes.rest());
            break;
        default:
            DecodeLogged(bytes, chosen.format());
    }
    return 0;
}

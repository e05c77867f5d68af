#include "drivers/libcamera_configuration.hpp"

#include <libcamera/version.h>

#include <optional>

#define HITCHVIEW_LIBCAMERA_HAS_ORIENTATION \
    (LIBCAMERA_VERSION_MAJOR > 0 || LIBCAMERA_VERSION_MINOR >= 2)

namespace hitchview::drivers {
namespace {

using libcamera::CameraConfiguration;
using libcamera::StreamConfiguration;
using Packed = LibcameraPixelFormat::Packed;

std::string SizeText(const libcamera::Size& size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
}

#if HITCHVIEW_LIBCAMERA_HAS_ORIENTATION

using Turn = libcamera::Orientation;

Turn& TurnOf(CameraConfiguration& configuration) {
    return configuration.orientation;
}

Turn Wanted(bool horizontal, bool vertical) {
    if (horizontal && vertical) return Turn::Rotate180;
    if (horizontal) return Turn::Rotate0Mirror;
    return vertical ? Turn::Rotate180Mirror : Turn::Rotate0;
}

#else

using Turn = libcamera::Transform;

Turn& TurnOf(CameraConfiguration& configuration) {
    return configuration.transform;
}

Turn Wanted(bool horizontal, bool vertical) {
    return (horizontal ? Turn::HFlip : Turn::Identity) | (vertical ? Turn::VFlip : Turn::Identity);
}

#endif

/// Rotation by 180 degrees is both mirrors.
Turn Wanted(const LibcameraOptions& options) {
    const bool half_turn = options.rotation_deg == 180;
    return Wanted(options.horizontal_flip != half_turn, options.vertical_flip != half_turn);
}

void Ask(const LibcameraOptions& options, const LibcameraPixelFormat& format,
         CameraConfiguration& configuration) {
    StreamConfiguration& stream = configuration.at(0);
    stream.pixelFormat = libcamera::PixelFormat(format.fourcc);
    stream.size = {static_cast<unsigned>(options.width_px),
                   static_cast<unsigned>(options.height_px)};
    stream.bufferCount = static_cast<unsigned>(options.buffers);
    // As before the pipeline has had its say about another format.
    stream.stride = 0;
    stream.colorSpace.reset();
    TurnOf(configuration) = Wanted(options);
}

hal::Range RangeOf(const StreamConfiguration& stream, const LibcameraPixelFormat& format) {
    if (format.packed != Packed::kLent || format.delivered == hal::PixelFormat::kGrey)
        return hal::Range::kFull;
    const bool full =
        stream.colorSpace && stream.colorSpace->range == libcamera::ColorSpace::Range::Full;
    return full ? hal::Range::kFull : hal::Range::kLimited;
}

LibcameraLayout LayoutOf(const StreamConfiguration& stream, const LibcameraPixelFormat& format) {
    return {&format, static_cast<int>(stream.size.width), static_cast<int>(stream.size.height),
            static_cast<int>(stream.stride)};
}

/// Empty if it fits; otherwise what is granted.
std::optional<std::string> Misfit(const LibcameraOptions& options,
                                  const LibcameraPixelFormat& format,
                                  CameraConfiguration& configuration) {
    const StreamConfiguration& stream = configuration.at(0);
    const std::string granted = stream.pixelFormat.toString() + " " + SizeText(stream.size);
    if (stream.pixelFormat.fourcc() != format.fourcc) return granted;
    const libcamera::Size wanted(static_cast<unsigned>(options.width_px),
                                 static_cast<unsigned>(options.height_px));
    if (stream.size != wanted && !options.accept_granted_size) return granted;
    if (stream.size.width % 2 != 0 || stream.size.height % 2 != 0)
        return granted + ", which is not even";
    if (TurnOf(configuration) != Wanted(options)) return granted + ", not turned or mirrored";
    if (!HoldsLines(LayoutOf(stream, format)))
        return granted + " in lines of " + std::to_string(stream.stride) + " bytes";
    return std::nullopt;
}

bool IsAskedFor(const LibcameraOptions& options, const LibcameraPixelFormat& format) {
    return options.format == "best" || options.format == format.name;
}

}  // namespace

hal::FrameFormat LibcameraGranted::format() const {
    return {layout.width_px, layout.height_px, layout.pixel_format->delivered, range};
}

hal::Checked<LibcameraGranted> AgreeWithLibcamera(libcamera::Camera& camera,
                                                  const LibcameraOptions& options) {
    LibcameraGranted granted;
    granted.configuration = camera.generateConfiguration({libcamera::StreamRole::VideoRecording});
    if (granted.configuration == nullptr || granted.configuration->empty())
        return std::string("it gives no stream of video");
    std::string offered;
    for (const LibcameraPixelFormat& format : LibcameraPixelFormats()) {
        if (!IsAskedFor(options, format)) continue;
        Ask(options, format, *granted.configuration);
        if (granted.configuration->validate() == CameraConfiguration::Invalid) continue;
        const auto misfit = Misfit(options, format, *granted.configuration);
        if (!misfit) {
            granted.layout = LayoutOf(granted.stream(), format);
            granted.range = RangeOf(granted.stream(), format);
            return granted;
        }
        if (offered.find(*misfit) == std::string::npos)
            offered += (offered.empty() ? "" : "; ") + *misfit;
    }
    return "wanted " + options.format + " " + std::to_string(options.width_px) + "x" +
           std::to_string(options.height_px) + ", granted " +
           (offered.empty() ? "nothing" : offered);
}

}  // namespace hitchview::drivers

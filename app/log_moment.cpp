#include "app/log_moment.hpp"

#include <chrono>
#include <cstdlib>

namespace hitchview::app {
namespace {

std::string Sized(int width_px, int height_px, const std::string& pixels) {
    return std::to_string(width_px) + "x" + std::to_string(height_px) + " " + pixels;
}

/// The four characters, or the number where they are none.
std::string Fourcc(std::int32_t code) {
    std::string text;
    for (int shift = 0; shift < 32; shift += 8) {
        const auto letter = static_cast<char>(static_cast<std::uint32_t>(code) >> shift);
        if (letter < ' ' || letter > '~') return "pixel format " + std::to_string(code);
        text += letter;
    }
    return text;
}

const char* NameOf(hal::PixelFormat format) {
    switch (format) {
        case hal::PixelFormat::kNv12:
            return "NV12";
        case hal::PixelFormat::kI420:
            return "I420";
        case hal::PixelFormat::kUyvy:
            return "UYVY";
        case hal::PixelFormat::kYuyv:
            return "YUYV";
        case hal::PixelFormat::kGrey:
            return "GREY";
    }
    return "";
}

}  // namespace

std::optional<hal::Instant> MomentOf(const drivers::LoggedImage& image, std::int64_t utime_us,
                                     bool stamped) {
    if (stamped) return image.captured_at;
    constexpr std::int64_t kFurthest_us = 10'000'000;
    const bool near = std::abs(image.utime_us - utime_us) < kFurthest_us;
    return std::chrono::microseconds(near ? image.utime_us : utime_us);
}

std::string Describe(const drivers::LoggedImage& image) {
    return Sized(image.width_px, image.height_px, Fourcc(image.fourcc)) +
           (image.range == hal::Range::kLimited ? ", limited range" : "");
}

std::string Describe(const drivers::LcmLogPictureKind& kind) {
    const hal::FrameFormat& format = kind.format;
    return Sized(format.width_px, format.height_px,
                 kind.compressed ? "MJPG" : NameOf(format.pixel_format)) +
           (format.range == hal::Range::kLimited ? ", limited range" : "");
}

}  // namespace hitchview::app

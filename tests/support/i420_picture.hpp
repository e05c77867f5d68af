#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "hal/frame.hpp"

namespace hitchview::tests {

/// A full-range I420 frame with its own memory.
class I420Picture {
 public:
    I420Picture(int width_px, int height_px)
        : format_{width_px, height_px, hal::PixelFormat::kI420, hal::Range::kFull},
          bytes_(hal::FrameBytes(format_)) {}

    /// Every byte is 128 give or take at most half of `amplitude`.
    static I420Picture Noise(int width_px, int height_px, int amplitude, unsigned seed) {
        I420Picture picture(width_px, height_px);
        std::mt19937 random(seed);
        for (auto& byte : picture.bytes_) {
            const auto offset = static_cast<int>(random() % static_cast<unsigned>(amplitude + 1));
            byte = static_cast<std::uint8_t>(128 - amplitude / 2 + offset);
        }
        return picture;
    }

    /// Soft waves that move with `phase`, in colour.
    static I420Picture Waves(int width_px, int height_px, int phase);

    [[nodiscard]] const hal::FrameFormat& format() const { return format_; }
    [[nodiscard]] std::vector<std::uint8_t>& bytes() { return bytes_; }
    [[nodiscard]] hal::FrameView view() const {
        return {format_, {}, hal::PackedPlanes(format_, bytes_.data())};
    }

 private:
    hal::FrameFormat format_;
    std::vector<std::uint8_t> bytes_;
};

inline I420Picture I420Picture::Waves(int width_px, int height_px, int phase) {
    I420Picture picture(width_px, height_px);
    auto* const luma = picture.bytes_.data();
    auto* const u = luma + width_px * height_px;
    auto* const v = u + width_px * height_px / 4;
    const auto triangle = [](int x) {
        return static_cast<std::uint8_t>(x & 128 ? 255 - x % 256 : x % 256);
    };
    for (int y = 0; y < height_px; ++y) {
        for (int x = 0; x < width_px; ++x) {
            luma[y * width_px + x] = static_cast<std::uint8_t>(64 + triangle(x + y + phase));
        }
    }
    for (int y = 0; y < height_px / 2; ++y) {
        for (int x = 0; x < width_px / 2; ++x) {
            u[y * width_px / 2 + x] = static_cast<std::uint8_t>(64 + triangle(x));
            v[y * width_px / 2 + x] = static_cast<std::uint8_t>(64 + triangle(y + x / 2));
        }
    }
    return picture;
}

}  // namespace hitchview::tests

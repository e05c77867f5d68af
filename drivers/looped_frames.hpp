#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hal/frame.hpp"

namespace hitchview::drivers {

/// The first frames of the cameras of a rig, in memory: shown forth and back (0 1 2 3 2 1 0 1 ...)
/// they have neither an end nor a jump. FrameBytes(format) for each frame of each camera. Constant
/// after construction, so that any number of cameras may show them. Thread-safe.
class LoopedFrames {
 public:
    /// Writes frame `frame` of camera `camera`; false: the camera gives none.
    using Draw = std::function<bool(int camera, int frame, std::span<std::uint8_t> out)>;

    /// Draws `frames` >= 2 frames of each of `cameras`, whatever their numbers >= 0, each camera on
    /// a thread of its own.
    LoopedFrames(const hal::FrameFormat& format, std::span<const int> cameras, int frames,
                 const Draw& draw);

    [[nodiscard]] const hal::FrameFormat& format() const { return format_; }
    /// What camera `camera`, one of those drawn, shows as its frame number `number` of the loop; of
    /// no bytes where it gives none.
    [[nodiscard]] std::span<const std::uint8_t> Frame(int camera, std::uint64_t number) const;

 private:
    struct Film {
        std::vector<std::uint8_t> bytes;
        std::vector<bool> given;
    };

    void Fill(Film& film, int camera, const Draw& draw) const;
    [[nodiscard]] std::span<std::uint8_t> Place(std::span<std::uint8_t> film, int frame) const;

    hal::FrameFormat format_;
    int frames_;
    std::vector<Film> films_;  // by the cameras' numbers
};

}  // namespace hitchview::drivers

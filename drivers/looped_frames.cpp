#include "drivers/looped_frames.hpp"

#include <algorithm>
#include <thread>

#include "drivers/frame_loop.hpp"
#include "hal/expect.hpp"

namespace hitchview::drivers {

LoopedFrames::LoopedFrames(const hal::FrameFormat& format, std::span<const int> cameras, int frames,
                           const Draw& draw)
    : format_(format), frames_(frames) {
    HV_EXPECT(frames >= 2);
    if (!cameras.empty())
        films_.resize(static_cast<std::size_t>(*std::ranges::max_element(cameras)) + 1);
    std::vector<std::jthread> threads;
    for (const int camera : cameras) {
        Film& film = films_[static_cast<std::size_t>(camera)];
        threads.emplace_back([this, camera, &film, &draw] { Fill(film, camera, draw); });
    }
}

void LoopedFrames::Fill(Film& film, int camera, const Draw& draw) const {
    film.bytes.resize(hal::FrameBytes(format_) * static_cast<std::size_t>(frames_));
    for (int frame = 0; frame < frames_; ++frame)
        film.given.push_back(draw(camera, frame, Place(film.bytes, frame)));
}

std::span<std::uint8_t> LoopedFrames::Place(std::span<std::uint8_t> film, int frame) const {
    const std::size_t bytes = hal::FrameBytes(format_);
    return film.subspan(bytes * static_cast<std::size_t>(frame), bytes);
}

std::span<const std::uint8_t> LoopedFrames::Frame(int camera, std::uint64_t number) const {
    const auto place = static_cast<std::size_t>(camera);
    HV_EXPECT(place < films_.size() && !films_[place].bytes.empty());
    const Film& film = films_[place];
    const auto frame =
        static_cast<std::size_t>(ForthAndBack(number, static_cast<std::uint64_t>(frames_) - 1));
    if (!film.given[frame]) return {};
    const std::size_t bytes = hal::FrameBytes(format_);
    return std::span(film.bytes).subspan(bytes * frame, bytes);
}

}  // namespace hitchview::drivers

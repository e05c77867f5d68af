#include "app/picture_judge.hpp"

#include <bit>
#include <utility>

namespace hitchview::app {
namespace {

bool GoesOn(std::uint32_t sequence, std::uint32_t before) {
    return static_cast<std::int32_t>(sequence - before) > 0;
}

}  // namespace

PictureVerdict PictureJudge::Judge(const hal::PanoramaImage& image, hal::Instant now,
                                   std::optional<int> cameras) {
    age_.Note(image.captured_until, now);
    const auto before = std::exchange(sequence_, image.sequence);
    if (before && !GoesOn(image.sequence, *before)) return PictureVerdict::kRepeated;
    if (age_.At(now) > kMaxAge) return PictureVerdict::kOld;
    const int missing = std::popcount(image.cameras_missing);
    if (missing > 0 && missing >= cameras.value_or(0)) return PictureVerdict::kNoCamera;
    return PictureVerdict::kShown;
}

}  // namespace hitchview::app

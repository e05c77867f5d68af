#include "app/picture_signs.hpp"

#include <algorithm>
#include <functional>

namespace hitchview::app {
namespace {

using algo::PictureLook;
using hal::CameraState;

/// Darker than a night without any lamp, whose noise alone is brighter.
constexpr float kBlackMean = 12;
constexpr float kBlackShare = 0.985F;
constexpr float kWhiteShare = 0.6F;

/// Parts of a picture that are looked at for its sharpness: under a smear even the sharpest are
/// blurred, behind the plain side of a lorry some are not.
constexpr std::size_t kSharpestCells = 8;
/// Share of what the other cameras see below which detail counts as lost.
constexpr float kLostDetail = 0.1F;
/// Detail (grey levels squared) of parts and pictures that have any.
constexpr float kSomeDetail = 60;
/// Of the parts that can be judged.
constexpr float kDirtyShare = 1.0F / 6;
constexpr int kDirtyCells = 4;
/// What is left after a set of the most that was seen: gone after about two seconds.
constexpr float kRemembered = 0.946F;

float SharpnessOf(const PictureLook& look) {
    std::array<float, PictureLook::kCells> fine{};
    std::ranges::transform(look.cells, fine.begin(), &PictureLook::Cell::fine);
    std::ranges::partial_sort(fine, fine.begin() + kSharpestCells, std::greater<>());
    float sum = 0;
    for (std::size_t i = 0; i < kSharpestCells; ++i) sum += fine[i];
    return sum / kSharpestCells;
}

}  // namespace

void PictureSigns::Begin() {
    for (Camera& camera : cameras_) camera.present = false;
}

void PictureSigns::Add(std::size_t index, const algo::CameraFrame& picture) {
    Camera& camera = cameras_[index];
    camera.present = true;
    camera.look = algo::LookAt(picture);
    camera.repeated = Repeats(camera, picture);
    camera.sharpness = SharpnessOf(camera.look);
    for (std::size_t i = 0; i < camera.recent.size(); ++i)
        camera.recent[i] = std::max(kRemembered * camera.recent[i], camera.look.cells[i].fine);
}

/// All of the picture is compared only where its samples do not differ.
bool PictureSigns::Repeats(Camera& camera, const algo::CameraFrame& picture) {
    camera.seems_repeated = camera.look.print == camera.print_before;
    if (!camera.seems_repeated) {
        camera.print_before = camera.look.print;
        camera.whole_print_before.reset();
        return false;
    }
    const std::uint64_t whole_print = algo::PrintOf(picture);
    const bool repeats = camera.whole_print_before == whole_print;
    camera.whole_print_before = whole_print;
    return repeats;
}

std::size_t PictureSigns::Present() const {
    return static_cast<std::size_t>(std::ranges::count(cameras_, true, &Camera::present));
}

/// Of the cameras in the set; at least one is.
template <typename Value>
float PictureSigns::Median(const Value& value_of) const {
    std::array<float, kMaxCameras> values{};
    std::size_t count = 0;
    for (const Camera& camera : cameras_)
        if (camera.present) values[count++] = value_of(camera);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
}

bool PictureSigns::IsDirty(const Camera& camera, const Cells& usual) const {
    int judged = 0;
    int lost = 0;
    for (std::size_t i = 0; i < usual.size(); ++i) {
        if (usual[i] < kSomeDetail) continue;
        ++judged;
        if (camera.recent[i] < kLostDetail * usual[i]) ++lost;
    }
    return lost >= kDirtyCells && static_cast<float>(lost) >= kDirtyShare * static_cast<float>(judged);
}

void PictureSigns::Finish(std::array<CameraSigns, kMaxCameras>& signs) {
    const bool compared = Present() >= kLeastCameras;
    Cells usual{};
    float usual_sharpness = 0;
    if (compared) {
        usual_sharpness = Median([](const Camera& camera) { return camera.sharpness; });
        for (std::size_t i = 0; i < usual.size(); ++i)
            usual[i] = Median([i](const Camera& camera) { return camera.recent[i]; });
    }
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        const Camera& camera = cameras_[i];
        if (!camera.present) continue;
        signs[i][CameraState::kBlack] =
            camera.look.mean < kBlackMean && camera.look.dark_share >= kBlackShare;
        signs[i][CameraState::kBlinded] = camera.look.bright_share >= kWhiteShare;
        signs[i][CameraState::kFrozen] = camera.repeated;
        const bool shows_nothing =
            signs[i][CameraState::kBlack] || signs[i][CameraState::kBlinded];
        if (!compared || shows_nothing) continue;
        signs[i][CameraState::kBlurred] = usual_sharpness >= kSomeDetail &&
                                          camera.sharpness < kLostDetail * usual_sharpness;
        signs[i][CameraState::kDirty] = IsDirty(camera, usual);
    }
}

}  // namespace hitchview::app

#include "app/picture_signs.hpp"

#include <algorithm>
#include <cmath>
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
/// Shares of what is expected below which the detail of a picture, and of a part, counts as lost,
/// and above which that of a part is found again: the scene makes it come and go.
constexpr float kLostSharpness = 0.1F;
constexpr float kLostDetail = 0.12F;
constexpr float kFoundDetail = 0.2F;
/// The most that a camera's habit lets it be expected to have beside the others: what it makes of a
/// hedge while they see the sky says nothing of the road.
constexpr float kRichest = 4;
/// Detail (grey levels squared) of parts and pictures that have any.
constexpr float kSomeDetail = 60;
/// Of the parts that can be judged.
constexpr float kDirtyShare = 1.0F / 6;
constexpr int kDirtyCells = 4;
/// What is left after a set of the most that was seen: gone after about a second.
constexpr float kRemembered = 0.92F;
/// Sets over which a camera's habit is learnt, and before which it says nothing.
constexpr int kHabitSets = 300;
constexpr int kFirstHabitSets = 30;

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

std::size_t PictureSigns::Compared() const {
    return static_cast<std::size_t>(std::ranges::count(cameras_, true, &Camera::compared));
}

/// To compare with them alone. Where most cameras lack detail, the scene does.
bool PictureSigns::EnoughAreClean() const {
    const auto clean = static_cast<std::size_t>(std::ranges::count_if(
        cameras_, [](const Camera& camera) { return camera.compared && !camera.dirty; }));
    return clean >= kLeastCameras && 2 * clean >= Compared();
}

/// Of the cameras that can be compared; at least one can. A dirty one would make another's dirt
/// look usual.
template <typename Value>
float PictureSigns::Median(const Value& value_of) const {
    const bool clean_alone = EnoughAreClean();
    std::array<float, kMaxCameras> values{};
    std::size_t count = 0;
    for (const Camera& camera : cameras_)
        if (camera.compared && !(clean_alone && camera.dirty)) values[count++] = value_of(camera);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
}

/// `usual`: what the cameras have in that part. Expected is that, or what this one usually makes of
/// it where that is more: a part that is richer than the others' is missed when it is as theirs.
float PictureSigns::Habit::Expects(float usual) const {
    if (sets < kFirstHabitSets) return usual;
    return std::clamp(std::exp(log_share), 1.0F, kRichest) * usual;
}

void PictureSigns::Habit::Learn(float detail, float usual) {
    constexpr float kNothing = 1;  // grey levels squared: noise
    const float share = std::log((detail + kNothing) / (usual + kNothing));
    sets = std::min(sets + 1, kHabitSets);
    log_share += (share - log_share) / static_cast<float>(sets);
}

/// What is lost is not learnt: a camera does not get used to dirt.
bool PictureSigns::IsDirty(Camera& camera, const Cells& usual) {
    int judged = 0;
    int lost = 0;
    for (std::size_t i = 0; i < usual.size(); ++i) {
        Part& part = camera.parts[i];
        const float expected = part.habit.Expects(usual[i]);
        const bool is_judged = expected >= kSomeDetail;
        part.lost =
            is_judged && camera.recent[i] < (part.lost ? kFoundDetail : kLostDetail) * expected;
        judged += is_judged ? 1 : 0;
        lost += part.lost ? 1 : 0;
        if (!part.lost) part.habit.Learn(camera.recent[i], usual[i]);
    }
    return lost >= kDirtyCells &&
           static_cast<float>(lost) >= kDirtyShare * static_cast<float>(judged);
}

void PictureSigns::Finish(std::array<CameraSigns, kMaxCameras>& signs) {
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        Camera& camera = cameras_[i];
        camera.compared = false;
        if (!camera.present) continue;
        const algo::PictureLook& look = camera.look;
        signs[i][CameraState::kBlack] = look.mean < kBlackMean && look.dark_share >= kBlackShare;
        signs[i][CameraState::kBlinded] = look.bright_share >= kWhiteShare;
        signs[i][CameraState::kFrozen] = camera.repeated;
        camera.compared =
            !signs[i][CameraState::kBlack] && !signs[i][CameraState::kBlinded] && !camera.repeated;
    }
    FindBlurred(signs);
    FindDirty(signs);
}

/// Those that are take no further part in the comparison.
void PictureSigns::FindBlurred(std::array<CameraSigns, kMaxCameras>& signs) {
    if (Compared() < kLeastCameras) return;
    const float usual = Median([](const Camera& camera) { return camera.sharpness; });
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        if (!cameras_[i].compared) continue;
        signs[i][CameraState::kBlurred] =
            usual >= kSomeDetail && cameras_[i].sharpness < kLostSharpness * usual;
        cameras_[i].compared = !signs[i][CameraState::kBlurred];
    }
}

void PictureSigns::FindDirty(std::array<CameraSigns, kMaxCameras>& signs) {
    if (Compared() < kLeastCameras) return;
    Cells usual{};
    for (std::size_t i = 0; i < usual.size(); ++i)
        usual[i] = Median([i](const Camera& camera) { return camera.recent[i]; });
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        if (!cameras_[i].compared) continue;
        cameras_[i].dirty = IsDirty(cameras_[i], usual);
        signs[i][CameraState::kDirty] = cameras_[i].dirty;
    }
}

}  // namespace hitchview::app

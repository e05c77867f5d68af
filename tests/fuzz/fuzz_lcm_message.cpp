#include <algorithm>
#include <cmath>
#include <string_view>

#include "drivers/lcm_camera_names.hpp"
#include "drivers/lcm_image_message.hpp"
#include "drivers/lcm_log_messages.hpp"
#include "drivers/lcm_logged_health.hpp"
#include "drivers/lcm_logged_overlay.hpp"
#include "drivers/lcm_message_bounds.hpp"
#include "hal/expect.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace hitchview;
using Bytes = std::span<const std::uint8_t>;

bool IsIn(Bytes message, const void* data, std::size_t size) {
    const auto* const first = static_cast<const std::uint8_t*>(data);
    return size == 0 ||
           (first >= message.data() && first + size <= message.data() + message.size());
}

void ExpectIn(Bytes message, std::string_view text) {
    HV_EXPECT(IsIn(message, text.data(), text.size()));
}

bool IsSide(int side_px) {
    return side_px >= 1 && side_px <= 16384;
}

void ReadPanorama(Bytes message) {
    const auto image = drivers::ParseImageMessage(message);
    if (!image) return;
    const auto& jpeg = image.value().jpeg;
    HV_EXPECT(!jpeg.empty() && IsIn(message, jpeg.data(), jpeg.size()));
    HV_EXPECT(IsSide(image.value().width_px) && IsSide(image.value().height_px));
}

void ReadCameraNames(Bytes message) {
    const auto names = drivers::ParseCameraNames(message);
    if (!names) return;
    HV_EXPECT(drivers::ParseLoggedHealth(message).ok());
    HV_EXPECT(names.value().size() <= 8);
    for (const std::string& name : names.value()) HV_EXPECT(name.size() <= 63);
}

void ReadImage(Bytes message) {
    const auto parsed = drivers::ParseLoggedImage(message);
    if (!parsed) return;
    const drivers::LoggedImage& image = parsed.value();
    HV_EXPECT(IsSide(image.width_px) && IsSide(image.height_px) && image.row_stride_bytes >= 0);
    HV_EXPECT(IsIn(message, image.data.data(), image.data.size()));
    HV_EXPECT(!image.captured_at || drivers::IsInstant(*image.captured_at));
    HV_EXPECT(drivers::IsEpoch(image.utime_us));
}

void ReadCanFrame(Bytes message) {
    const auto parsed = drivers::ParseLoggedCanFrame(message);
    if (!parsed) return;
    const hal::CanFrame& frame = parsed.value().frame;
    ExpectIn(message, parsed.value().bus);
    HV_EXPECT(frame.kind <= hal::CanFrameKind::kError);
    const bool longer = frame.extended || frame.kind == hal::CanFrameKind::kError;
    HV_EXPECT(frame.id <= (longer ? 0x1fffffffU : 0x7ffU));
    HV_EXPECT(frame.size_bytes <= (frame.fd ? 64 : 8));
    HV_EXPECT(drivers::IsInstant(frame.received_at));
    HV_EXPECT(drivers::IsEpoch(frame.epoch.count() / 1000));
}

void ReadHitchAngle(Bytes message) {
    const auto parsed = drivers::ParseLoggedHitchAngle(message);
    if (!parsed) return;
    const hal::HitchAngle& angle = parsed.value().angle;
    HV_EXPECT(angle.quality <= hal::HitchAngleQuality::kStale);
    HV_EXPECT(angle.quality != hal::HitchAngleQuality::kValid || std::isfinite(angle.angle_rad));
    HV_EXPECT(drivers::IsEpoch(parsed.value().utime_us) && drivers::IsInstant(angle.received_at));
}

void ReadTimes(Bytes message) {
    if (const auto status = drivers::ParseLoggedStatus(message))
        HV_EXPECT(drivers::IsEpoch(status.value().utime_us));
    const auto clock = drivers::ParseLoggedClock(message);
    HV_EXPECT(!clock || (drivers::IsEpoch(clock.value().utime_us) &&
                         drivers::IsInstant(clock.value().monotonic)));
}

void ReadEvent(Bytes message) {
    const auto event = drivers::ParseLoggedEvent(message);
    if (!event) return;
    ExpectIn(message, event.value().subject);
    ExpectIn(message, event.value().text);
    HV_EXPECT(drivers::IsEpoch(event.value().utime_us));
}

void ReadRig(Bytes message) {
    const auto parsed = drivers::ParseLoggedRig(message);
    if (!parsed) return;
    const drivers::LoggedRig& rig = parsed.value();
    for (const auto text : {rig.rig_yaml, rig.calibration_yaml, rig.calibration_id})
        ExpectIn(message, text);
    HV_EXPECT(rig.cameras.size() <= 32 && rig.camera_channels.size() == rig.cameras.size());
    for (const auto name : rig.cameras) ExpectIn(message, name);
    for (const auto channel : rig.camera_channels) ExpectIn(message, channel);
    HV_EXPECT(std::isfinite(rig.period_ms) && rig.period_ms > 0);
}

void ReadHealth(Bytes message) {
    const auto parsed = drivers::ParseLoggedHealth(message);
    if (!parsed) return;
    const drivers::LoggedHealth& health = parsed.value();
    HV_EXPECT(health.cameras.size() <= drivers::kMostHealthCameras);
    HV_EXPECT(health.stages.size() <= drivers::kMostHealthStages);
    for (const auto text : {health.version, health.calibration_id, health.warning})
        ExpectIn(message, text);
    for (const drivers::LoggedCameraHealth& camera : health.cameras) {
        ExpectIn(message, camera.name);
        ExpectIn(message, camera.unit);
        HV_EXPECT(std::isfinite(camera.frames_per_s) && camera.frames_per_s >= 0);
    }
    for (const drivers::LoggedStageTime& stage : health.stages) ExpectIn(message, stage.name);
}

void ReadOverlay(Bytes message) {
    const auto parsed = drivers::ParseLoggedOverlay(message);
    if (!parsed) return;
    const drivers::LoggedOverlay& overlay = parsed.value();
    HV_EXPECT(IsSide(overlay.width_px) && IsSide(overlay.height_px));
    for (const int count : {overlay.mesh_rows, overlay.mesh_columns})
        HV_EXPECT(count >= 0 && count <= drivers::kMostOverlayRows);
    const auto vertices = static_cast<std::size_t>(2 * overlay.mesh_rows * overlay.mesh_columns);
    HV_EXPECT(overlay.mesh_x_px.size() == vertices && overlay.mesh_y_px.size() == vertices);
    HV_EXPECT(overlay.seam_y_px.size() <= drivers::kMostSeamRows);
    for (const auto* seam : {&overlay.left_seam_x_px, &overlay.right_seam_x_px})
        HV_EXPECT(seam->size() == overlay.seam_y_px.size());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    for (const auto read : {ReadPanorama, ReadCameraNames, ReadImage, ReadCanFrame, ReadHitchAngle,
                            ReadTimes, ReadEvent, ReadRig, ReadHealth, ReadOverlay})
        read({data, size});
    return 0;
}

#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/bot_core_image_t.h"
#include "lcmtypes/hitchview_event_t.h"
#include "lcmtypes/hitchview_health_t.h"
#include "lcmtypes/hitchview_hitch_angle_t.h"
#include "lcmtypes/hitchview_overlay_t.h"
#include "lcmtypes/hitchview_panorama_status_t.h"

namespace hitchview::tests {

using MessageBytes = std::vector<std::uint8_t>;

/// A message by the code that lcm-gen makes.
template <typename Message>
MessageBytes EncodedBy(const Message& message, int (*size)(const Message*),
                       int (*encode)(void*, int, int, const Message*)) {
    MessageBytes bytes(static_cast<std::size_t>(size(&message)));
    encode(bytes.data(), 0, static_cast<int>(bytes.size()), &message);
    return bytes;
}

inline constexpr std::int64_t kRigEpoch_us = 1'700'000'000'000'000;

inline MessageBytes ImageBytes(MessageBytes jpeg, int width_px, int height_px,
                               std::uint32_t sequence, std::int64_t captured_ns,
                               std::uint32_t missing = 0) {
    std::array<std::string, 5> keys{"sequence", "captured_from_ns", "captured_until_ns",
                                    "cameras_missing", "calibration_id"};
    constexpr char kDigits[] = "0123456789abcdef";
    std::string bits = "0x00000000";
    for (std::size_t i = 0; i < 8; ++i) bits[9 - i] = kDigits[missing >> (4 * i) & 15U];
    std::array<std::string, 5> values{std::to_string(sequence), std::to_string(captured_ns),
                                      std::to_string(captured_ns), bits, "5f0c1e9a77d2"};
    std::array<bot_core_image_metadata_t, 5> metadata{};
    for (std::size_t i = 0; i < keys.size(); ++i) {
        metadata.at(i) = {keys.at(i).data(), static_cast<std::int32_t>(values.at(i).size()),
                          reinterpret_cast<std::uint8_t*>(values.at(i).data())};
    }
    const bot_core_image_t message{.utime = kRigEpoch_us + captured_ns / 1000,
                                   .width = width_px,
                                   .height = height_px,
                                   .row_stride = 0,
                                   .pixelformat = BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG,
                                   .size = static_cast<std::int32_t>(jpeg.size()),
                                   .data = jpeg.data(),
                                   .nmetadata = 5,
                                   .metadata = metadata.data()};
    return EncodedBy(message, bot_core_image_t_encoded_size, bot_core_image_t_encode);
}

inline MessageBytes StatusBytes(std::uint32_t sequence, std::int64_t captured_ns,
                                std::uint32_t missing, double latency_ms = 19,
                                double articulation_rad = 0.1) {
    hitchview_panorama_status_t message{};
    message.sequence = static_cast<std::int32_t>(sequence);
    message.utime = kRigEpoch_us + captured_ns / 1000;
    message.capture_ns = captured_ns;
    message.publish_ns = captured_ns + static_cast<std::int64_t>(latency_ms * 1e6);
    message.spread_ns = 4'200'000;
    message.cameras_missing = static_cast<std::int32_t>(missing);
    message.seam_state[0] = HITCHVIEW_PANORAMA_STATUS_T_SEAM_LOCKED;
    message.seam_state[1] = HITCHVIEW_PANORAMA_STATUS_T_SEAM_COAST;
    message.seam_matches[0] = 143;
    message.seam_matches[1] = 38;
    message.unit_features[0] = 612;
    message.unit_features[1] = 804;
    message.total_ms = latency_ms * 0.7;
    message.articulation_rad = articulation_rad;
    message.articulation_sigma_rad = 0.002;
    return EncodedBy(message, hitchview_panorama_status_t_encoded_size,
                     hitchview_panorama_status_t_encode);
}

inline MessageBytes HitchAngleBytes(std::uint32_t sequence, double angle_rad,
                                    std::int8_t quality = 0) {
    const hitchview_hitch_angle_t message{.sequence = static_cast<std::int32_t>(sequence),
                                          .utime = kRigEpoch_us,
                                          .capture_ns = 1,
                                          .valid = quality == 0,
                                          .quality = quality,
                                          .angle_rad = angle_rad};
    return EncodedBy(message, hitchview_hitch_angle_t_encoded_size, hitchview_hitch_angle_t_encode);
}

inline MessageBytes EventBytes(std::uint32_t sequence, std::int16_t code, std::string subject,
                               std::string text) {
    const hitchview_event_t message{.sequence = static_cast<std::int32_t>(sequence),
                                    .utime = kRigEpoch_us,
                                    .monotonic_ns = 1,
                                    .code = code,
                                    .subject = subject.data(),
                                    .text = text.data()};
    return EncodedBy(message, hitchview_event_t_encoded_size, hitchview_event_t_encode);
}

struct RigHealth {
    std::vector<std::string> cameras{};
    std::uint32_t missing = 0;
    std::string warning{};
    double scale = 1;  ///< of the stage times
};

inline MessageBytes HealthBytes(std::uint32_t sequence, RigHealth rig) {
    std::string version = "0.1.0";
    std::string calibration = "5f0c1e9a77d2";
    std::array<std::string, 2> units{"tractor", "trailer"};
    std::vector<hitchview_camera_health_t> cameras;
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
        const bool shown = (rig.missing >> i & 1U) == 0;
        cameras.push_back({.name = rig.cameras[i].data(),
                           .unit = units.at(i < 3 ? 0 : 1).data(),
                           .shown = shown,
                           .state = static_cast<std::int8_t>(shown ? HITCHVIEW_CAMERA_HEALTH_T_GOOD
                                                                   : HITCHVIEW_CAMERA_HEALTH_T_LOST),
                           .frames_per_s = shown ? 30.0 : 0.0,
                           .age_ms = 21,
                           .delivered = 1000 + sequence,
                           .lost = static_cast<std::int64_t>(i % 3),
                           .corrupted = 0,
                           .reopened = 0});
    }
    std::array<std::string, 7> names{"motion", "map", "render", "total", "jpeg", "send", "latency"};
    const std::array<double, 7> times_ms{5.1, 1.2, 6.8, 13.4, 3.1, 0.6, 19.0};
    std::vector<hitchview_stage_time_t> stages;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const double ms = times_ms.at(i) * rig.scale;
        stages.push_back({names.at(i).data(), ms, ms, 1.4 * ms, 2 * ms});
    }
    const hitchview_health_t message{.sequence = static_cast<std::int32_t>(sequence),
                                     .utime = kRigEpoch_us,
                                     .monotonic_ns = 1,
                                     .version = version.data(),
                                     .calibration_id = calibration.data(),
                                     .uptime_s = 4000.0 + sequence,
                                     .panoramas_per_s = 30,
                                     .panoramas = 1000,
                                     .dropped = 0,
                                     .deadline_misses = 2,
                                     .events_lost = 0,
                                     .image_bytes = 142'000,
                                     .image_budget_bytes = 150'000,
                                     .image_quality = 78,
                                     .receive_buffer_bytes = 16'777'216,
                                     .warning = rig.warning.data(),
                                     .rss_bytes = 212'000'000,
                                     .minor_faults = 12,
                                     .major_faults = 0,
                                     .heap_calls = 0,
                                     .recording = HITCHVIEW_HEALTH_T_RECORDING_ON,
                                     .recorded_bytes = 8'400'000'000,
                                     .recording_dropped = 0,
                                     .disk_free_bytes = 412'000'000'000,
                                     .ncameras = static_cast<std::int32_t>(cameras.size()),
                                     .cameras = cameras.data(),
                                     .nstages = static_cast<std::int32_t>(stages.size()),
                                     .stages = stages.data()};
    return EncodedBy(message, hitchview_health_t_encoded_size, hitchview_health_t_encode);
}

/// Two meshes that cover the halves of a panorama, and two seams between them.
inline MessageBytes OverlayBytes(std::uint32_t sequence, int width_px, int height_px,
                                 double phase) {
    constexpr int kRows = 7;
    constexpr int kColumns = 13;
    std::vector<float> x;
    std::vector<float> y;
    for (int unit = 0; unit < 2; ++unit) {
        for (int i = 0; i < kRows * kColumns; ++i) {
            const double column = i % kColumns / (kColumns - 1.0);
            const double row = i / kColumns / (kRows - 1.0);
            const double sway_px = 6 * std::sin(phase + 5 * column + unit);
            x.push_back(static_cast<float>((0.02 + 0.44 * column + 0.5 * unit) * width_px));
            y.push_back(static_cast<float>((0.05 + 0.9 * row) * height_px + sway_px));
        }
    }
    std::vector<float> seam_y;
    std::vector<float> left;
    std::vector<float> right;
    for (int row = 0; row <= 20; ++row) {
        seam_y.push_back(static_cast<float>(row * height_px) / 20.0F);
        left.push_back(static_cast<float>(width_px * (0.25 + 0.01 * std::sin(row + phase))));
        right.push_back(static_cast<float>(width_px * (0.75 + 0.01 * std::cos(row + phase))));
    }
    const hitchview_overlay_t message{.sequence = static_cast<std::int32_t>(sequence),
                                      .utime = kRigEpoch_us,
                                      .capture_ns = 1,
                                      .width = width_px,
                                      .height = height_px,
                                      .mesh_rows = kRows,
                                      .mesh_cols = kColumns,
                                      .nvertices = static_cast<std::int32_t>(x.size()),
                                      .mesh_x = x.data(),
                                      .mesh_y = y.data(),
                                      .seam_rows = static_cast<std::int32_t>(seam_y.size()),
                                      .seam_y = seam_y.data(),
                                      .left_seam_x = left.data(),
                                      .right_seam_x = right.data()};
    return EncodedBy(message, hitchview_overlay_t_encoded_size, hitchview_overlay_t_encode);
}

}  // namespace hitchview::tests

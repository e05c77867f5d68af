#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/lcm_log_writer.hpp"
#include "hal/can_bus.hpp"
#include "hal/expect.hpp"
#include "hal/hitch_angle.hpp"
#include "lcmtypes/bot_core_image_t.h"
#include "lcmtypes/hitchview_can_frame_t.h"
#include "lcmtypes/hitchview_clock_t.h"
#include "lcmtypes/hitchview_event_t.h"
#include "lcmtypes/hitchview_hitch_angle_t.h"
#include "lcmtypes/hitchview_panorama_status_t.h"
#include "lcmtypes/hitchview_rig_t.h"

namespace hitchview::tests {

/// A picture as it goes into a log.
struct LoggedPicture {
    std::int64_t captured_ns = 0;
    std::uint32_t sequence = 0;
    int width_px = 16;
    int height_px = 8;
    std::int32_t fourcc = BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG;
    int row_stride_bytes = 0;
    std::vector<std::uint8_t> data{0xFF, 0xD8, 0xFF, 0xD9};
    std::string range = "full";
};

/// What a log says of its rig.
struct RigTexts {
    std::string rig = "schema: 1\n";
    std::string calibration = "schema: 1\n";
    std::string calibration_id = "schema: 1\n";
};

/// Writes a log of messages as Hitchview records them, encoded by the code that lcm-gen makes. The
/// wall clock is kEpoch_ns ahead of the monotonic one, unless `epoch_ns` is changed.
class MessageLog {
 public:
    static constexpr std::int64_t kEpoch_ns = 1'700'000'000'000'000'000;

    explicit MessageLog(const std::string& file)
        : writer_(std::move(*drivers::LcmLogWriter::Create(file))) {}

    std::int64_t epoch_ns = kEpoch_ns;

    [[nodiscard]] std::int64_t Utime_us(std::int64_t monotonic_ns) const {
        return (epoch_ns + monotonic_ns) / 1000;
    }

    void Rig(std::vector<std::string> cameras, std::vector<std::string> channels, double period_ms,
             RigTexts texts = {}) {
        std::vector<char*> names;
        std::vector<char*> on;
        for (std::string& camera : cameras) names.push_back(camera.data());
        for (std::string& channel : channels) on.push_back(channel.data());
        const hitchview_rig_t message{.utime = Utime_us(0),
                                      .rig_yaml = texts.rig.data(),
                                      .calibration_yaml = texts.calibration.data(),
                                      .calibration_id = texts.calibration_id.data(),
                                      .ncameras = static_cast<std::int32_t>(names.size()),
                                      .camera = names.data(),
                                      .camera_channel = on.data(),
                                      .period_ms = period_ms};
        Append("RIG", message.utime, message, hitchview_rig_t_encoded_size, hitchview_rig_t_encode);
    }

    void Picture(const std::string& channel, LoggedPicture picture) {
        std::array<std::string, 3> keys{"sequence", "captured_ns", "range"};
        std::array<std::string, 3> values{std::to_string(picture.sequence),
                                          std::to_string(picture.captured_ns), picture.range};
        std::array<bot_core_image_metadata_t, 3> metadata{};
        for (std::size_t i = 0; i < keys.size(); ++i)
            metadata.at(i) = {keys.at(i).data(), static_cast<std::int32_t>(values.at(i).size()),
                              reinterpret_cast<std::uint8_t*>(values.at(i).data())};
        const bot_core_image_t message{.utime = Utime_us(picture.captured_ns),
                                       .width = picture.width_px,
                                       .height = picture.height_px,
                                       .row_stride = picture.row_stride_bytes,
                                       .pixelformat = picture.fourcc,
                                       .size = static_cast<std::int32_t>(picture.data.size()),
                                       .data = picture.data.data(),
                                       .nmetadata = 3,
                                       .metadata = metadata.data()};
        Append(channel, message.utime, message, bot_core_image_t_encoded_size,
               bot_core_image_t_encode);
    }

    void Can(const hal::CanFrame& frame, std::string bus = "can0") {
        hal::CanFrame copy = frame;
        const bool remote = frame.kind == hal::CanFrameKind::kRemote;
        const hitchview_can_frame_t message{
            .utime = Utime_us(frame.received_at.count()),
            .capture_ns = frame.received_at.count(),
            .bus = bus.data(),
            .id = static_cast<std::int32_t>(frame.id),
            .extended = frame.extended,
            .kind = static_cast<std::int8_t>(frame.kind),
            .fd = frame.fd,
            .fd_flags = static_cast<std::int8_t>(frame.fd_flags),
            .size = static_cast<std::int8_t>(frame.size_bytes),
            .ndata = static_cast<std::int8_t>(remote ? 0 : frame.size_bytes),
            .data = copy.data.data()};
        Append("CAN_RX", message.utime, message, hitchview_can_frame_t_encoded_size,
               hitchview_can_frame_t_encode);
    }

    void HitchAngle(std::int64_t at_ns, std::uint32_t sequence, hal::HitchAngleQuality quality,
                    double angle_rad) {
        const hitchview_hitch_angle_t message{.sequence = static_cast<std::int32_t>(sequence),
                                              .utime = Utime_us(at_ns),
                                              .capture_ns = at_ns,
                                              .valid = quality == hal::HitchAngleQuality::kValid,
                                              .quality = static_cast<std::int8_t>(quality),
                                              .angle_rad = angle_rad};
        Append("HITCH_ANGLE", message.utime, message, hitchview_hitch_angle_t_encoded_size,
               hitchview_hitch_angle_t_encode);
    }

    void Status(std::int64_t at_ns, std::uint32_t sequence, double articulation_rad) {
        hitchview_panorama_status_t message{};
        message.sequence = static_cast<std::int32_t>(sequence);
        message.utime = Utime_us(at_ns);
        message.capture_ns = at_ns;
        message.publish_ns = at_ns + 40'000'000;
        message.spread_ns = 7'000'000;
        message.cameras_missing = 5;
        message.seam_state[1] = HITCHVIEW_PANORAMA_STATUS_T_SEAM_LOCKED;
        message.total_ms = 12.5;
        message.articulation_rad = articulation_rad;
        Append("PANORAMA_STATUS", message.utime, message, hitchview_panorama_status_t_encoded_size,
               hitchview_panorama_status_t_encode);
    }

    void Clock(std::int64_t at_ns) {
        const hitchview_clock_t message{.utime = Utime_us(at_ns), .monotonic_ns = at_ns};
        Append("CLOCK", message.utime, message, hitchview_clock_t_encoded_size,
               hitchview_clock_t_encode);
    }

    void Event(std::int64_t at_ns, std::uint32_t sequence, std::int16_t code, std::string subject,
               std::string text) {
        const hitchview_event_t message{.sequence = static_cast<std::int32_t>(sequence),
                                        .utime = Utime_us(at_ns),
                                        .monotonic_ns = at_ns,
                                        .code = code,
                                        .subject = subject.data(),
                                        .text = text.data()};
        Append("PANORAMA_EVENT", message.utime, message, hitchview_event_t_encoded_size,
               hitchview_event_t_encode);
    }

    void Bytes(const std::string& channel, std::int64_t at_ns,
               const std::vector<std::uint8_t>& bytes) {
        HV_EXPECT(writer_->Append(Utime_us(at_ns), channel, bytes).ok());
    }

 private:
    template <typename Message>
    void Append(const std::string& channel, std::int64_t utime_us, const Message& message,
                int (*size)(const Message*), int (*encode)(void*, int, int, const Message*)) {
        std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size(&message)));
        HV_EXPECT(encode(bytes.data(), 0, static_cast<int>(bytes.size()), &message) > 0);
        HV_EXPECT(writer_->Append(utime_us, channel, bytes).ok());
    }

    std::unique_ptr<drivers::LcmLogWriter> writer_;
};

}  // namespace hitchview::tests

#pragma once

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <array>
#include <string>
#include <vector>

#include "app/board.hpp"
#include "app/config.hpp"
#include "app/log_channels.hpp"
#include "tests/support/log_messages.hpp"
#include "tests/support/simulated_rig_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::tests {

/// A message of a recorded drive.
struct DriveMessage {
    std::size_t camera = 0;
    std::string channel{};
    LoggedPicture picture{};
};

/// A drive of simulated cameras as it is recorded: the frames of all cameras as they were, in order
/// of the frame sets, and the CAN bus.
struct RecordedDrive {
    static constexpr std::int64_t kStart_ns = 500'000'000;  ///< of the recording's clock

    RigTexts texts{};
    std::vector<std::string> cameras{};
    std::vector<std::string> channels{};
    double period_ms = 0;
    std::vector<DriveMessage> pictures{};
    std::vector<hal::CanFrame> can{};

    void WriteRig(MessageLog& log) const { log.Rig(cameras, channels, period_ms, texts); }
    /// Rig, pictures and CAN frames in order of time.
    void Write(const std::string& file) const {
        MessageLog log(file);
        WriteRig(log);
        auto frame = can.begin();
        for (const DriveMessage& message : pictures) {
            const std::int64_t at_ns = message.picture.captured_ns;
            for (; frame != can.end() && frame->received_at.count() <= at_ns; ++frame)
                log.Can(*frame);
            log.Picture(message.channel, message.picture);
        }
    }
};

/// Calibration and rig file of a small drive of the simulated tractor-trailer; the latter's path.
inline std::string WriteDriveRig(const TemporaryFolder& folder, int frames) {
    WriteSimulatedCalibration(folder, 320, 180);
    return folder.Write("rig.yaml",
                        "schema: 1\n"
                        "canvas: {projection: cylinder, size_px: [1024, 180]}\n"
                        "calibration: rig.calib.yaml\n" +
                            SimulatedUnits([](const std::string&) { return "{simulated: true}"; }) +
                            "simulation: {frames: " + std::to_string(frames) +
                            ", camera_size_px: [320, 180]}\ncan:\n  source: {simulated: true}\n" +
                            kSimulatedHitchAngle);
}

inline LoggedPicture PictureOf(const hal::FrameView& frame) {
    const std::uint8_t* const bytes = frame.planes[0].data;
    return {.captured_ns = RecordedDrive::kStart_ns + frame.header.captured_at.count(),
            .sequence = frame.header.sequence,
            .width_px = frame.format.width_px,
            .height_px = frame.format.height_px,
            .fourcc = BOT_CORE_IMAGE_T_PIXEL_FORMAT_NV12,
            .row_stride_bytes = frame.format.width_px,
            .data = {bytes, bytes + hal::FrameBytes(frame.format)}};
}

/// Drives the rig in `rig_file`, whose cameras are simulated, and records it raw.
inline RecordedDrive RecordDrive(const std::string& rig_file) {
    const app::RigConfig config = app::LoadRigConfig(rig_file).value();
    const calib::RigCalibration calibration = app::LoadCalibrationFor(config).value();
    auto board = std::move(*app::Board::Open(config, {.held_frames = 2}));
    RecordedDrive drive{.texts = {.rig = FileText(rig_file),
                                  .calibration = FileText(config.calibration),
                                  .calibration_id = calibration.id()},
                        .period_ms = static_cast<double>(board->period().count()) / 1e6};
    for (const algo::Unit unit : algo::kUnits) {
        for (const app::CameraConfig& camera : config.units[unit].cameras) {
            drive.cameras.push_back(camera.name);
            drive.channels.push_back(app::CameraChannel(camera.name));
        }
    }
    while (auto set = board->sets().WaitSet()) {
        std::size_t index = 0;
        for (const algo::Unit unit : algo::kUnits) {
            for (std::size_t i = 0; i < config.units[unit].cameras.size(); ++i, ++index) {
                const hal::FrameLease& lease = set->leases[unit][i];
                if (lease)
                    drive.pictures.push_back(
                        {index, drive.channels[index], PictureOf(lease.view())});
            }
        }
    }
    while (board->can_bus() != nullptr) {
        auto frame = board->can_bus()->WaitFrame(std::chrono::milliseconds(1));
        if (!frame) break;
        frame->received_at += hal::Instant(RecordedDrive::kStart_ns);
        drive.can.push_back(frame.value());
    }
    return drive;
}

/// The NV12 picture as a JPEG with 4:2:0 chroma.
inline LoggedPicture Compressed(const LoggedPicture& nv12) {
    const auto luma =
        static_cast<std::size_t>(nv12.width_px) * static_cast<std::size_t>(nv12.height_px);
    std::vector<std::uint8_t> u;
    std::vector<std::uint8_t> v;
    for (std::size_t i = luma; i + 1 < nv12.data.size(); i += 2) {
        u.push_back(nv12.data[i]);
        v.push_back(nv12.data[i + 1]);
    }
    std::array<const unsigned char*, 3> planes{nv12.data.data(), u.data(), v.data()};
    tjhandle compressor = tjInitCompress();
    unsigned char* jpeg = nullptr;
    unsigned long size = 0;
    HV_EXPECT(tjCompressFromYUVPlanes(compressor, planes.data(), nv12.width_px, nullptr,
                                      nv12.height_px, TJSAMP_420, &jpeg, &size, 85, 0) == 0);
    LoggedPicture picture = nv12;
    picture.fourcc = BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG;
    picture.row_stride_bytes = 0;
    picture.data.assign(jpeg, jpeg + size);
    tjFree(jpeg);
    tjDestroy(compressor);
    return picture;
}

inline RecordedDrive Compressed(RecordedDrive drive) {
    for (DriveMessage& message : drive.pictures) message.picture = Compressed(message.picture);
    return drive;
}

}  // namespace hitchview::tests

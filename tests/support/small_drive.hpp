#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "drivers/simulated_rig.hpp"
#include "tests/support/simulated_rig_files.hpp"

namespace hitchview::tests {

inline std::filesystem::path PictureOf(const std::filesystem::path& pictures, int frame) {
    return pictures / (std::to_string(frame) + ".jpg");
}

/// Writes a drive of the simulated rig as grey JPEG sequences of 320 x 180, one folder for each
/// camera (decoding them costs next to nothing), and its calibration. With `length` > `frames` it
/// goes forth and back until it is that long: rendering is what costs time.
inline void RecordSmallDrive(const TemporaryFolder& folder, int frames, int length) {
    WriteSimulatedCalibration(folder, 320, 180);
    const auto created =
        drivers::SimulatedRig::Create({.frames = frames, .width_px = 320, .height_px = 180});
    ASSERT_TRUE(created) << created.error();
    const auto& rig = created.value();
    drivers::Renderer::Workspace workspace;
    std::vector<std::uint8_t> nv12(hal::FrameBytes(rig->format()));
    for (int camera = 0; camera < drivers::SimulatedRig::kCameras; ++camera) {
        const std::filesystem::path pictures = folder / std::string(rig->camera(camera).name);
        std::filesystem::create_directories(pictures);
        for (int frame = 0; frame < frames; ++frame) {
            rig->Render(camera, frame, workspace, nv12);
            const cv::Mat grey(180, 320, CV_8U, nv12.data());
            ASSERT_TRUE(cv::imwrite(PictureOf(pictures, frame), grey));
        }
        for (int frame = frames; frame < length; ++frame) {
            const int along = frame % (2 * frames - 2);
            std::filesystem::create_hard_link(
                PictureOf(pictures, std::min(along, 2 * frames - 2 - along)),
                PictureOf(pictures, frame));
        }
    }
}

/// The rig of such a drive. `more`: further keys.
inline std::string SmallDriveRig(const TemporaryFolder& folder, const std::string& canvas,
                                 const std::string& more) {
    return folder.Write(
        "rig.yaml",
        "schema: 1\ncanvas: " + canvas + "\ncalibration: rig.calib.yaml\n" +
            SimulatedUnits([](const std::string& name) { return "{replay: " + name + "}"; }) +
            more);
}

}  // namespace hitchview::tests

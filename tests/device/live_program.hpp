#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "app/program.hpp"
#include "tests/device/panorama_listener.hpp"
#include "tests/device/vivid.hpp"
#include "tests/support/simulated_rig_files.hpp"

namespace hitchview::tests {

/// `hitchview run` on the eight virtual cameras /dev/video0 ..., and what it says over LCM. Cameras
/// and canvas are small and nothing is estimated: User-Mode Linux runs the threads of a program one
/// at a time.
class LiveProgram {
 public:
    static constexpr std::size_t kCameras = 8;

    LiveProgram() { WriteSimulatedCalibration(folder_, 320, 180); }

    /// Returns when panoramas of all cameras come; false if they do not.
    bool Start() {
        program_ = std::make_unique<app::BackgroundProgram>(
            HITCHVIEW, std::vector<std::string>{"run", "--rig", Rig(), "--out", folder_ / "out"});
        const auto end = PanoramaListener::Now() + std::chrono::seconds(30);
        while (!IsSteady() && PanoramaListener::Now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return IsSteady();
    }

    /// Ends the program. Its report.
    nlohmann::json Finish() {
        program_.reset();
        return nlohmann::json::parse(FileText(folder_ / "out/report.json"));
    }

    [[nodiscard]] std::vector<HeardStatus> statuses() const { return listener_.statuses(); }
    [[nodiscard]] std::vector<HeardEvent> events() const { return listener_.events(); }

 private:
    std::string Rig() {
        int device = 0;
        return folder_.Write("rig.yaml",
                             "schema: 1\n"
                             "canvas: {projection: cylinder, size_px: [512, 90]}\n"
                             "stabilization: {enabled: false}\nstitching: {enabled: false}\n"
                             "threads: {workers: 1}\n"
                             "calibration: rig.calib.yaml\n" +
                                 SimulatedUnits([&](const std::string&) {
                                     return "{v4l2: /dev/video" + std::to_string(device++) +
                                            ", format: uyvy, size_px: [320, 180]}";
                                 }));
    }

    /// The newest second of panoramas lacks no camera.
    [[nodiscard]] bool IsSteady() const {
        constexpr std::size_t kSecond = 30;
        const auto heard = statuses();
        return heard.size() >= kSecond &&
               std::all_of(heard.end() - kSecond, heard.end(),
                           [](const HeardStatus& status) { return status.cameras_missing == 0; });
    }

    TemporaryFolder folder_;
    PanoramaListener listener_;
    std::unique_ptr<app::BackgroundProgram> program_;
};

}  // namespace hitchview::tests

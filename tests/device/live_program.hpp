#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
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

    /// `absent`: a camera whose path leads nowhere before Appear.
    explicit LiveProgram(std::optional<std::size_t> absent = std::nullopt) : absent_(absent) {
        WriteSimulatedCalibration(folder_, 320, 180);
    }

    /// Returns when panoramas of all cameras but `missing` come; false if they do not.
    bool Start(std::uint32_t missing = 0) {
        program_ = std::make_unique<app::BackgroundProgram>(
            HITCHVIEW, std::vector<std::string>{"run", "--rig", Rig(), "--out", folder_ / "out"});
        const auto end = PanoramaListener::Now() + std::chrono::seconds(30);
        while (!IsSteady(missing) && PanoramaListener::Now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return IsSteady(missing);
    }

    /// The absent camera is there.
    void Appear() const {
        std::filesystem::create_symlink("/dev/video" + std::to_string(*absent_), AbsentPath());
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
        std::size_t device = 0;
        return folder_.Write(
            "rig.yaml",
            "schema: 1\n"
            "canvas: {projection: cylinder, size_px: [512, 90]}\n"
            "stabilization: {enabled: false}\nstitching: {enabled: false}\n"
            "threads: {workers: 1}\n"
            "calibration: rig.calib.yaml\n" +
                SimulatedUnits([&](const std::string&) {
                    const std::size_t number = device++;
                    // What the absent one gives is told by the others alone.
                    return number == absent_ ? "{v4l2: " + AbsentPath() + ", size_px: [320, 180]}"
                                             : "{v4l2: /dev/video" + std::to_string(number) +
                                                   ", format: uyvy, size_px: [320, 180]}";
                }));
    }

    [[nodiscard]] std::string AbsentPath() const { return folder_ / "absent"; }

    /// The newest second of panoramas lacks these cameras and no others.
    [[nodiscard]] bool IsSteady(std::uint32_t missing) const {
        constexpr std::size_t kSecond = 30;
        const auto heard = statuses();
        return heard.size() >= kSecond &&
               std::all_of(heard.end() - kSecond, heard.end(), [&](const HeardStatus& status) {
                   return status.cameras_missing == missing;
               });
    }

    std::optional<std::size_t> absent_;
    TemporaryFolder folder_;
    PanoramaListener listener_;
    std::unique_ptr<app::BackgroundProgram> program_;
};

}  // namespace hitchview::tests

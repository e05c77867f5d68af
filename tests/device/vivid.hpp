#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "drivers/v4l2_camera.hpp"

namespace hitchview::tests {

/// Runs a shell command. True if it answers 0.
inline bool Shell(const std::string& command) {
    return WEXITSTATUS(std::system(command.c_str())) == 0;
}

/// The kernel's virtual camera module, here or not.
inline bool VividIsThere() {
    return Shell("modprobe --dry-run vivid 2>/dev/null");
}

enum class VividInput { kWebcam = 0, kHdmi = 3 };

/// What a virtual HDMI source sends: entries of the menu `dv_timings_signal_mode`.
enum VividSignal { kCurrentSignal = 0, kNoSignal = 1, kSelectedSignal = 4 };
/// Entries of the menu `dv_timings`, which the selected signal has.
enum VividTimings { k640x480p59 = 0, k1280x720p30 = 7, k1280x720p60 = 9, k1920x1080p30 = 12 };

struct VividOptions {
    int cameras = 1;
    bool multi_planar = false;
    VividInput input = VividInput::kWebcam;
    int hdmi_camera = -1;  ///< this one has HDMI whatever the others have
};

/// Virtual cameras /dev/video0, /dev/video1, ... with one input each, gone at the end of the scope.
class Vivid {
 public:
    explicit Vivid(const VividOptions& options) : command_(LoadCommand(options)) { Load(); }
    ~Vivid() { Unload(); }
    Vivid(const Vivid&) = delete;
    Vivid& operator=(const Vivid&) = delete;

    bool Load() {
        loaded_ = Shell(command_);
        return loaded_;
    }
    bool Unload() { return Shell("modprobe --remove vivid"); }
    [[nodiscard]] bool loaded() const { return loaded_; }

    /// Also while a camera streams.
    static bool Set(int camera, const std::string& control, int value) {
        return Shell("v4l2-ctl --device " + std::to_string(camera) + " --set-ctrl " + control +
                     "=" + std::to_string(value));
    }

 private:
    static std::string Repeated(const std::string& value, int times) {
        std::string list = value;
        for (int i = 1; i < times; ++i) list.append(",").append(value);
        return list;
    }
    static std::string LoadCommand(const VividOptions& options) {
        std::string numbers;
        std::string inputs;
        for (int i = 0; i < options.cameras; ++i) {
            const auto input = i == options.hdmi_camera ? VividInput::kHdmi : options.input;
            inputs.append(i > 0 ? "," : "").append(std::to_string(static_cast<int>(input)));
            numbers.append(i > 0 ? "," : "").append(std::to_string(i));
        }
        const int n = options.cameras;
        return "modprobe vivid n_devs=" + std::to_string(n) + " node_types=" + Repeated("0x1", n) +
               " num_inputs=" + Repeated("1", n) + " input_types=" + inputs +
               " multiplanar=" + Repeated(options.multi_planar ? "2" : "1", n) +
               " vid_cap_nr=" + numbers;
    }

    std::string command_;
    bool loaded_ = false;
};

inline drivers::V4l2CameraOptions VividCamera(int camera) {
    drivers::V4l2CameraOptions options;
    options.name = "camera" + std::to_string(camera);
    options.path = "/dev/video" + std::to_string(camera);
    return options;
}

}  // namespace hitchview::tests

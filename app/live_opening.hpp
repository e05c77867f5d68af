#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/config.hpp"
#include "drivers/v4l2_camera.hpp"
#include "hal/camera.hpp"

namespace hitchview::app {

/// The live cameras of a rig while they are opened, one after another: each has a place, in the
/// order in which they were added. Thread: one.
class LiveOpening {
 public:
    /// `slots`: frames of a camera that the program may hold; `taps`: of these for its recorder,
    /// which a number of buffers that the rig file states does not count.
    LiveOpening(double rate_hz, int slots, int taps)
        : rate_hz_(rate_hz), slots_(slots), taps_(taps) {}

    /// Opens one. A V4L2 camera that cannot be opened now is absent. The error: it never can be.
    hal::Checked<hal::Done> Add(const CameraConfig& camera);
    /// Places of those that are not there.
    [[nodiscard]] std::vector<std::size_t> Absent() const;
    [[nodiscard]] const std::string& WhyAbsent(std::size_t i) const {
        return opened_[i].refusal.words;
    }
    /// Has those that are not there awaited, by what the others are like.
    void AwaitAbsent();
    /// Null: it is absent, and not awaited.
    [[nodiscard]] std::unique_ptr<hal::Camera> Take(std::size_t i) {
        return std::move(opened_[i].camera);
    }

 private:
    struct Opened {
        std::unique_ptr<hal::Camera> camera;  // null: it is not there
        const drivers::V4l2Camera* v4l2 = nullptr;
        drivers::V4l2CameraOptions options{};
        drivers::V4l2Refusal refusal{};  // why it is not there
    };

    double rate_hz_;
    int slots_;
    int taps_;
    std::vector<Opened> opened_;
};

}  // namespace hitchview::app

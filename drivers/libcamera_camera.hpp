#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/camera.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

/// A control and its value as a person writes them. Name: libcamera's (`cam --list-controls`), any
/// case. Value: a number, true or false; several numbers, separated by spaces or commas, where the
/// control has several.
struct LibcameraControlWish {
    std::string control;
    std::string value;
};

struct LibcameraOptions {
    std::string name;  ///< in the log
    std::string id;    ///< as `cam --list` writes it in brackets
    int width_px = 1280;
    int height_px = 720;
    /// Takes the size that the pipeline makes of it, where it is another; otherwise an error.
    bool accept_granted_size = false;
    double rate_hz = 30;  ///< set where the camera has FrameDurationLimits, otherwise its own
    std::string format = "best";  ///< name of a LibcameraPixelFormat, or best
    int buffers = 8;              ///< frames that the program holds, and three. [2, 32]
    int rotation_deg = 0;         ///< 0 or 180
    bool horizontal_flip = false;
    bool vertical_flip = false;
    std::vector<LibcameraControlWish> controls;  ///< set when the stream starts
    /// Periods without a frame after which the camera is given up. >= 2.
    int silence_periods = 30;
};

/// Camera that libcamera drives.
///
/// Frames are libcamera's own buffers, lent without a copy. They are copied, in the thread that
/// calls WaitFrame, into memory taken at start where they come as three bytes a pixel (delivered as
/// NV12, full range) or where the pipeline gives fewer buffers than options.buffers. What came
/// between opening and the first call of WaitFrame is dropped, and not counted. captured_at:
/// libcamera's SensorTimestamp. Sequence: the camera's, made to go on without a gap when a stream
/// starts again.
///
/// kCorrupted: libcamera has marked the frame, it is too short, or its stamp steps back.
/// kDisconnected: the camera is gone, failed or silent; from then on, until Reopen succeeds, each
/// call answers so at once. Reopen finds the camera by its id; kUnsupported: it no longer gives the
/// format.
///
/// This driver takes no memory from the heap after opening; libcamera itself does, in each call
/// that gives it a buffer back, and throughout Reopen. Leases must not outlive the camera.
///
/// The error names camera, what was wanted, what is granted and what is there. A program that was
/// built without libcamera says so.
hal::Checked<std::unique_ptr<hal::Camera>> OpenLibcamera(const LibcameraOptions& options);

}  // namespace hitchview::drivers

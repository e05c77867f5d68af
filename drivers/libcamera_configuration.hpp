#pragma once

#include <libcamera/camera.h>

#include <memory>

#include "drivers/libcamera_camera.hpp"
#include "drivers/libcamera_format.hpp"

namespace hitchview::drivers {

/// What a pipeline has agreed to, not yet given to the camera.
struct LibcameraGranted {
    std::unique_ptr<libcamera::CameraConfiguration> configuration;
    LibcameraLayout layout;
    hal::Range range = hal::Range::kLimited;  ///< of what is lent; grey and converted: full

    [[nodiscard]] libcamera::StreamConfiguration& stream() const { return configuration->at(0); }
    /// Of the frames that are handed out.
    [[nodiscard]] hal::FrameFormat format() const;
};

/// The first format that the pipeline takes as it is, in the size asked for. The error names what
/// was wanted and what is granted.
hal::Checked<LibcameraGranted> AgreeWithLibcamera(libcamera::Camera& camera,
                                                  const LibcameraOptions& options);

}  // namespace hitchview::drivers

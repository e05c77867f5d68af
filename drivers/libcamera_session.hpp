#pragma once

#include <libcamera/camera_manager.h>

#include <memory>
#include <string>

#include "hal/result.hpp"

namespace hitchview::drivers {

/// libcamera allows one manager in a process; every camera shares it, and the last one ends it.
/// Thread: any, one at a time.
class LibcameraSession {
 public:
    static hal::Checked<std::shared_ptr<LibcameraSession>> Join();
    ~LibcameraSession();
    LibcameraSession(const LibcameraSession&) = delete;
    LibcameraSession& operator=(const LibcameraSession&) = delete;

    /// Null if it is not there.
    std::shared_ptr<libcamera::Camera> Find(const std::string& id) { return manager_.get(id); }
    /// "there are 'a', 'b'", for an error.
    [[nodiscard]] std::string CamerasText() const;

 private:
    LibcameraSession() = default;

    libcamera::CameraManager manager_;
    bool started_ = false;
};

}  // namespace hitchview::drivers

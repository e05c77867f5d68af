#include "drivers/libcamera_session.hpp"

#include <libcamera/camera.h>

#include <cstring>

namespace hitchview::drivers {

hal::Checked<std::shared_ptr<LibcameraSession>> LibcameraSession::Join() {
    static std::weak_ptr<LibcameraSession> current;
    if (auto session = current.lock()) return session;
    std::shared_ptr<LibcameraSession> session(new LibcameraSession);
    if (const int refused = session->manager_.start(); refused != 0)
        return std::string("libcamera does not start: ") + std::strerror(-refused);
    session->started_ = true;
    current = session;
    return session;
}

LibcameraSession::~LibcameraSession() {
    if (started_) manager_.stop();
}

std::string LibcameraSession::CamerasText() const {
    std::string text;
    for (const auto& camera : manager_.cameras())
        text += (text.empty() ? "there are '" : ", '") + camera->id() + "'";
    return text.empty() ? "libcamera finds no camera at all" : text;
}

}  // namespace hitchview::drivers

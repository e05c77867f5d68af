#include "app/camera_device.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace hitchview::app {

bool CameraDevice::IsNamed(const std::string& name) const {
    if (name == path || std::ranges::find(names, name) != names.end()) return true;
    std::error_code missing;
    return std::filesystem::equivalent(name, path, missing);
}

const char* ToString(CameraDevice::State state) {
    switch (state) {
        case CameraDevice::State::kFree:
            return "free";
        case CameraDevice::State::kBusy:
            return "busy";
        case CameraDevice::State::kForbidden:
            return "forbidden";
        case CameraDevice::State::kRefused:
            break;
    }
    return "refused";
}

const char* ToString(CameraDevice::Stamps stamps) {
    switch (stamps) {
        case CameraDevice::Stamps::kStartOfExposure:
            return "start of exposure";
        case CameraDevice::Stamps::kEndOfFrame:
            return "end of frame";
        case CameraDevice::Stamps::kNotMonotonic:
            return "not monotonic";
        case CameraDevice::Stamps::kUnknown:
            break;
    }
    return "unknown";
}

std::string RateText(double rate_hz) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.4g", rate_hz);
    return text.data();
}

std::string SizeText(const Size& size) {
    return std::to_string(size.width_px) + "x" + std::to_string(size.height_px);
}

std::string Remedy(const CameraDevice& device) {
    if (device.IsOpen()) return "";
    if (device.state == CameraDevice::State::kForbidden) {
        return "add the user to group video: sudo usermod --append --groups video USER, then log "
               "in again";
    }
    return "see what the kernel says of it (sudo dmesg), plug it in again";
}

}  // namespace hitchview::app

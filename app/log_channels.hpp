#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

#include "drivers/lcm_log_messages.hpp"
#include "drivers/lcm_log_reader.hpp"

namespace hitchview::app {

inline constexpr std::string_view kCameraChannelPrefix = "CAM_";

/// Name of a camera's channel in a log: `CAM_` and its name in upper case.
inline std::string CameraChannel(std::string_view camera) {
    std::string channel(kCameraChannelPrefix);
    const auto upper = [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; };
    std::ranges::transform(camera, std::back_inserter(channel), upper);
    return channel;
}

inline bool IsCameraChannel(std::string_view channel) {
    return channel.starts_with(kCameraChannelPrefix);
}

/// What each channel of a log holds: a channel is of the kind of its first message, so that a
/// damaged message is not taken for one of another kind. The names of channels may be chosen in the
/// rig file.
class LogChannels {
 public:
    drivers::LoggedKind KindOf(const drivers::LcmLogEvent& event) {
        const auto known = kinds_.find(event.channel);
        if (known != kinds_.end()) return known->second;
        const drivers::LoggedKind kind = drivers::KindOf(event.data);
        kinds_.emplace(event.channel, kind);
        return kind;
    }

 private:
    std::map<std::string, drivers::LoggedKind, std::less<>> kinds_;
};

}  // namespace hitchview::app

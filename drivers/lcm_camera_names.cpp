#include "drivers/lcm_camera_names.hpp"

#include <algorithm>

#include "drivers/lcm_message_reader.hpp"
#include "lcmtypes/hitchview_health_t.h"

namespace hitchview::drivers {
namespace {

constexpr int kMostCameras = 8;
constexpr int kMostStages = 64;
constexpr std::size_t kLongestName = 63;

void Skip(LcmMessageReader& reader, int int64s, int int32s = 0, int bytes = 0) {
    reader.TakeBytes(8L * int64s + 4L * int32s + bytes);
}

bool IsName(std::string_view name) {
    return name.size() <= kLongestName &&
           std::ranges::all_of(name, [](char letter) { return letter >= ' ' && letter <= '~'; });
}

void SkipToCameras(LcmMessageReader& reader) {
    Skip(reader, 2, 1);     // sequence, utime, monotonic_ns
    reader.TakeString();    // version
    reader.TakeString();    // calibration_id
    Skip(reader, 6, 4);     // uptime_s ... receive_buffer_bytes
    reader.TakeString();    // warning
    Skip(reader, 4);        // rss_bytes ... heap_calls
    Skip(reader, 3, 0, 1);  // recording ... disk_free_bytes
}

std::string TakeCamera(LcmMessageReader& reader) {
    const std::string name(reader.TakeString());
    reader.TakeString();    // unit
    Skip(reader, 6, 0, 1);  // shown ... reopened
    return name;
}

void SkipStage(LcmMessageReader& reader) {
    reader.TakeString();
    Skip(reader, 4);
}

/// A count of what follows; -1 when it cannot be.
int TakeCount(LcmMessageReader& reader, int most) {
    const auto count = reader.Take<std::int32_t>();
    return reader.ok() && count >= 0 && count <= most ? count : -1;
}

}  // namespace

hal::Result<std::vector<std::string>> ParseCameraNames(std::span<const std::uint8_t> message) {
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __hitchview_health_t_get_hash())
        return hal::Error::kCorrupted;
    SkipToCameras(reader);
    const int cameras = TakeCount(reader, kMostCameras);
    std::vector<std::string> names;
    for (int i = 0; i < cameras; ++i) names.push_back(TakeCamera(reader));
    const int stages = TakeCount(reader, kMostStages);
    for (int i = 0; i < stages; ++i) SkipStage(reader);
    if (cameras < 0 || stages < 0 || !reader.at_end() || !std::ranges::all_of(names, IsName))
        return hal::Error::kCorrupted;
    return names;
}

}  // namespace hitchview::drivers

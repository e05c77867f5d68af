#include "drivers/lcm_logged_overlay.hpp"

#include <bit>

#include "drivers/lcm_message_bounds.hpp"
#include "drivers/lcm_message_reader.hpp"
#include "lcmtypes/hitchview_overlay_t.h"

namespace hitchview::drivers {
namespace {

using hal::Error;
using hal::Instant;
using hal::Result;

constexpr int kLongestSide_px = 16384;

bool IsIn(int value, int lowest, int highest) {
    return value >= lowest && value <= highest;
}

/// Nothing unless all of them are in the message: a count is worth no memory.
bool TakeFloats(LcmMessageReader& reader, int count, std::vector<float>& values) {
    LcmMessageReader bytes(reader.TakeBytes(std::int64_t{4} * count));
    if (!reader.ok()) return false;
    values.resize(static_cast<std::size_t>(count));
    for (float& value : values) value = std::bit_cast<float>(bytes.Take<std::uint32_t>());
    return true;
}

bool TakeMesh(LcmMessageReader& reader, LoggedOverlay& overlay) {
    overlay.mesh_rows = reader.Take<std::int32_t>();
    overlay.mesh_columns = reader.Take<std::int32_t>();
    const auto vertices = reader.Take<std::int32_t>();
    return IsIn(overlay.mesh_rows, 0, kMostOverlayRows) &&
           IsIn(overlay.mesh_columns, 0, kMostOverlayRows) &&
           vertices == 2 * overlay.mesh_rows * overlay.mesh_columns &&
           TakeFloats(reader, vertices, overlay.mesh_x_px) &&
           TakeFloats(reader, vertices, overlay.mesh_y_px);
}

bool TakeSeams(LcmMessageReader& reader, LoggedOverlay& overlay) {
    const auto rows = reader.Take<std::int32_t>();
    return IsIn(rows, 0, kMostSeamRows) && TakeFloats(reader, rows, overlay.seam_y_px) &&
           TakeFloats(reader, rows, overlay.left_seam_x_px) &&
           TakeFloats(reader, rows, overlay.right_seam_x_px);
}

}  // namespace

Result<LoggedOverlay> ParseLoggedOverlay(std::span<const std::uint8_t> message) {
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __hitchview_overlay_t_get_hash()) return Error::kCorrupted;
    LoggedOverlay overlay;
    overlay.sequence = reader.Take<std::uint32_t>();
    overlay.utime_us = reader.Take<std::int64_t>();
    overlay.captured_at = Instant(reader.Take<std::int64_t>());
    overlay.width_px = reader.Take<std::int32_t>();
    overlay.height_px = reader.Take<std::int32_t>();
    const bool sound = TakeMesh(reader, overlay) && TakeSeams(reader, overlay) && reader.at_end() &&
                       IsIn(overlay.width_px, 1, kLongestSide_px) &&
                       IsIn(overlay.height_px, 1, kLongestSide_px) && IsEpoch(overlay.utime_us) &&
                       IsInstant(overlay.captured_at);
    if (!sound) return Error::kCorrupted;
    return overlay;
}

}  // namespace hitchview::drivers

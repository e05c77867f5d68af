#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "app/protobuf_bytes.hpp"

namespace hitchview::app {

/// foxglove.CompressedImage as players know it: its definition for an MCAP schema of encoding
/// `protobuf` (a FileDescriptorSet), and one message. `format`: jpeg or png.
ProtobufBytes CompressedImageDefinition();
ProtobufBytes CompressedImageMessage(std::int64_t utime_us, const std::string& frame_id,
                                     std::span<const std::uint8_t> data, const std::string& format);

/// JSON schemas.
extern const char* const kLogSchema;         ///< foxglove.Log
extern const char* const kStatusSchema;      ///< hitchview.PanoramaStatus
extern const char* const kHitchAngleSchema;  ///< hitchview.HitchAngle
extern const char* const kCanFrameSchema;    ///< hitchview.CanFrame

}  // namespace hitchview::app

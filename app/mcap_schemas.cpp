#include "app/mcap_schemas.hpp"

namespace hitchview::app {
namespace {

// Numbers of fields and types in google/protobuf/descriptor.proto.
enum Type : std::uint8_t { kInt64 = 3, kInt32 = 5, kString = 9, kMessage = 11, kBytes = 12 };

ProtobufBytes Field(const char* name, int number, Type type, const char* type_name = nullptr) {
    constexpr int kOptional = 1;
    ProtobufBytes field;
    field.Text(1, name).Integer(3, static_cast<std::uint64_t>(number)).Integer(4, kOptional);
    field.Integer(5, type);
    if (type_name != nullptr) field.Text(6, type_name);
    return field;
}

ProtobufBytes TimestampFile() {
    ProtobufBytes message;
    message.Text(1, "Timestamp").Message(2, Field("seconds", 1, kInt64));
    message.Message(2, Field("nanos", 2, kInt32));
    ProtobufBytes file;
    file.Text(1, "google/protobuf/timestamp.proto").Text(2, "google.protobuf");
    return file.Message(4, message).Text(12, "proto3");
}

ProtobufBytes CompressedImageFile() {
    ProtobufBytes message;
    message.Text(1, "CompressedImage");
    message.Message(2, Field("timestamp", 1, kMessage, ".google.protobuf.Timestamp"));
    message.Message(2, Field("frame_id", 4, kString)).Message(2, Field("data", 2, kBytes));
    message.Message(2, Field("format", 3, kString));
    ProtobufBytes file;
    file.Text(1, "foxglove/CompressedImage.proto").Text(2, "foxglove");
    file.Text(3, "google/protobuf/timestamp.proto");
    return file.Message(4, message).Text(12, "proto3");
}

}  // namespace

ProtobufBytes CompressedImageDefinition() {
    ProtobufBytes set;
    return set.Message(1, TimestampFile()).Message(1, CompressedImageFile());
}

ProtobufBytes CompressedImageMessage(std::int64_t utime_us, const std::string& frame_id,
                                     std::span<const std::uint8_t> data,
                                     const std::string& format) {
    constexpr std::int64_t kMicroseconds = 1'000'000;
    ProtobufBytes timestamp;
    timestamp.Integer(1, static_cast<std::uint64_t>(utime_us / kMicroseconds));
    timestamp.Integer(2, static_cast<std::uint64_t>(utime_us % kMicroseconds * 1000));
    ProtobufBytes message;
    message.Message(1, timestamp).Bytes(2, data).Text(3, format).Text(4, frame_id);
    return message;
}

const char* const kLogSchema = R"({"title": "foxglove.Log", "type": "object", "properties": {
  "timestamp": {"type": "object", "title": "time", "properties": {
    "sec": {"type": "integer", "minimum": 0}, "nsec": {"type": "integer", "minimum": 0, "maximum": 999999999}}},
  "level": {"title": "foxglove.LogLevel", "oneOf": [
    {"title": "UNKNOWN", "const": 0}, {"title": "DEBUG", "const": 1}, {"title": "INFO", "const": 2},
    {"title": "WARNING", "const": 3}, {"title": "ERROR", "const": 4}, {"title": "FATAL", "const": 5}]},
  "message": {"type": "string"}, "name": {"type": "string"}, "file": {"type": "string"},
  "line": {"type": "integer", "minimum": 0}}})";

const char* const kStatusSchema =
    R"({"title": "hitchview.PanoramaStatus", "type": "object", "properties": {
  "sequence": {"type": "integer"}, "capture_ns": {"type": "integer"}, "latency_ms": {"type": "number"},
  "cameras_missing": {"type": "integer"},
  "seam_left": {"type": "string"}, "seam_right": {"type": "string"},
  "seam_matches_left": {"type": "integer"}, "seam_matches_right": {"type": "integer"},
  "features_tractor": {"type": "integer"}, "features_trailer": {"type": "integer"},
  "total_ms": {"type": "number"}, "deadline_misses": {"type": "integer"}, "dropped": {"type": "integer"},
  "articulation_deg": {"type": "number"}, "articulation_sigma_deg": {"type": "number"}}})";

const char* const kHitchAngleSchema =
    R"({"title": "hitchview.HitchAngle", "type": "object", "properties": {
  "sequence": {"type": "integer"}, "quality": {"type": "integer"}, "angle_deg": {"type": "number"}}})";

const char* const kCanFrameSchema =
    R"({"title": "hitchview.CanFrame", "type": "object", "properties": {
  "bus": {"type": "string"}, "id": {"type": "integer"}, "extended": {"type": "boolean"},
  "kind": {"type": "string"}, "fd": {"type": "boolean"}, "size": {"type": "integer"},
  "data": {"type": "string"}}})";

}  // namespace hitchview::app

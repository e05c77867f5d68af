#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "app/log_export.hpp"
#include "app/log_picture.hpp"
#include "app/log_time.hpp"
#include "app/mcap_file.hpp"
#include "app/mcap_schemas.hpp"

namespace hitchview::app {
namespace {

using drivers::LcmLogEvent;
using drivers::LoggedKind;
using hal::Checked;
using hal::Done;
using nlohmann::json;

std::span<const std::uint8_t> BytesOf(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

json Degrees(double rad) {
    return std::isfinite(rad) ? json(rad * 180 / std::numbers::pi) : json();
}

/// What became of a message: its number, and its content as the schema wants it.
struct Converted {
    std::uint32_t sequence = 0;
    json content;
};

std::optional<Converted> Status(std::span<const std::uint8_t> message) {
    const auto logged = drivers::ParseLoggedStatus(message);
    if (!logged) return std::nullopt;
    const hal::PanoramaStatus& s = logged.value().status;
    return Converted{s.sequence,
                     {{"sequence", s.sequence},
                      {"capture_ns", s.captured_from.count()},
                      {"latency_ms", Milliseconds(s.published_at - s.captured_from)},
                      {"spread_ms", Milliseconds(s.spread)},
                      {"cameras_missing", s.cameras_missing},
                      {"seam_left", ToString(s.seams[0])},
                      {"seam_right", ToString(s.seams[1])},
                      {"seam_matches_left", s.seam_matches[0]},
                      {"seam_matches_right", s.seam_matches[1]},
                      {"features_tractor", s.unit_features[0]},
                      {"features_trailer", s.unit_features[1]},
                      {"total_ms", s.total_ms},
                      {"deadline_misses", s.deadline_misses},
                      {"dropped", s.dropped},
                      {"articulation_deg", Degrees(s.articulation_rad)},
                      {"articulation_sigma_deg", Degrees(s.articulation_sigma_rad)}}};
}

std::optional<Converted> HitchAngle(std::span<const std::uint8_t> message) {
    const auto logged = drivers::ParseLoggedHitchAngle(message);
    if (!logged) return std::nullopt;
    const hal::HitchAngle& angle = logged.value().angle;
    const bool valid = angle.quality == hal::HitchAngleQuality::kValid;
    return Converted{logged.value().sequence,
                     {{"sequence", logged.value().sequence},
                      {"quality", static_cast<int>(angle.quality)},
                      {"angle_deg", valid ? Degrees(angle.angle_rad) : json()}}};
}

/// What is not known is left out: players do not take null for a number.
void RemoveUnknown(json& object) {
    std::erase_if(object.get_ref<json::object_t&>(),
                  [](const auto& member) { return member.second.is_null(); });
}

std::string Hex(std::span<const std::uint8_t> bytes) {
    std::string text;
    for (const std::uint8_t byte : bytes) {
        text += "0123456789ABCDEF"[byte >> 4];
        text += "0123456789ABCDEF"[byte & 15];
    }
    return text;
}

std::optional<Converted> CanFrame(std::span<const std::uint8_t> message) {
    constexpr std::array<const char*, 3> kKinds{"data", "remote", "error"};
    const auto logged = drivers::ParseLoggedCanFrame(message);
    if (!logged) return std::nullopt;
    const hal::CanFrame& frame = logged.value().frame;
    const bool remote = frame.kind == hal::CanFrameKind::kRemote;
    const auto data = std::span(frame.data).first(remote ? 0U : frame.size_bytes);
    return Converted{0,
                     {{"bus", logged.value().bus},
                      {"id", frame.id},
                      {"extended", frame.extended},
                      {"kind", kKinds.at(static_cast<std::size_t>(frame.kind))},
                      {"fd", frame.fd},
                      {"size", frame.size_bytes},
                      {"data", Hex(data)}}};
}

std::optional<Converted> LogEntry(std::span<const std::uint8_t> message) {
    constexpr std::int64_t kMicroseconds = 1'000'000;
    constexpr int kInfo = 2;
    const auto logged = drivers::ParseLoggedEvent(message);
    if (!logged) return std::nullopt;
    const drivers::LoggedEvent& event = logged.value();
    return Converted{event.sequence,
                     {{"timestamp",
                       {{"sec", event.utime_us / kMicroseconds},
                        {"nsec", event.utime_us % kMicroseconds * 1000}}},
                      {"level", kInfo},
                      {"name", event.subject},
                      {"message", event.text},
                      {"file", ""},
                      {"line", event.code}}};
}

/// How messages of a kind become JSON.
struct JsonKind {
    LoggedKind kind;
    const char* schema_name;
    const char* schema;
    std::optional<Converted> (*convert)(std::span<const std::uint8_t> message);
};

const std::array<JsonKind, 4> kJsonKinds{{
    {LoggedKind::kStatus, "hitchview.PanoramaStatus", kStatusSchema, Status},
    {LoggedKind::kHitchAngle, "hitchview.HitchAngle", kHitchAngleSchema, HitchAngle},
    {LoggedKind::kCanFrame, "hitchview.CanFrame", kCanFrameSchema, CanFrame},
    {LoggedKind::kEvent, "foxglove.Log", kLogSchema, LogEntry},
}};

/// The picture as a JPEG: as it is, or compressed. Empty if it is damaged.
std::vector<std::uint8_t> Jpeg(const drivers::LoggedImage& image) {
    const cv::Mat picture = PictureOf(image);
    std::vector<std::uint8_t> jpeg;
    if (!picture.empty()) cv::imencode(".jpg", picture, jpeg, {cv::IMWRITE_JPEG_QUALITY, 95});
    return jpeg;
}

bool IsJpeg(std::span<const std::uint8_t> data) {
    return data.size() > 3 && data[0] == 0xFF && data[1] == 0xD8;
}

class McapExport final : public LogExport {
 public:
    McapExport(std::string file, std::unique_ptr<McapFile> mcap, PictureChoice choice)
        : file_(std::move(file)), mcap_(std::move(mcap)), choice_(std::move(choice)) {}

    Checked<Done> Add(const LcmLogEvent& event, LoggedKind kind) override {
        if (kind == LoggedKind::kImage) return AddImage(event);
        const auto* const json_kind = std::ranges::find(kJsonKinds, kind, &JsonKind::kind);
        return json_kind == kJsonKinds.end() ? Done{} : AddJson(event, *json_kind);
    }

    Checked<Done> Finish() override { return Checking(mcap_->Finish()); }

 private:
    [[nodiscard]] Checked<Done> Checking(const hal::Result<Done>& written) const {
        if (written) return Done{};
        return file_ + ": cannot be written: " + std::strerror(errno);
    }

    Checked<Done> AddImage(const LcmLogEvent& event) {
        if (!choice_.channel.empty() && event.channel != choice_.channel) return Done{};
        const auto image = drivers::ParseLoggedImage(event.data);
        if (!image) return Damaged();
        const bool raw = !IsJpeg(image.value().data);
        const auto compressed = raw ? Jpeg(image.value()) : std::vector<std::uint8_t>();
        if (raw && compressed.empty()) return Damaged();
        const auto message =
            CompressedImageMessage(image.value().utime_us, std::string(event.channel),
                                   raw ? std::span(compressed) : image.value().data, "jpeg");
        return Append(event, ImageChannel(event), image.value().sequence.value_or(0),
                      message.bytes());
    }

    Checked<Done> AddJson(const LcmLogEvent& event, const JsonKind& kind) {
        auto converted = kind.convert(event.data);
        if (!converted) return Damaged();
        RemoveUnknown(converted->content);
        // Texts of a log may hold any bytes.
        const std::string text =
            converted->content.dump(-1, ' ', false, json::error_handler_t::replace);
        return Append(event, JsonChannel(event, kind), converted->sequence, BytesOf(text));
    }

    Checked<Done> Damaged() {
        CountDamaged();
        return Done{};
    }

    Checked<Done> Append(const LcmLogEvent& event, McapFile::Id channel, std::uint32_t sequence,
                         std::span<const std::uint8_t> message) {
        CountWritten();
        const auto time_ns = static_cast<std::uint64_t>(event.utime_us) * 1000;
        return Checking(mcap_->Append(channel, sequence, time_ns, message));
    }

    McapFile::Id ImageChannel(const LcmLogEvent& event) {
        const auto add_schema = [this] {
            return mcap_->AddSchema("foxglove.CompressedImage", "protobuf",
                                    CompressedImageDefinition().bytes());
        };
        return Channel(event, "protobuf", "foxglove.CompressedImage", add_schema);
    }

    McapFile::Id JsonChannel(const LcmLogEvent& event, const JsonKind& kind) {
        const auto add_schema = [&] {
            return mcap_->AddSchema(kind.schema_name, "jsonschema", BytesOf(kind.schema));
        };
        return Channel(event, "json", kind.schema_name, add_schema);
    }

    template <typename AddSchema>
    McapFile::Id Channel(const LcmLogEvent& event, const char* encoding, const char* schema_name,
                         const AddSchema& add_schema) {
        const auto known = channels_.find(event.channel);
        if (known != channels_.end()) return known->second;
        const auto schema = schemas_.find(schema_name);
        const McapFile::Id schema_id =
            schema != schemas_.end() ? schema->second : (schemas_[schema_name] = add_schema());
        const McapFile::Id id = mcap_->AddChannel(schema_id, event.channel, encoding);
        channels_.emplace(event.channel, id);
        return id;
    }

    std::string file_;
    std::unique_ptr<McapFile> mcap_;
    PictureChoice choice_;
    std::map<std::string, McapFile::Id, std::less<>> schemas_;
    std::map<std::string, McapFile::Id, std::less<>> channels_;
};

}  // namespace

LogExportResult ExportMcap(const std::filesystem::path& file, const PictureChoice& choice) {
    auto mcap = McapFile::Create(file.string());
    if (!mcap) return mcap.error();
    return LogExportResult(std::make_unique<McapExport>(file.string(), std::move(*mcap), choice));
}

}  // namespace hitchview::app

#include <cerrno>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "app/log_export.hpp"
#include "app/log_json.hpp"
#include "app/log_picture.hpp"
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

/// What is not known is left out: players do not take null for a number.
void RemoveUnknown(json& object) {
    std::erase_if(object.get_ref<json::object_t&>(),
                  [](const auto& member) { return member.second.is_null(); });
}

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
        const LogJsonKind* const json_kind = LogJsonKindOf(kind);
        return json_kind == nullptr ? Done{} : AddJson(event, *json_kind);
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

    Checked<Done> AddJson(const LcmLogEvent& event, const LogJsonKind& kind) {
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

    McapFile::Id JsonChannel(const LcmLogEvent& event, const LogJsonKind& kind) {
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

#include "calib/yaml_document.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/parser.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace hitchview::calib {
namespace {

constexpr std::size_t kMaxFileBytes = 1 << 20;

YamlDocument Complaint(int line, const std::string& text) {
    return {std::nullopt, line, text};
}

/// Lets a document pass by.
class Ignore final : public YAML::EventHandler {
    using Mark = YAML::Mark;
    using Text = std::string;

    void OnDocumentStart(const Mark&) override {}
    void OnDocumentEnd() override {}
    void OnNull(const Mark&, YAML::anchor_t) override {}
    void OnAlias(const Mark&, YAML::anchor_t) override {}
    void OnScalar(const Mark&, const Text&, YAML::anchor_t, const Text&) override {}
    void OnSequenceStart(const Mark&, const Text&, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {}
    void OnSequenceEnd() override {}
    void OnMapStart(const Mark&, const Text&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
    void OnMapEnd() override {}
};

/// YAML::LoadAll would say it too, but never returns on some malformed text: it finds documents
/// without end and without length.
bool HasOneDocument(const std::string& text) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    Ignore ignore;
    return parser.HandleNextDocument(ignore) && !parser.HandleNextDocument(ignore);
}

YamlDocument Parse(const std::string& text) {
    try {
        YAML::Node root = YAML::Load(text);
        if (HasOneDocument(text)) return {root, 0, ""};
        return Complaint(1, "the file does not have one document, must be one");
    } catch (const YAML::Exception& error) {
        return Complaint(std::max(error.mark.line + 1, 1),
                         "the file is not YAML (" + error.msg + "), must be YAML");
    }
}

}  // namespace

YamlDocument ReadYamlDocument(const std::filesystem::path& file) {
    std::error_code error;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file, error)) {
        return Complaint(0, "the file cannot be read, must be a readable YAML file");
    }
    std::string text(kMaxFileBytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return ParseYamlDocument(text);
}

YamlDocument ParseYamlDocument(const std::string& text) {
    if (text.size() > kMaxFileBytes) {
        return Complaint(0, "the file is too long, must be at most 1 MiB");
    }
    return Parse(text);
}

}  // namespace hitchview::calib

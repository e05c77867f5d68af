#include "calib/yaml_document.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/parser.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "calib/text.hpp"

namespace hitchview::calib {
namespace {

constexpr std::size_t kMaxFileBytes = 1 << 20;

YamlDocument Complaint(int line, const std::string& text) {
    return {std::nullopt, line, text};
}

/// Measures a document as it is once every alias stands for what it names. Throws where that would
/// not end or be larger than any file that people write.
class Survey final : public YAML::EventHandler {
    using Anchor = YAML::anchor_t;
    using Mark = YAML::Mark;
    using Style = YAML::EmitterStyle::value;
    using Text = std::string;

    static constexpr std::size_t kMostValues = kMaxFileBytes;
    static constexpr std::size_t kMostLevels = 64;

    struct Extent {
        std::size_t values = 1;
        std::size_t levels = 1;
    };
    struct Open {
        Anchor anchor;
        Extent extent{};
    };

    void OnDocumentStart(const Mark&) override {}
    void OnDocumentEnd() override {}
    void OnNull(const Mark& mark, Anchor anchor) override { Add(mark, anchor, {}); }
    void OnScalar(const Mark& mark, const Text&, Anchor anchor, const Text&) override {
        Add(mark, anchor, {});
    }
    void OnAlias(const Mark& mark, Anchor anchor) override {
        const auto known = by_anchor_.find(anchor);
        if (known == by_anchor_.end())
            throw YAML::Exception(mark, "an alias within what it stands for");
        Add(mark, YAML::NullAnchor, known->second);
    }
    void OnSequenceStart(const Mark& mark, const Text&, Anchor anchor, Style) override {
        Begin(mark, anchor);
    }
    void OnSequenceEnd() override { End(); }
    void OnMapStart(const Mark& mark, const Text&, Anchor anchor, Style) override {
        Begin(mark, anchor);
    }
    void OnMapEnd() override { End(); }

    void Begin(const Mark& mark, Anchor anchor) {
        open_.push_back({anchor});
        mark_ = mark;
        CheckLevels(0);
    }
    void End() {
        const Open done = open_.back();
        open_.pop_back();
        Add(mark_, done.anchor, done.extent);
    }
    void Add(const Mark& mark, Anchor anchor, const Extent& added) {
        mark_ = mark;
        by_anchor_[anchor] = added;
        CheckLevels(added.levels);
        if (open_.empty()) return;
        Extent& outer = open_.back().extent;
        outer.values += added.values;
        outer.levels = std::max(outer.levels, added.levels + 1);
        if (outer.values > kMostValues)
            throw YAML::Exception(mark, "more than 1048576 values, aliases followed");
    }
    void CheckLevels(std::size_t more) const {
        if (open_.size() + more > kMostLevels)
            throw YAML::Exception(mark_, "more than 64 levels, aliases followed");
    }

    std::vector<Open> open_{};
    std::map<Anchor, Extent> by_anchor_{};
    Mark mark_{};
};

/// YAML::LoadAll would say it too, but never returns on some malformed text: it finds documents
/// without end and without length.
bool HasOneDocument(const std::string& text) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    Survey survey;
    return parser.HandleNextDocument(survey) && !parser.HandleNextDocument(survey);
}

YamlDocument Parse(const std::string& text) {
    try {
        if (HasOneDocument(text)) return {YAML::Load(text), 0, ""};
        return Complaint(1, "the file does not have one document, must be one");
    } catch (const YAML::Exception& error) {
        return Complaint(std::max(error.mark.line + 1, 1),
                         "the file is not YAML (" + OneLine(error.msg) + "), must be YAML");
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

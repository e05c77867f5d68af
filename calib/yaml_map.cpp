#include "calib/yaml_map.hpp"

#include <yaml-cpp/emitter.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>

#include "calib/text.hpp"
#include "calib/yaml_document.hpp"

namespace hitchview::calib {
namespace {

constexpr std::size_t kMaxShownBytes = 60;

int LineOf(const YAML::Node& node) {
    return node.Mark().line + 1;
}

/// Text as it may stand in a message: one line, bounded.
std::string Shown(std::string text) {
    if (text.size() > kMaxShownBytes) text = text.substr(0, kMaxShownBytes) + "...";
    return OneLine(std::move(text));
}

bool IsQuoted(const YAML::Node& scalar) {
    return scalar.Tag() == "!";
}

std::string Shown(const YAML::Node& node) {
    if (node.IsMap()) return "a map";
    if (node.IsSequence()) return "a list of " + std::to_string(node.size());
    if (!node.IsScalar()) return "empty";
    return IsQuoted(node) || node.Scalar().empty() ? '"' + Shown(node.Scalar()) + '"'
                                                   : Shown(node.Scalar());
}

template <typename T>
std::string Text(T number) {
    if constexpr (std::same_as<T, double>) return ExactText(number);
    return std::to_string(number);
}

template <typename T>
std::string Text(const Range<T>& range) {
    const std::string bounds = range.min == range.max
                                   ? Text<T>(range.min)
                                   : Text<T>(range.min) + " to " + Text<T>(range.max);
    return range.even ? bounds + " and even" : bounds;
}

template <typename Names>
std::string Joined(const Names& names) {
    std::string text;
    for (const auto& name : names) text.append(text.empty() ? "" : ", ").append(name);
    return text;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::optional<std::int64_t> ParseWholeNumber(std::string_view text) {
    const bool hexadecimal = text.starts_with("0x");
    if (hexadecimal) text.remove_prefix(2);
    std::int64_t number = 0;
    const char* end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, number, hexadecimal ? 16 : 10);
    if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
    return number;
}

std::optional<double> ParseNumber(std::string_view text) {
    double number = 0;
    const char* end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, number);
    if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
    return number;
}

}  // namespace

std::string YamlComplaints::Text() const {
    std::string text;
    for (const auto& [line, complaint] : by_line_) {
        if (!text.empty()) text += '\n';
        text += file_ + (line > 0 ? ':' + std::to_string(line) : "") + ": " + complaint;
    }
    return text;
}

bool YamlValue::is_map() const {
    return node_ && node_->IsMap();
}

bool YamlValue::is_list() const {
    return node_ && node_->IsSequence();
}

void YamlValue::Refuse(const std::string& must_be) const {
    if (place_.complaints == nullptr || !node_) return;
    place_.complaints->Add(place_.line,
                           place_.path + " is " + Shown(*node_) + ", must be " + must_be);
}

void YamlValue::RefuseOrMiss(const std::string& must_be) const {
    if (node_) return Refuse(must_be);
    if (place_.complaints == nullptr || !required_) return;
    place_.complaints->Add(place_.line, place_.path + " is missing, must be " + must_be);
}

std::optional<std::string> YamlValue::Text(const std::string& must_be) const {
    if (node_ && node_->IsScalar()) return node_->Scalar();
    RefuseOrMiss(must_be);
    return std::nullopt;
}

std::optional<std::int64_t> YamlValue::WholeNumber(const Range<std::int64_t>& range) const {
    const std::string must_be = calib::Text(range);
    const auto text = Text(must_be);
    if (!text) return std::nullopt;
    const auto number = IsQuoted(*node_) ? std::nullopt : ParseWholeNumber(*text);
    if (number && *number >= range.min && *number <= range.max &&
        (!range.even || *number % 2 == 0)) {
        return number;
    }
    Refuse(number ? must_be : "a whole number, " + must_be);
    return std::nullopt;
}

void YamlValue::Read(const Range<double>& range, double& out) const {
    const std::string must_be = calib::Text(range);
    const auto text = Text(must_be);
    if (!text) return;
    const auto number = IsQuoted(*node_) ? std::nullopt : ParseNumber(*text);
    if (number && *number >= range.min && *number <= range.max) {
        out = *number;
    } else {
        Refuse(number ? must_be : "a number, " + must_be);
    }
}

void YamlValue::Read(bool& out) const {
    const auto index = Index({"false", "true"});
    if (index) out = *index == 1;
}

void YamlValue::Read(std::string& out) const {
    const auto text = Text("text");
    if (!text) return;
    if (text->empty()) return Refuse("text");
    out = *text;
}

std::optional<std::size_t> YamlValue::Index(const std::vector<std::string_view>& names) const {
    const std::string must_be = (names.size() > 1 ? "one of " : "") + Joined(names);
    const auto text = Text(must_be);
    if (!text) return std::nullopt;
    const auto found = std::find(names.begin(), names.end(), *text);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    Refuse(must_be);
    return std::nullopt;
}

YamlMap YamlValue::Map() const {
    if (node_ && node_->IsMap()) return {node_, place_};
    RefuseOrMiss("a map");
    const bool complained = node_ || required_;
    return {std::nullopt,
            YamlPlace{place_.line, place_.path, complained ? nullptr : place_.complaints}};
}

std::vector<YamlValue> YamlValue::List(const Range<std::size_t>& length) const {
    if (!node_ || !node_->IsSequence() || node_->size() < length.min ||
        node_->size() > length.max) {
        RefuseOrMiss("a list of " + calib::Text(length));
        return {};
    }
    std::vector<YamlValue> items;
    for (const YAML::Node& item : *node_) {
        const std::string path = place_.path + '[' + std::to_string(items.size()) + ']';
        items.emplace_back(item, true, YamlPlace{LineOf(item), path, place_.complaints});
    }
    return items;
}

YamlMap::YamlMap(const std::optional<YAML::Node>& map, YamlPlace place) : place_(std::move(place)) {
    if (!map || !map->IsMap()) return;
    for (const auto& item : *map) {
        const YAML::Node& key = item.first;
        const std::string name = key.IsScalar() ? key.Scalar() : Shown(key);
        if (entries_.try_emplace(name, Entry{LineOf(key), item.second}).second) {
            keys_.push_back(name);
        } else if (place_.complaints != nullptr) {
            place_.complaints->Add(LineOf(key),
                                   PlaceOf(name).path + " is given twice, must be given once");
        }
    }
}

YamlPlace YamlMap::PlaceOf(const std::string& key) const {
    const auto entry = entries_.find(key);
    const int line = entry == entries_.end() ? place_.line : entry->second.line;
    const std::string shown = Shown(key);
    return {line, place_.path.empty() ? shown : place_.path + '.' + shown, place_.complaints};
}

YamlValue YamlMap::Value(std::string_view key, bool required) {
    const std::string name(key);
    if (!Contains(asked_for_, name)) asked_for_.push_back(name);
    const auto entry = entries_.find(name);
    if (entry == entries_.end()) return {std::nullopt, required, PlaceOf(name)};
    return {entry->second.value, required, PlaceOf(name)};
}

void YamlMap::Finish() const {
    if (place_.complaints == nullptr) return;
    for (const std::string& key : keys_) {
        if (Contains(asked_for_, key)) continue;
        const YamlPlace place = PlaceOf(key);
        place_.complaints->Add(place.line,
                               place.path + " is no key, must be one of " + Joined(asked_for_));
    }
}

namespace {

YamlMap RootOf(const YamlDocument& document, YamlComplaints& complaints) {
    if (!document.root) {
        complaints.Add(document.line, document.complaint);
    } else if (!document.root->IsMap()) {
        complaints.Add(1, "the file is " + Shown(*document.root) + ", must be a map");
    }
    return {document.root, YamlPlace{1, "", complaints.empty() ? &complaints : nullptr}};
}

}  // namespace

YamlMap LoadYaml(const std::filesystem::path& file, YamlComplaints& complaints) {
    return RootOf(ReadYamlDocument(file), complaints);
}

YamlMap ParseYaml(const std::string& text, YamlComplaints& complaints) {
    return RootOf(ParseYamlDocument(text), complaints);
}

std::string Quoted(const std::string& text) {
    YAML::Emitter emitter;
    emitter << YAML::DoubleQuoted << text;
    return emitter.c_str();
}

std::string ExactText(double number) {
    std::array<char, 32> text{};
    const auto written = std::to_chars(text.data(), text.data() + text.size(), number);
    return {text.data(), written.ptr};
}

std::string ExactText(std::initializer_list<double> numbers) {
    std::string text;
    for (const double number : numbers) {
        text.append(text.empty() ? "[" : ", ").append(ExactText(number));
    }
    return text + "]";
}

}  // namespace hitchview::calib

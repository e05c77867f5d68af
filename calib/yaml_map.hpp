#pragma once

#include <yaml-cpp/node/node.h>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Strict reading of YAML files that people write: each key that is unknown, given twice, missing,
/// of the wrong type or out of range becomes one line `file:line: key.path is VALUE, must be ...`.
/// Reading goes on after a complaint, so that one run names everything that is wrong.
/// Nothing here throws. Thread: any, one at a time.
namespace hitchview::calib {

/// Inclusive bounds of a number.
template <typename T>
struct Range {
    T min;
    T max;
    bool even = false;
};

/// One of the words that a key may have.
template <typename E>
struct Choice {
    std::string_view name;
    E value;
};

/// Everything that is wrong with one file.
class YamlComplaints {
 public:
    explicit YamlComplaints(std::string file) : file_(std::move(file)) {}

    void Add(int line, const std::string& text) { by_line_.emplace(line, text); }
    [[nodiscard]] bool empty() const { return by_line_.empty(); }
    /// One line each, in the order of the file, without a trailing newline.
    [[nodiscard]] std::string Text() const;

 private:
    std::string file_;
    std::multimap<int, std::string> by_line_;
};

/// Where a value stands. `complaints` is null below a value that has been complained about.
struct YamlPlace {
    int line = 1;
    std::string path;
    YamlComplaints* complaints = nullptr;
};

class YamlMap;

/// The value of one key, given or not. A Read that cannot leaves `out` alone and complains; absence
/// is complained about only where the value is required. Borrows the complaints.
class YamlValue {
 public:
    YamlValue(std::optional<YAML::Node> node, bool required, YamlPlace place)
        : node_(std::move(node)), required_(required), place_(std::move(place)) {}
    // Assigning a YAML::Node would write into the document.
    YamlValue& operator=(const YamlValue&) = delete;
    YamlValue(const YamlValue&) = default;

    [[nodiscard]] bool given() const { return node_.has_value(); }
    [[nodiscard]] bool is_map() const;
    [[nodiscard]] bool is_list() const;

    /// Whole numbers are decimal, or hexadecimal after 0x.
    template <std::integral T>
    void Read(const Range<T>& range, T& out) const {
        const auto number = WholeNumber({range.min, range.max, range.even});
        if (number) out = static_cast<T>(*number);
    }
    void Read(const Range<double>& range, double& out) const;
    void Read(bool& out) const;
    /// Any text but none.
    void Read(std::string& out) const;
    template <typename E, std::size_t kCount>
    void Read(const std::array<Choice<E>, kCount>& choices, E& out) const;
    template <typename T, std::size_t kCount>
    void Read(const Range<T>& range, std::array<T, kCount>& out) const;

    /// Empty where the value is no map.
    [[nodiscard]] YamlMap Map() const;
    /// Empty where the value is no list or its length lies outside `length`.
    [[nodiscard]] std::vector<YamlValue> List(const Range<std::size_t>& length) const;

    /// Complains about a value that was read and that does not fit the rest of the file.
    void Refuse(const std::string& must_be) const;
    /// The same, or where it is required and not given, about that.
    void RefuseOrMiss(const std::string& must_be) const;

 private:
    /// The text of a scalar; complains where there is none.
    [[nodiscard]] std::optional<std::string> Text(const std::string& must_be) const;
    [[nodiscard]] std::optional<std::int64_t> WholeNumber(const Range<std::int64_t>& range) const;
    [[nodiscard]] std::optional<std::size_t> Index(
        const std::vector<std::string_view>& names) const;

    std::optional<YAML::Node> node_;
    bool required_;
    YamlPlace place_;
};

/// A map whose keys are all asked for before Finish.
class YamlMap {
 public:
    YamlMap(const std::optional<YAML::Node>& map, YamlPlace place);

    YamlValue operator[](std::string_view key) { return Value(key, false); }
    YamlValue Required(std::string_view key) { return Value(key, true); }
    /// In the order of the file.
    [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }

    /// Complains about the keys that nobody asked for.
    void Finish() const;

 private:
    struct Entry {
        int line;
        YAML::Node value;
    };

    YamlValue Value(std::string_view key, bool required);
    [[nodiscard]] YamlPlace PlaceOf(const std::string& key) const;

    YamlPlace place_;
    std::vector<std::string> keys_;
    std::map<std::string, Entry> entries_;
    std::vector<std::string> asked_for_;
};

/// The root of the one document in `file` (at most 1 MiB); what is wrong goes into `complaints`.
YamlMap LoadYaml(const std::filesystem::path& file, YamlComplaints& complaints);
/// The same of a file's content.
YamlMap ParseYaml(const std::string& text, YamlComplaints& complaints);

/// Shortest text that reads back as exactly `number`.
std::string ExactText(double number);
/// The same for a list: `[1, 2]`.
std::string ExactText(std::initializer_list<double> numbers);

/// A scalar in double quotes that reads back as exactly `text`.
std::string Quoted(const std::string& text);

template <typename E, std::size_t kCount>
void YamlValue::Read(const std::array<Choice<E>, kCount>& choices, E& out) const {
    std::vector<std::string_view> names;
    names.reserve(kCount);
    for (const auto& choice : choices) names.push_back(choice.name);
    if (const auto index = Index(names)) out = choices[*index].value;
}

template <typename T, std::size_t kCount>
void YamlValue::Read(const Range<T>& range, std::array<T, kCount>& out) const {
    const auto items = List({kCount, kCount});
    for (std::size_t i = 0; i < items.size(); ++i) items[i].Read(range, out[i]);
}

}  // namespace hitchview::calib

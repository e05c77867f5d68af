#include "calib/format_document.hpp"

#include <algorithm>
#include <fstream>

namespace hitchview::calib {
namespace {

constexpr std::size_t kMaxFileBytes = 16 << 20;
constexpr std::string_view kBlank = " \t\r\n";

std::optional<std::string> FileText(const std::filesystem::path& file) {
    std::error_code error;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || !std::filesystem::is_regular_file(file, error)) return std::nullopt;
    std::string text(
        std::min<std::uintmax_t>(std::filesystem::file_size(file, error) + 1, kMaxFileBytes + 1),
        '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text;
}

std::string NewLines(std::string_view text) {
    return std::string(static_cast<std::size_t>(std::ranges::count(text, '\n')), '\n');
}

bool IsNumber(std::string_view word) {
    return word.find_first_not_of("0123456789+-.eE") == word.npos;
}

std::string Quoted(std::string_view word) {
    std::string text = "'";
    for (const char c : word) text.append(c == '\'' ? 2 : 1, c);
    return text + "'";
}

/// One value, or several as a list; each on its line.
std::string Values(std::string_view text) {
    std::string values;
    int count = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of(kBlank, at), text.size());
        std::string_view word = text.substr(at, end - at);
        if (word.empty()) {
            if (text[at] == '\n') values += '\n';
            ++at;
            continue;
        }
        at = end;
        if (word.size() > 1 && word.front() == '"' && word.back() == '"')
            word = word.substr(1, word.size() - 2);
        if (count++ > 0) values += ", ";
        values += IsNumber(word) ? std::string(word) : Quoted(word);
    }
    if (count == 0) return values + "''";
    return count == 1 ? values : "[" + values + "]";
}

/// Turns elements into flow collections of YAML.
class XmlReader {
 public:
    explicit XmlReader(std::string_view xml) : rest_(xml) {}

    std::optional<std::string> Read() {
        while (!rest_.empty()) {
            if (rest_.front() == '<') {
                if (!Tag()) return std::nullopt;
            } else {
                Pass(std::min(rest_.find('<'), rest_.size()));
            }
        }
        if (!open_.empty() || !seen_root_) return std::nullopt;
        return yaml_;
    }

 private:
    struct Element {
        std::string name;
        char closer;
    };

    /// Leaves out what has no meaning, but not its lines.
    void Pass(std::size_t length) {
        yaml_ += NewLines(rest_.substr(0, length));
        rest_.remove_prefix(length);
    }

    bool Tag() {
        const bool comment = rest_.starts_with("<!--");
        const std::size_t end = rest_.find(comment ? "-->" : ">");
        if (end == rest_.npos) return false;
        const std::string_view tag = rest_.substr(1, end - 1);
        if (comment || tag.starts_with('?') || tag.starts_with('!')) {
            Pass(end + 1);
            return true;
        }
        Pass(end + 1);
        return tag.starts_with('/') ? Close(tag.substr(1)) : Open(tag);
    }

    bool Open(std::string_view tag) {
        const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
        if (name.empty()) return false;
        const bool root = open_.empty();
        if (root && (seen_root_ || name != "opencv_storage")) return false;
        seen_root_ = true;
        if (!root && open_.back().closer == '}') yaml_ += Quoted(name) + ": ";
        if (tag.ends_with('/')) {
            yaml_ += root ? "{}" : "'', ";
            return true;
        }
        return Leaf(name) || Branch(name);
    }

    /// An element without others in it.
    bool Leaf(std::string_view name) {
        const std::size_t end = rest_.find('<');
        if (open_.empty() || end == rest_.npos || !rest_.substr(end).starts_with("</"))
            return false;
        if (!rest_.substr(end + 2).starts_with(name)) return false;
        yaml_ += Values(rest_.substr(0, end));
        rest_.remove_prefix(end);
        open_.push_back({std::string(name), ' '});
        return true;
    }

    bool Branch(std::string_view name) {
        const std::size_t next = std::min(rest_.find('<'), rest_.size());
        const bool list =
            rest_.substr(next).starts_with("<_>") || rest_.substr(next).starts_with("<_ ");
        yaml_ += list ? '[' : '{';
        open_.push_back({std::string(name), list ? ']' : '}'});
        return true;
    }

    bool Close(std::string_view name) {
        if (open_.empty() || open_.back().name != name.substr(0, name.find_first_of(kBlank)))
            return false;
        yaml_ += open_.back().closer;
        open_.pop_back();
        if (!open_.empty()) yaml_ += ", ";
        return true;
    }

    std::string_view rest_;
    std::string yaml_{};
    std::vector<Element> open_{};
    bool seen_root_ = false;
};

/// YAML of the file's text; empty with a complaint.
std::optional<std::string> AsYaml(Format format, std::string text, YamlComplaints& complaints) {
    if (format == Format::kMrcal) return PythonAsYaml(text);
    const std::size_t start = text.find_first_not_of(kBlank);
    if (start == text.npos || text[start] != '<') return text;
    auto yaml = XmlAsYaml(text);
    if (!yaml) complaints.Add(0, "the file is not XML of OpenCV, must be a whole <opencv_storage>");
    return yaml;
}

}  // namespace

std::optional<std::string> XmlAsYaml(const std::string& xml) {
    return XmlReader(xml).Read();
}

std::string PythonAsYaml(const std::string& python) {
    std::string yaml;
    std::size_t from = 0;
    for (;;) {
        const std::size_t bytes = python.find(" b'", from);
        const std::size_t end = bytes == python.npos ? python.npos : python.find('\'', bytes + 3);
        if (end == python.npos) return yaml + python.substr(from);
        yaml += python.substr(from, bytes - from) + " ''";
        yaml += NewLines(std::string_view(python).substr(bytes, end - bytes));
        from = end + 1;
    }
}

YamlMap LoadForeign(Format format, const std::filesystem::path& file, YamlComplaints& complaints) {
    const auto text = FileText(file);
    if (text) return ParseForeign(format, *text, complaints);
    complaints.Add(0, "the file cannot be read, must be a readable file");
    return {std::nullopt, YamlPlace{}};
}

YamlMap ParseForeign(Format format, const std::string& text, YamlComplaints& complaints) {
    if (text.size() > kMaxFileBytes) {
        complaints.Add(0, "the file is too long, must be at most 16 MiB");
    } else if (const auto yaml = AsYaml(format, text, complaints)) {
        return ParseYaml(*yaml, complaints);
    }
    return {std::nullopt, YamlPlace{}};
}

}  // namespace hitchview::calib

#include "drivers/replay_image_list.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace hitchview::drivers {
namespace {

namespace fs = std::filesystem;

bool IsDigit(char c) {
    return c >= '0' && c <= '9';
}

bool IsPicture(const fs::path& path) {
    constexpr std::array<std::string_view, 9> kExtensions{".jpg",  ".jpeg", ".png", ".bmp", ".tif",
                                                          ".tiff", ".webp", ".ppm", ".pgm"};
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::ranges::find(kExtensions, extension) != kExtensions.end();
}

// Takes the digits or the single other character that `text` begins with.
std::string_view TakePart(std::string_view& text) {
    const auto end = std::ranges::find_if_not(text, IsDigit);
    const auto length = std::max<std::size_t>(1, static_cast<std::size_t>(end - text.begin()));
    const std::string_view part = text.substr(0, length);
    text.remove_prefix(length);
    return part;
}

std::string_view WithoutZeros(std::string_view digits) {
    return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

// Numbers by their value, everything else by its bytes. Below 0: a comes first.
int NaturalOrder(std::string_view a, std::string_view b) {
    while (!a.empty() && !b.empty()) {
        const std::string_view part_a = TakePart(a);
        const std::string_view part_b = TakePart(b);
        if (IsDigit(part_a.front()) && IsDigit(part_b.front())) {
            const std::string_view value_a = WithoutZeros(part_a);
            const std::string_view value_b = WithoutZeros(part_b);
            if (value_a.size() != value_b.size()) return value_a.size() < value_b.size() ? -1 : 1;
            if (value_a != value_b) return value_a.compare(value_b);
        } else if (part_a != part_b) {
            return part_a.compare(part_b);
        }
    }
    return static_cast<int>(b.empty()) - static_cast<int>(a.empty());
}

// However the folder lists them: 01.png and 1.png are the same number.
bool NaturallyBefore(const std::string& a, const std::string& b) {
    const int order = NaturalOrder(a, b);
    return order < 0 || (order == 0 && a < b);
}

// A file's name before and after the number, and how many digits the number has at least.
struct Pattern {
    std::string before;
    std::string after;
    std::size_t digits = 1;
};

// One `%d` or `%0Nd` with N from 1 to 9, and no other percent sign.
std::optional<Pattern> ParsePattern(const std::string& text) {
    const std::string name = fs::path(text).filename().string();
    const std::size_t percent = name.find('%');
    if (percent == std::string::npos || percent != name.rfind('%')) return std::nullopt;
    Pattern pattern{.before = name.substr(0, percent), .after = {}};
    std::string_view number = std::string_view(name).substr(percent + 1);
    if (number.size() > 2 && number[0] == '0' && number[1] != '0' && IsDigit(number[1])) {
        pattern.digits = static_cast<std::size_t>(number[1] - '0');
        number.remove_prefix(2);
    }
    if (!number.starts_with('d')) return std::nullopt;
    pattern.after = number.substr(1);
    return pattern;
}

// The number in a file's name, if the pattern would print it like that.
std::optional<unsigned> NumberIn(std::string_view name, const Pattern& pattern) {
    if (!name.starts_with(pattern.before) || !name.ends_with(pattern.after)) return std::nullopt;
    if (name.size() <= pattern.before.size() + pattern.after.size()) return std::nullopt;
    name.remove_prefix(pattern.before.size());
    name.remove_suffix(pattern.after.size());
    const bool padded = name.size() > 1 && name.front() == '0';
    if (name.size() < pattern.digits || (padded && name.size() > pattern.digits)) {
        return std::nullopt;
    }
    unsigned number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error != std::errc{} || end != name.data() + name.size()) return std::nullopt;
    return number;
}

std::map<unsigned, std::string> FindNumbered(const std::vector<std::string>& paths,
                                             const Pattern& pattern) {
    std::map<unsigned, std::string> found;
    for (const std::string& path : paths) {
        const auto maybe_number = NumberIn(fs::path(path).filename().string(), pattern);
        if (maybe_number) found.emplace(*maybe_number, path);
    }
    return found;
}

std::vector<std::string> PathsIn(const fs::path& folder, std::error_code& error) {
    std::vector<std::string> paths;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error))
        paths.push_back(entry->path().string());
    return paths;
}

}  // namespace

hal::Checked<std::vector<std::string>> ListPattern(const std::string& text) {
    std::error_code absent;
    const fs::path folder = fs::path(text).parent_path();
    return PickPattern(text, PathsIn(folder.empty() ? fs::path(".") : folder, absent));
}

hal::Checked<std::vector<std::string>> PickPattern(const std::string& text,
                                                   const std::vector<std::string>& all) {
    const std::optional<Pattern> maybe_pattern = ParsePattern(text);
    if (!maybe_pattern) {
        return text + ": the file name must have one number, written %d or %01d to %09d";
    }
    const std::map<unsigned, std::string> found = FindNumbered(all, *maybe_pattern);
    if (found.empty()) return text + ": no such files";
    if (found.begin()->first > 1) {
        return text + ": the first number is " + std::to_string(found.begin()->first) +
               ", must be 0 or 1";
    }
    std::vector<std::string> paths;
    unsigned expected = found.begin()->first;
    for (const auto& [number, path] : found) {
        if (number != expected) {
            return text + ": number " + std::to_string(expected) + " is missing, " +
                   std::to_string(number) + " is there";
        }
        paths.push_back(path);
        ++expected;
    }
    return paths;
}

hal::Checked<std::vector<std::string>> ListFolder(const std::string& folder) {
    std::error_code error;
    std::vector<std::string> paths = PathsIn(folder, error);
    if (error) return folder + ": " + error.message();
    return PickPictures(folder, std::move(paths));
}

hal::Checked<std::vector<std::string>> PickPictures(const std::string& folder,
                                                    std::vector<std::string> paths) {
    std::erase_if(paths, [](const std::string& path) { return !IsPicture(path); });
    if (paths.empty()) return folder + ": no pictures in this folder";
    std::ranges::sort(paths, NaturallyBefore);
    return paths;
}

}  // namespace hitchview::drivers

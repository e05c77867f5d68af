#include <algorithm>
#include <charconv>
#include <set>
#include <string>
#include <vector>

#include "drivers/replay_image_list.hpp"
#include "hal/expect.hpp"
#include "tests/fuzz/fuzz_bytes.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace hitchview;
using Paths = std::vector<std::string>;

Paths LinesOf(std::string_view text) {
    Paths lines;
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        lines.emplace_back(line);
    }
    return lines;
}

void ExpectSome(const Paths& chosen, const Paths& paths) {
    HV_EXPECT(!chosen.empty());
    for (const std::string& path : chosen) HV_EXPECT(std::ranges::find(paths, path) != paths.end());
}

std::string NameOf(const std::string& path) {
    return path.substr(path.rfind('/') + 1);
}

/// What stands in a path where the pattern has its number.
unsigned NumberOf(const std::string& path, const std::string& pattern) {
    const std::string name = NameOf(path);
    const std::string form = NameOf(pattern);
    const std::size_t before = form.find('%');
    const std::size_t after = form.size() - 1 - form.find('d', before);
    unsigned number = 0;
    std::from_chars(name.data() + before, name.data() + name.size() - after, number);
    return number;
}

/// In order, from 0 or 1, without a gap.
void PickNumbered(const std::string& pattern, const Paths& paths) {
    const auto chosen = drivers::PickPattern(pattern, paths);
    HV_EXPECT(chosen.ok() || chosen.error().starts_with(pattern + ": "));
    if (!chosen) return;
    ExpectSome(chosen.value(), paths);
    const unsigned first = NumberOf(chosen.value().front(), pattern);
    HV_EXPECT(first <= 1);
    for (std::size_t i = 0; i < chosen.value().size(); ++i)
        HV_EXPECT(NumberOf(chosen.value()[i], pattern) == first + i);
}

/// The same pictures in the same order, in whatever order the folder lists them.
void PickPictures(const std::string& folder, Paths paths) {
    const auto chosen = drivers::PickPictures(folder, paths);
    HV_EXPECT(chosen.ok() || chosen.error().starts_with(folder + ": "));
    if (!chosen) return;
    ExpectSome(chosen.value(), paths);
    const std::set<std::string> names(paths.begin(), paths.end());
    if (names.size() != paths.size()) return;
    std::ranges::reverse(paths);
    HV_EXPECT(drivers::PickPictures(folder, paths).value() == chosen.value());
}

}  // namespace

/// The first line is the pattern, or the name of the folder; the others are the files in it.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Paths paths = LinesOf(tests::TextOf({data, size}));
    if (paths.empty()) return 0;
    const std::string first = paths.front();
    paths.erase(paths.begin());
    PickNumbered(first, paths);
    PickPictures(first, paths);
    return 0;
}

#include "app/resources.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

namespace hitchview::app {
namespace {

/// Second number of /proc/self/statm: resident pages.
std::optional<std::uint64_t> ResidentPages() {
    const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (file < 0) return std::nullopt;
    std::array<char, 128> text{};
    const ssize_t bytes = read(file, text.data(), text.size());
    close(file);
    if (bytes <= 0) return std::nullopt;
    const char* const end = text.data() + bytes;
    const char* const blank = std::find(text.data(), text.data() + bytes, ' ');
    std::uint64_t pages = 0;
    if (blank == end || std::from_chars(blank + 1, end, pages).ec != std::errc{})
        return std::nullopt;
    return pages;
}

}  // namespace

Resources ReadResources() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    Resources resources{.minor_faults = static_cast<std::uint64_t>(usage.ru_minflt),
                        .major_faults = static_cast<std::uint64_t>(usage.ru_majflt)};
    if (const auto pages = ResidentPages())
        resources.rss_bytes = *pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    return resources;
}

}  // namespace hitchview::app

#include "app/log_time.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace hitchview::app {

std::string UtcText(std::int64_t utime_us) {
    constexpr std::int64_t kMicroseconds = 1'000'000;
    const std::time_t seconds = utime_us / kMicroseconds;
    std::tm utc{};
    std::array<char, 32> day{};
    const bool shown = utime_us >= 0 && gmtime_r(&seconds, &utc) != nullptr &&
                       std::strftime(day.data(), day.size(), "%Y-%m-%dT%H:%M:%S", &utc) > 0;
    if (!shown) return std::to_string(utime_us);
    std::array<char, 16> fraction{};
    std::snprintf(fraction.data(), fraction.size(), ".%06dZ",
                  static_cast<int>(utime_us % kMicroseconds));
    return std::string(day.data()) + fraction.data();
}

namespace {

constexpr double kMicrosecondsPerSecond = 1e6;

/// Of all of the text.
std::optional<double> Seconds(std::string_view text) {
    double seconds = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, seconds);
    if (error != std::errc{} || end != last || !(seconds >= 0 && seconds < 1e9))
        return std::nullopt;
    return seconds;
}

}  // namespace

std::optional<std::int64_t> ParseLogTime(const std::string& text, std::int64_t start_us) {
    if (const auto seconds = Seconds(text))
        return start_us + std::llround(*seconds * kMicrosecondsPerSecond);
    std::tm utc{};
    const char* const rest = strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &utc);
    if (rest == nullptr) return std::nullopt;
    std::string fraction(rest);
    if (fraction.ends_with('Z')) fraction.pop_back();
    const bool has_fraction = fraction.size() > 1 && fraction.front() == '.';
    if (!fraction.empty() && !has_fraction) return std::nullopt;
    const auto part = has_fraction ? Seconds("0" + fraction) : std::optional(0.0);
    const std::time_t seconds = timegm(&utc);
    if (!part || seconds < 0) return std::nullopt;
    return seconds * 1'000'000LL + std::llround(*part * kMicrosecondsPerSecond);
}

}  // namespace hitchview::app

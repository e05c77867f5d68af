#include "app/log_time.hpp"

#include <array>
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

}  // namespace hitchview::app

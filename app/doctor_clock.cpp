#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <ctime>

#include "app/doctor.hpp"

namespace hitchview::app {
namespace {

using SystemTime = std::chrono::system_clock::time_point;

/// 2024-01-01T00:00:00Z: older than any release.
constexpr SystemTime kLongAgo{std::chrono::seconds(1'704'067'200)};
constexpr const char* kClockSources = "/sys/devices/system/clocksource/clocksource0/";

std::string Text(SystemTime time) {
    const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
    std::tm parts{};
    std::array<char, 32> text{};
    if (gmtime_r(&seconds, &parts) == nullptr) return "beyond any year";
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text.data();
}

/// When the installed program was built: packages keep that as the time of its file.
SystemTime Built(const DoctorSubject& subject) {
    struct stat status {};
    if (stat(subject.machine.At("/usr/bin/hitchview").c_str(), &status) != 0) return kLongAgo;
    return std::max(kLongAgo, std::chrono::system_clock::from_time_t(status.st_mtime));
}

Diagnosis CheckSystemClock(const DoctorSubject& subject) {
    const SystemTime now = subject.machine.now();
    const SystemTime built = Built(subject);
    if (now >= built) return {Finding::kGood, "it is " + Text(now)};
    return {Finding::kBad,
            "it is " + Text(now) + ", which is before " + Text(built) +
                ": recordings get wrong names and times",
            "timedatectl set-time 'YYYY-MM-DD HH:MM:SS', then hwclock --systohc; look at the "
            "battery of the clock, or give the machine a time server"};
}

Diagnosis CheckSource(const DoctorSubject& subject) {
    const auto folder = subject.machine.At(kClockSources);
    const auto source = ReadText(folder / "current_clocksource");
    if (!source) return {.what = "the kernel does not tell its clock source"};
    const std::string what = "clock source " + *source;
    if (!source->ends_with("jiffies")) return {Finding::kGood, what};
    const std::string others = ReadText(folder / "available_clocksource").value_or("");
    return {Finding::kBad, what + ": stamps are milliseconds apart",
            "echo NAME > " + std::string(kClockSources) + "current_clocksource, one of: " + others};
}

Diagnosis TellSynchronisation(const DoctorSubject& subject) {
    const auto synchronised = subject.machine.is_clock_synchronised();
    if (!synchronised) return {.what = "the kernel does not tell"};
    if (*synchronised) return {Finding::kGood, "the system clock follows a reference"};
    return {.what = "the system clock follows no reference; not judged, a vehicle may have none"};
}

}  // namespace

std::vector<DoctorCheck> ClockChecks(const DoctorCase& subject) {
    return {{"system_clock", [subject] { return CheckSystemClock(*subject); }},
            {"clock_source", [subject] { return CheckSource(*subject); }},
            {"time_synchronisation", [subject] { return TellSynchronisation(*subject); }}};
}

}  // namespace hitchview::app

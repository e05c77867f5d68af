#include <algorithm>
#include <set>
#include <sstream>
#include <system_error>

#include "app/doctor.hpp"

namespace hitchview::app {
namespace {

constexpr const char* kPolicies = "/sys/devices/system/cpu/cpufreq";
constexpr const char* kNvpmodel = "/usr/sbin/nvpmodel";

bool IsJetson(const DoctorSubject& subject) {
    std::error_code missing;
    return std::filesystem::exists(subject.machine.At("/etc/nv_tegra_release"), missing);
}

/// Folders of groups of processors that share a clock, by name.
std::vector<std::filesystem::path> Policies(const DoctorSubject& subject) {
    constexpr std::size_t kMost = 1024;
    std::vector<std::filesystem::path> policies;
    std::error_code failed;
    std::filesystem::directory_iterator entry(subject.machine.At(kPolicies), failed);
    while (!failed && entry != std::filesystem::directory_iterator() && policies.size() < kMost) {
        if (entry->path().filename().string().starts_with("policy"))
            policies.push_back(entry->path());
        entry.increment(failed);
    }
    std::ranges::sort(policies);
    return policies;
}

/// `powersave` holds the lowest clock, but for drivers whose hardware takes it for a hint.
bool Throttles(const std::filesystem::path& policy, const std::string& governor) {
    const std::string driver = ReadText(policy / "scaling_driver").value_or("");
    return governor == "powersave" && driver != "intel_pstate" && driver != "amd-pstate-epp";
}

std::string Joined(const std::set<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

Diagnosis CheckGovernor(const DoctorSubject& subject) {
    std::set<std::string> governors;
    std::set<std::string> throttled;
    for (const auto& policy : Policies(subject)) {
        const auto governor = ReadText(policy / "scaling_governor");
        if (!governor) continue;
        governors.insert(*governor);
        if (Throttles(policy, *governor)) throttled.insert(policy.filename());
    }
    if (governors.empty()) return {.what = "the kernel does not scale these processors' clock"};
    const std::string what = "governor " + Joined(governors);
    if (throttled.empty()) return {Finding::kGood, what};
    return {Finding::kBad, what + " holds the lowest clock of " + Joined(throttled),
            "echo schedutil | tee /sys/devices/system/cpu/cpufreq/policy*/scaling_governor"};
}

/// "NV Power Mode: MAXN" -> "MAXN".
std::string ModeIn(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t colon = line.find("Power Mode:");
        if (colon == std::string::npos) continue;
        const std::size_t start = line.find_first_not_of(' ', line.find(':', colon) + 1);
        return start == std::string::npos ? "" : line.substr(start);
    }
    return "";
}

Diagnosis CheckPowerMode(const DoctorSubject& subject) {
    if (!IsJetson(subject)) return {.what = "not a Jetson"};
    const auto told = subject.machine.output({kNvpmodel, "-q"});
    const std::string mode = told ? ModeIn(*told) : "";
    if (mode.empty()) return {.what = "nvpmodel -q does not tell the power mode (sudo may help)"};
    if (mode.starts_with("MAXN")) return {Finding::kGood, "power mode " + mode};
    return {Finding::kBad, "power mode " + mode + " limits processors and memory",
            "nvpmodel -m 0 (MAXN); it lasts"};
}

Diagnosis CheckClocks(const DoctorSubject& subject) {
    if (!IsJetson(subject)) return {.what = "not a Jetson"};
    std::set<std::string> varying;
    const auto policies = Policies(subject);
    for (const auto& policy : policies) {
        const auto lowest = ReadNumber(policy / "scaling_min_freq");
        const auto highest = ReadNumber(policy / "scaling_max_freq");
        if (!lowest || !highest) return {.what = "the kernel does not tell the clocks' limits"};
        if (*lowest != *highest) varying.insert(policy.filename());
    }
    if (policies.empty()) return {.what = "the kernel does not tell the clocks' limits"};
    if (varying.empty())
        return {Finding::kGood, "the processors' clocks are held at their highest"};
    return {Finding::kBad, "the clocks vary of " + Joined(varying), "jetson_clocks, at each start"};
}

}  // namespace

std::vector<DoctorCheck> PowerChecks(const DoctorCase& subject) {
    return {{"power_mode", [subject] { return CheckPowerMode(*subject); }},
            {"cpu_governor", [subject] { return CheckGovernor(*subject); }, {"power_mode"}},
            {"jetson_clocks",
             [subject] { return CheckClocks(*subject); },
             {"power_mode", "cpu_governor"}}};
}

}  // namespace hitchview::app

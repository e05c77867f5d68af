#include <sys/resource.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "app/doctor.hpp"
#include "app/doctor_memory.hpp"

namespace hitchview::app {
namespace {

constexpr const char* kBandwidth = "/proc/sys/kernel/sched_rt_";
/// Share of the time that threads of a real-time priority must have.
constexpr double kLeastShare = 0.8;

int WantedPriority(const DoctorSubject& subject) {
    return std::max(1, subject.rig.config.schedule.priority);
}

bool Has(const SystemdUnit& service, const char* capability) {
    return service.user.empty() || service.capabilities.find(capability) != std::string::npos;
}

Diagnosis CheckServicePriority(const DoctorSubject& subject) {
    const int wanted = WantedPriority(subject);
    const SystemdUnit& service = subject.service;
    const auto limit = service.priority_limit;
    const std::string what = "the service's threads may have real-time priority up to " +
                             (limit ? std::to_string(*limit) : std::string("99"));
    if (Has(service, "cap_sys_nice") || !limit || *limit >= static_cast<unsigned>(wanted))
        return {Finding::kGood, what};
    return {Finding::kBad, what + ", not " + std::to_string(wanted),
            "LimitRTPRIO=50: systemctl edit hitchview, then systemctl restart hitchview"};
}

Diagnosis CheckPriority(const DoctorSubject& subject) {
    if (subject.service.IsLoaded()) return CheckServicePriority(subject);
    const auto applied = subject.machine.take_priority(WantedPriority(subject));
    if (applied) return {Finding::kGood, "threads may have real-time priority"};
    return {Finding::kBad, applied.error(), "LimitRTPRIO=50 in the service, or CAP_SYS_NICE"};
}

std::string MemoryLimit() {
    rlimit limit{};
    getrlimit(RLIMIT_MEMLOCK, &limit);
    if (limit.rlim_cur == RLIM_INFINITY) return "unlimited";
    return std::to_string(limit.rlim_cur) + " bytes";
}

Diagnosis CheckServiceMemoryLock(const DoctorSubject& subject) {
    const auto limit = subject.service.locked_limit_bytes;
    const std::string what = "memory that the service may lock: " +
                             (limit ? std::to_string(*limit) + " bytes" : "unlimited");
    const std::uint64_t needed_bytes = MemoryOfRun(subject.rig.config);
    if (Has(subject.service, "cap_ipc_lock") || !limit || *limit >= needed_bytes)
        return {Finding::kGood, what};
    return {Finding::kBad, what + ", a run takes " + Megabytes(needed_bytes),
            "LimitMEMLOCK=infinity: systemctl edit hitchview, then systemctl restart hitchview"};
}

Diagnosis CheckMemoryLock(const DoctorSubject& subject) {
    if (subject.service.IsLoaded()) return CheckServiceMemoryLock(subject);
    const std::string what = "memory that may be locked: " + MemoryLimit();
    const auto locked = subject.machine.lock_memory();
    if (locked) return {Finding::kGood, what};
    return {Finding::kBad, what + "; " + locked.error(), "LimitMEMLOCK=infinity in the service"};
}

Diagnosis CheckBandwidth(const DoctorSubject& subject) {
    const auto runtime_us = ReadNumber(subject.machine.At(std::string(kBandwidth) + "runtime_us"));
    const auto period_us = ReadNumber(subject.machine.At(std::string(kBandwidth) + "period_us"));
    if (!runtime_us || !period_us || *period_us <= 0)
        return {.what = "the kernel does not tell kernel.sched_rt_runtime_us"};
    const std::string what = "kernel.sched_rt_runtime_us is " + std::to_string(*runtime_us) +
                             " of " + std::to_string(*period_us);
    const double share = static_cast<double>(*runtime_us) / static_cast<double>(*period_us);
    if (*runtime_us < 0 || share >= kLeastShare) return {Finding::kGood, what};
    return {Finding::kBad, what + ": threads of a real-time priority are stopped in between",
            "sysctl -w kernel.sched_rt_runtime_us=" + std::to_string(*period_us / 20 * 19)};
}

}  // namespace

std::vector<DoctorCheck> RealTimeChecks(const DoctorCase& subject) {
    return {{"real_time_bandwidth", [subject] { return CheckBandwidth(*subject); }},
            {"real_time_priority",
             [subject] { return CheckPriority(*subject); },
             {"real_time_bandwidth"}},
            {"real_time_memory_lock", [subject] { return CheckMemoryLock(*subject); }}};
}

}  // namespace hitchview::app

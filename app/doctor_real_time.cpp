#include <sys/mman.h>
#include <sys/resource.h>

#include <thread>

#include "app/doctor.hpp"
#include "app/real_time.hpp"
#include "app/thread_schedule.hpp"

namespace hitchview::app {
namespace {

Diagnosis CheckPriority() {
    hal::Checked<hal::Done> applied = hal::Done{};
    // Ends with the thread.
    std::thread([&] { applied = Apply({.priority = 1}); }).join();
    if (applied) return {Finding::kGood, "threads may have real-time priority"};
    return {Finding::kBad, applied.error(), "LimitRTPRIO=50 in the service, or CAP_SYS_NICE"};
}

std::string MemoryLimit() {
    rlimit limit{};
    getrlimit(RLIMIT_MEMLOCK, &limit);
    if (limit.rlim_cur == RLIM_INFINITY) return "unlimited";
    return std::to_string(limit.rlim_cur) + " bytes";
}

Diagnosis CheckMemoryLock() {
    const std::string what = "memory that may be locked: " + MemoryLimit();
    const auto locked = LockAllMemory();
    munlockall();
    if (locked) return {Finding::kGood, what};
    return {Finding::kBad, what + "; " + locked.error(), "LimitMEMLOCK=infinity in the service"};
}

}  // namespace

std::vector<DoctorCheck> RealTimeChecks() {
    return {{"real_time_priority", CheckPriority}, {"real_time_memory_lock", CheckMemoryLock}};
}

}  // namespace hitchview::app

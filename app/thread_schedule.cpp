#include "app/thread_schedule.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

#include <cstring>
#include <string>

namespace hitchview::app {
namespace {

/// Empty, or what was refused. These calls return their error instead of setting errno.
std::string SetPriority(int priority) {
    const sched_param parameters{.sched_priority = priority};
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    if (error == 0) return "";
    return "threads.priority " + std::to_string(priority) + " is refused (" + std::strerror(error) +
           "): give the service LimitRTPRIO=" + std::to_string(priority) +
           " or the capability CAP_SYS_NICE";
}

std::string SetAffinity(const std::vector<int>& cpus) {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    for (const int cpu : cpus) CPU_SET(static_cast<std::size_t>(cpu), &allowed);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof allowed, &allowed);
    if (error == 0) return "";
    return std::string("threads.affinity is refused (") + std::strerror(error) +
           "): name CPUs that this machine has (lscpu) and the service may use (CPUAffinity=, "
           "AllowedCPUs=)";
}

}  // namespace

hal::Checked<hal::Done> Apply(const ThreadSchedule& schedule) {
    std::string refusals;
    if (schedule.priority > 0) refusals = SetPriority(schedule.priority);
    if (!schedule.affinity.empty()) {
        const std::string refusal = SetAffinity(schedule.affinity);
        if (!refusals.empty() && !refusal.empty()) refusals += "; ";
        refusals += refusal;
    }
    if (refusals.empty()) return hal::Done{};
    return refusals;
}

void RunInBackground() {
    constexpr int kNice = 10;
    // A service may have started all of the program with a priority. To give it up needs no right.
    const sched_param none{.sched_priority = 0};
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);
    setpriority(PRIO_PROCESS, 0, kNice);  // of a thread, in Linux: the calling one
}

void NameThisThread(const std::string& name) {
    constexpr std::size_t kLongestName = 15;
    pthread_setname_np(pthread_self(), name.substr(0, kLongestName).c_str());
}

int UsableCpus() {
    cpu_set_t allowed;
    if (pthread_getaffinity_np(pthread_self(), sizeof allowed, &allowed) != 0) return 1;
    return CPU_COUNT(&allowed);
}

}  // namespace hitchview::app

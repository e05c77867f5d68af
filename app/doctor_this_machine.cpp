#include <arpa/inet.h>
#include <grp.h>
#include <net/if.h>
#include <poll.h>
#include <pwd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/timex.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "app/camera_probe.hpp"
#include "app/doctor_machine.hpp"
#include "app/program.hpp"
#include "app/thread_schedule.hpp"
#include "drivers/lcm_listener.hpp"
#include "drivers/lcm_receive_buffer.hpp"
#include "drivers/lcm_self_test.hpp"
#include "drivers/socketcan_link.hpp"

namespace hitchview::app {
namespace {

using Milliseconds = std::chrono::milliseconds;
using drivers::CanLink;

std::optional<bool> IsClockSynchronised() {
    timex clock{};
    if (adjtimex(&clock) < 0) return std::nullopt;
    return (clock.status & STA_UNSYNC) == 0;
}

std::optional<std::string> Output(const std::vector<std::string>& command) {
    constexpr Milliseconds kPatience{1500};
    return OutputOf(command.front(), {command.begin() + 1, command.end()}, kPatience);
}

std::vector<gid_t> GroupsOf(const passwd& user) {
    constexpr int kMost = 1024;
    std::vector<gid_t> groups(kMost);
    int count = kMost;
    if (getgrouplist(user.pw_name, user.pw_gid, groups.data(), &count) < 0) return {user.pw_gid};
    groups.resize(static_cast<std::size_t>(count));
    return groups;
}

UserIds ThisUser() {
    constexpr int kMost = 1024;
    std::vector<gid_t> groups(kMost);
    const int count = getgroups(kMost, groups.data());
    groups.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
    groups.push_back(getegid());
    return {geteuid(), groups};
}

std::optional<UserIds> FindUser(const std::string& name) {
    if (name.empty()) return ThisUser();
    const passwd* const user = getpwnam(name.c_str());
    if (user == nullptr) return std::nullopt;
    return UserIds{user->pw_uid, GroupsOf(*user)};
}

std::optional<gid_t> FindGroup(const std::string& name) {
    const struct group* const found = getgrnam(name.c_str());
    if (found == nullptr) return std::nullopt;
    return found->gr_gid;
}

CanLinkFacts::State StateOf(const CanLink& link) {
    using State = CanLinkFacts::State;
    if (!link.state) return State::kUntold;
    switch (*link.state) {
        case CanLink::State::kActive:
            return State::kOnBus;
        case CanLink::State::kWarning:
        case CanLink::State::kPassive:
            return State::kErrors;
        case CanLink::State::kBusOff:
            return State::kBusOff;
        case CanLink::State::kStopped:
        case CanLink::State::kSleeping:
            break;
    }
    return State::kOffBus;
}

hal::Checked<CanLinkFacts> ReadCan(const std::string& interface) {
    const auto link = drivers::ReadCanLink(interface);
    if (!link) return link.error();
    const CanLink& found = link.value();
    return CanLinkFacts{.is_can = found.is_can,
                        .is_up = found.is_up,
                        .has_bit_rate = found.kind == "can",
                        .bit_rate = found.bit_rate,
                        .state = StateOf(found),
                        .restart_ms = found.restart_ms};
}

std::optional<SocketBufferFacts> ReadBuffers() {
    const auto buffers = drivers::ReadSocketBuffers();
    if (!buffers) return std::nullopt;
    return SocketBufferFacts{buffers->usual_bytes, buffers->largest_bytes};
}

hal::Result<std::string, int> MulticastSource() {
    const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (probe < 0) return errno;
    sockaddr_in group{
        .sin_family = AF_INET, .sin_port = htons(7667), .sin_addr = {}, .sin_zero = {}};
    inet_pton(AF_INET, "239.255.76.67", &group.sin_addr);
    sockaddr_in own{};
    socklen_t size = sizeof own;
    const bool routed =
        connect(probe, reinterpret_cast<const sockaddr*>(&group), sizeof group) == 0 &&
        getsockname(probe, reinterpret_cast<sockaddr*>(&own), &size) == 0;
    const int error = errno;
    close(probe);
    if (!routed) return error;
    std::array<char, INET_ADDRSTRLEN> text{};
    inet_ntop(AF_INET, &own.sin_addr, text.data(), text.size());
    return std::string(text.data());
}

std::optional<short> LoopbackFlags() {
    const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (probe < 0) return std::nullopt;
    ifreq request{};
    std::strncpy(request.ifr_name, "lo", IFNAMSIZ - 1);
    const bool asked = ioctl(probe, SIOCGIFFLAGS, &request) == 0;
    close(probe);
    if (!asked) return std::nullopt;
    return request.ifr_flags;
}

hal::Checked<HeardFacts> Hear(const std::string& url, const std::string& channel) {
    using Clock = std::chrono::steady_clock;
    constexpr Milliseconds kPatience{1500};
    constexpr int kEnough = 10;
    HeardFacts heard;
    auto listener = drivers::LcmListener::Create(
        {.url = url}, [&heard](std::string_view, auto) { ++heard.messages; });
    if (!listener) return listener.error();
    if (!listener.value()->Subscribe(channel, kEnough)) return std::string("LCM cannot subscribe");
    const auto start = Clock::now();
    pollfd readable{.fd = listener.value()->descriptor(), .events = POLLIN, .revents = 0};
    while (heard.messages < kEnough && heard.within < kPatience) {
        poll(&readable, 1, static_cast<int>((kPatience - heard.within).count()));
        if (!listener.value()->TakeAll()) return std::string("LCM gave up");
        heard.within = std::chrono::duration_cast<Milliseconds>(Clock::now() - start);
    }
    return heard;
}

hal::Checked<hal::Done> TakePriority(int priority) {
    hal::Checked<hal::Done> applied = hal::Done{};
    // Ends with the thread.
    std::thread([&] { applied = Apply({.priority = priority}); }).join();
    return applied;
}

/// With the limits of a run, and without making anything resident.
hal::Checked<hal::Done> TryLockMemory() {
    const bool locked = mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
    const int refusal = errno;
    munlockall();
    if (locked) return hal::Done{};
    return std::string(std::strerror(refusal));
}

}  // namespace

DoctorMachine ThisMachine() {
    return {.now = std::chrono::system_clock::now,
            .is_clock_synchronised = IsClockSynchronised,
            .output = Output,
            .user = FindUser,
            .group = FindGroup,
            .cameras =
                [](const std::vector<CameraWish>& wishes) {
                    return ProbeCameras(wishes, CameraMeasure::kNo);
                },
            .can_link = ReadCan,
            .socket_buffers = ReadBuffers,
            .multicast_source = MulticastSource,
            .loopback_flags = LoopbackFlags,
            .send_to_self = drivers::SendToSelf,
            .hear = Hear,
            .take_priority = TakePriority,
            .lock_memory = TryLockMemory};
}

}  // namespace hitchview::app

#include <arpa/inet.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include "app/doctor.hpp"
#include "app/receive_buffer.hpp"
#include "drivers/lcm_receive_buffer.hpp"
#include "drivers/lcm_self_test.hpp"
#include "drivers/lcm_url.hpp"

namespace hitchview::app {
namespace {

constexpr const char* kInstallSysctl =
    "install systemd/90-hitchview.conf in /etc/sysctl.d and run: sysctl --system";
/// Of the usual receive buffer that kUsualBufferImageBytes fits.
constexpr double kUsualBufferBytes = 212'992;

Diagnosis CheckLargestBuffer(const PublishConfig& publish) {
    const auto buffers = drivers::ReadSocketBuffers();
    if (!buffers) return {.what = "no socket can be opened"};
    const std::string what = "net.core.rmem_max is " + std::to_string(buffers->largest_bytes) +
                             ", panoramas have up to " + std::to_string(publish.max_bytes) +
                             " bytes";
    const auto verdict = JudgeReceiveBuffer(publish.max_bytes, buffers->largest_bytes, false);
    if (verdict.warning.view().empty()) return {Finding::kGood, what};
    return {Finding::kBad, what, kInstallSysctl};
}

Diagnosis CheckUsualBuffer(const PublishConfig& publish) {
    const auto buffers = drivers::ReadSocketBuffers();
    if (!buffers) return {.what = "no socket can be opened"};
    const int fits_bytes =
        static_cast<int>(kUsualBufferImageBytes * (buffers->usual_bytes / kUsualBufferBytes));
    const std::string what = "net.core.rmem_default is " + std::to_string(buffers->usual_bytes) +
                             ": programs with a plain LCM URL receive up to " +
                             std::to_string(fits_bytes) + " bytes";
    if (publish.max_bytes <= fits_bytes) return {Finding::kGood, what};
    return {Finding::kBad, what,
            std::string(kInstallSysctl) + ", or append &recv_buf_size=16777216 to their URLs"};
}

/// Where the kernel sends what goes to LCM's group: the address it would send from, or errno.
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

Diagnosis CheckRoute() {
    const auto source = MulticastSource();
    if (source) {
        const std::string from = source.value() == "0.0.0.0" ? "lo" : source.value();
        return {Finding::kGood, "224.0.0.0/4 is routed, from " + from};
    }
    return {Finding::kBad,
            std::string("224.0.0.0/4 is not routed: ") + std::strerror(source.error()),
            "for this machine alone: ip route add 224.0.0.0/4 dev lo; for display units: the same "
            "with the vehicle network's device"};
}

/// Of an interface; empty where it cannot be asked.
std::optional<short> InterfaceFlags(const char* name) {
    const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (probe < 0) return std::nullopt;
    ifreq request{};
    std::strncpy(request.ifr_name, name, IFNAMSIZ - 1);
    const bool asked = ioctl(probe, SIOCGIFFLAGS, &request) == 0;
    close(probe);
    if (!asked) return std::nullopt;
    return request.ifr_flags;
}

Diagnosis CheckLoopback() {
    const auto flags = InterfaceFlags("lo");
    if (!flags) return {.what = "the interface lo cannot be asked"};
    if ((*flags & IFF_UP) == 0) return {Finding::kBad, "lo is down", "ip link set lo up"};
    if ((*flags & IFF_MULTICAST) != 0) return {Finding::kGood, "lo is up and carries multicast"};
    // A route to lo needs no address.
    const auto source = MulticastSource();
    if (source && source.value() != "0.0.0.0" && !source.value().starts_with("127."))
        return {Finding::kGood, "lo carries no multicast, which goes by another interface"};
    return {Finding::kBad, "lo carries no multicast", "ip link set lo multicast on"};
}

Diagnosis CheckDelivery(const PublishConfig& publish) {
    if (!drivers::IsMulticastUrl(publish.url))
        return {.what = publish.url + " is no multicast network"};
    const auto sent = drivers::SendToSelf(publish.url, publish.max_bytes);
    const std::string what = std::to_string(publish.max_bytes) + " bytes over " + publish.url;
    if (sent) return {Finding::kGood, what + " came back"};
    return {Finding::kBad, what + ": " + sent.error(),
            "put the checks before this one right; then look at the firewall: UDP port of the URL"};
}

}  // namespace

std::vector<DoctorCheck> LcmChecks(const PublishConfig& publish) {
    return {{"lcm_receive_buffer", [publish] { return CheckLargestBuffer(publish); }},
            {"lcm_usual_receive_buffer", [publish] { return CheckUsualBuffer(publish); }},
            {"lcm_multicast_route", CheckRoute},
            {"lcm_loopback_multicast", CheckLoopback},
            {"lcm_delivery", [publish] { return CheckDelivery(publish); }}};
}

}  // namespace hitchview::app

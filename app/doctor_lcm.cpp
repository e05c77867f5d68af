#include <net/if.h>

#include <cstring>
#include <sstream>

#include "app/doctor.hpp"
#include "app/doctor_patience.hpp"
#include "app/doctor_route.hpp"
#include "app/receive_buffer.hpp"
#include "drivers/lcm_url.hpp"

namespace hitchview::app {
namespace {

constexpr const char* kInstallSysctl =
    "install systemd/sysctl/90-hitchview.conf in /etc/sysctl.d and run: sysctl --system";
/// Of the usual receive buffer that kUsualBufferImageBytes fits.
constexpr double kUsualBufferBytes = 212'992;
constexpr std::chrono::milliseconds kPatience{1800};
/// What LCM's group is sent from where a route names no address.
constexpr const char* kNoAddress = "0.0.0.0";

/// Of a receive buffer: the largest panorama that it holds with what the kernel keeps beside it.
int FittingBytes(int buffer_bytes) {
    return static_cast<int>(kUsualBufferImageBytes * (buffer_bytes / kUsualBufferBytes));
}

Diagnosis CheckLargestBuffer(const DoctorSubject& subject) {
    const auto buffers = subject.machine.socket_buffers();
    if (!buffers) return {.what = "no socket can be opened"};
    const PublishConfig& publish = subject.rig.config.publish;
    const std::string what = "net.core.rmem_max is " + std::to_string(buffers->largest_bytes) +
                             ", panoramas have up to " + std::to_string(publish.max_bytes) +
                             " bytes";
    const bool is_shrunk = buffers->largest_bytes < kUsualBufferBytes &&
                           publish.max_bytes > FittingBytes(buffers->largest_bytes);
    const auto verdict = JudgeReceiveBuffer(publish.max_bytes, buffers->largest_bytes, false);
    if (verdict.warning.view().empty() && !is_shrunk) return {Finding::kGood, what};
    return {Finding::kBad, what, kInstallSysctl};
}

Diagnosis CheckUsualBuffer(const DoctorSubject& subject) {
    const auto buffers = subject.machine.socket_buffers();
    if (!buffers) return {.what = "no socket can be opened"};
    const int fits_bytes = FittingBytes(buffers->usual_bytes);
    const std::string what = "net.core.rmem_default is " + std::to_string(buffers->usual_bytes) +
                             ": programs with a plain LCM URL receive up to " +
                             std::to_string(fits_bytes) + " bytes";
    if (subject.rig.config.publish.max_bytes <= fits_bytes) return {Finding::kGood, what};
    return {Finding::kBad, what,
            std::string(kInstallSysctl) + ", or append &recv_buf_size=16777216 to their URLs"};
}

/// The interface that /etc/hitchview/network names; empty: none, or there is no such file.
std::string WantedInterface(const DoctorMachine& machine) {
    constexpr std::string_view kKey = "interface=";
    std::istringstream lines(ReadText(machine.At("/etc/hitchview/network")).value_or(""));
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(kKey)) return line.substr(kKey.size());
    }
    return "";
}

Diagnosis CheckRoute(const DoctorSubject& subject) {
    const auto source = subject.machine.multicast_source();
    const std::string wanted = WantedInterface(subject.machine);
    const std::string taken = MulticastInterface(subject.machine);
    if (source && !wanted.empty() && !taken.empty() && wanted != taken) {
        return {Finding::kBad,
                "224.0.0.0/4 is routed to " + taken + ", /etc/hitchview/network says " + wanted,
                "systemctl restart hitchview-lcm-route"};
    }
    if (source) {
        const std::string from = source.value() == kNoAddress ? "lo" : source.value();
        return {Finding::kGood, "224.0.0.0/4 is routed, from " + from};
    }
    return {Finding::kBad,
            std::string("224.0.0.0/4 is not routed: ") + std::strerror(source.error()),
            "for this machine alone: ip route add 224.0.0.0/4 dev lo; for display units: the same "
            "with the vehicle network's device; as /etc/hitchview/network says: systemctl restart "
            "hitchview-lcm-route"};
}

Diagnosis CheckLoopback(const DoctorSubject& subject) {
    const auto flags = subject.machine.loopback_flags();
    if (!flags) return {.what = "the interface lo cannot be asked"};
    if ((*flags & IFF_UP) == 0) return {Finding::kBad, "lo is down", "ip link set lo up"};
    if ((*flags & IFF_MULTICAST) != 0) return {Finding::kGood, "lo is up and carries multicast"};
    const auto source = subject.machine.multicast_source();
    if (!source)
        return {.what =
                    "lo carries no multicast; judged after lcm_multicast_route, whether it must"};
    // A route to lo needs no address.
    if (source.value() != kNoAddress && !source.value().starts_with("127."))
        return {Finding::kGood, "lo carries no multicast, which goes by another interface"};
    return {Finding::kBad, "lo carries no multicast", "ip link set lo multicast on"};
}

Diagnosis CheckDelivery(const DoctorSubject& subject) {
    const PublishConfig& publish = subject.rig.config.publish;
    if (!drivers::IsMulticastUrl(publish.url))
        return {.what = publish.url + " is no multicast network"};
    // LCM has much to say about it.
    if (!subject.machine.multicast_source())
        return {Finding::kBad, "nothing can be sent", "ip route add 224.0.0.0/4 dev lo"};
    // LCM looks for itself before it starts, and goes on looking where nothing gets through.
    const auto sent = Within(kPatience, [send = subject.machine.send_to_self, publish] {
        return send(publish.url, publish.max_bytes);
    });
    const std::string what = std::to_string(publish.max_bytes) + " bytes over " + publish.url;
    if (sent && sent->ok()) return {Finding::kGood, what + " came back"};
    return {Finding::kBad, what + ": " + (sent ? sent->error() : "nothing came back"),
            "look for a firewall that drops the URL's UDP port: nft list ruleset"};
}

}  // namespace

std::vector<DoctorCheck> LcmChecks(const DoctorCase& subject) {
    return {{"lcm_receive_buffer", [subject] { return CheckLargestBuffer(*subject); }},
            {"lcm_usual_receive_buffer",
             [subject] { return CheckUsualBuffer(*subject); },
             {"lcm_receive_buffer"}},
            {"lcm_loopback_multicast", [subject] { return CheckLoopback(*subject); }},
            {"lcm_multicast_route",
             [subject] { return CheckRoute(*subject); },
             {"lcm_loopback_multicast"}},
            {"lcm_delivery",
             [subject] { return CheckDelivery(*subject); },
             {"lcm_receive_buffer", "lcm_loopback_multicast", "lcm_multicast_route"}}};
}

}  // namespace hitchview::app

#include "app/doctor.hpp"

namespace hitchview::app {
namespace {

using State = CanLinkFacts::State;
using Judge = Diagnosis (*)(const std::string& name, const CanLinkFacts& link);

bool HasBus(const RigConfig& rig) {
    return rig.can && rig.can->source == CanConfig::Source::kSocketCan;
}

Diagnosis CheckInterface(const DoctorSubject& subject) {
    if (!HasBus(subject.rig.config)) return {.what = "the rig names no CAN bus of this machine"};
    const std::string& name = subject.rig.config.can->interface;
    const auto link = subject.machine.can_link(name);
    if (link && link.value().is_can) return {Finding::kGood, name + " is a CAN interface"};
    return {Finding::kBad, link ? "'" + name + "' is no CAN interface" : link.error(),
            "look at the adapter and its module (dmesg; ip -details link show type can), or put "
            "can.source of the rig file right"};
}

Diagnosis JudgeBitRate(const std::string& name, const CanLinkFacts& link) {
    if (!link.has_bit_rate) return {Finding::kGood, name + " has no bit rate to set"};
    if (link.bit_rate > 0)
        return {Finding::kGood, name + " runs at " + std::to_string(link.bit_rate) + " bit/s"};
    return {Finding::kBad, name + " has no bit rate",
            "name it in /etc/hitchview/can and run: systemctl restart hitchview-can@" + name};
}

Diagnosis JudgeUp(const std::string& name, const CanLinkFacts& link) {
    if (link.is_up) return {Finding::kGood, name + " is up"};
    return {Finding::kBad, name + " is down",
            "systemctl restart hitchview-can@" + name +
                " where /etc/hitchview/can names it; otherwise: ip link set " + name + " up"};
}

Diagnosis JudgeState(const std::string& name, const CanLinkFacts& link) {
    const std::string restart =
        link.restart_ms > 0 ? "; it starts again after " + std::to_string(link.restart_ms) + " ms"
                            : "; it stays so";
    switch (link.state) {
        case State::kUntold:
            return {Finding::kGood, name + " has no controller that could be off the bus"};
        case State::kOnBus:
            return {Finding::kGood, name + " is on the bus"};
        case State::kErrors:
            return {Finding::kGood, name + " is on the bus, which has many errors"};
        case State::kBusOff:
            return {Finding::kBad, name + " is bus-off" + restart,
                    "look at wiring, terminators and bit rate; then: ip link set " + name +
                        " type can restart"};
        case State::kOffBus:
            break;
    }
    if (link.is_up) return {.what = name + " is up, and its controller says it is stopped"};
    return {Finding::kBad, name + " is stopped", "ip link set " + name + " up"};
}

/// Of the rig's interface, where there is one.
Diagnosis Check(const DoctorSubject& subject, Judge judge) {
    if (!HasBus(subject.rig.config)) return {.what = "the rig names no CAN bus of this machine"};
    const std::string& name = subject.rig.config.can->interface;
    const auto link = subject.machine.can_link(name);
    if (!link || !link.value().is_can) return {.what = "after can_interface"};
    return judge(name, link.value());
}

}  // namespace

std::vector<DoctorCheck> CanChecks(const DoctorCase& subject) {
    return {{"can_interface", [subject] { return CheckInterface(*subject); }},
            {"can_bit_rate", [subject] { return Check(*subject, JudgeBitRate); }},
            {"can_up", [subject] { return Check(*subject, JudgeUp); }, {"can_bit_rate"}},
            {"can_bus_state",
             [subject] { return Check(*subject, JudgeState); },
             {"can_bit_rate", "can_up"}}};
}

}  // namespace hitchview::app

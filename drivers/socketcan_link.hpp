#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hal/result.hpp"

/// What the kernel says of a CAN interface beyond its flags. For diagnosis alone.
namespace hitchview::drivers {

struct CanLink {
    enum class State { kActive, kWarning, kPassive, kBusOff, kStopped, kSleeping };

    bool is_can = false;
    bool is_up = false;
    std::string kind{};            ///< can, vcan, vxcan; empty: the driver does not tell
    std::uint32_t bit_rate = 0;    ///< per second; 0: not set, or not told
    std::optional<State> state{};  ///< of its controller; empty: not told
    std::uint32_t restart_ms = 0;  ///< after bus-off; 0: it stays off
};

/// Asks the kernel by netlink and changes nothing. Waits at most half a second. Error: there is no
/// such interface, or the kernel does not answer.
hal::Checked<CanLink> ReadCanLink(const std::string& name);

/// Of one netlink message, from its header on; empty: it tells of no interface. Trusts no length.
std::optional<CanLink> ParseCanLink(std::span<const std::byte> message);

}  // namespace hitchview::drivers

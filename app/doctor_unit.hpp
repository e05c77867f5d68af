#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/doctor_machine.hpp"

namespace hitchview::app {

/// What systemd says of a unit.
struct SystemdUnit {
    bool is_told = false;           ///< systemd runs and answered; otherwise nothing below is known
    std::string load_state{};       ///< loaded, not-found, masked, bad-setting, error
    std::string unit_file_state{};  ///< enabled, disabled, static, masked
    std::string active_state{};     ///< active, inactive, failed, activating, deactivating
    std::string sub_state{};        ///< running, dead, auto-restart, start-pre
    std::string result{};           ///< success, exit-code, watchdog, oom-kill
    std::uint64_t restarts = 0;
    std::string user{};  ///< empty: root
    std::vector<std::string> supplementary_groups{};
    std::string capabilities{};                         ///< that it has beyond its user's
    std::optional<std::uint64_t> priority_limit{};      ///< empty: none
    std::optional<std::uint64_t> locked_limit_bytes{};  ///< empty: none
    std::optional<std::uint64_t> memory_limit_bytes{};  ///< empty: none
    bool is_confined = false;                           ///< it may write only to `writable`
    std::vector<std::string> writable{};                ///< folders

    [[nodiscard]] bool IsLoaded() const { return is_told && load_state == "loaded"; }
    [[nodiscard]] bool IsActive() const { return IsLoaded() && active_state == "active"; }
};

/// Asks `systemctl show`; nothing is told where systemd does not run.
SystemdUnit ReadUnit(const DoctorMachine& machine, const std::string& unit);

/// Units of ours that failed, but for `other_than`. Empty vector: none; empty: not told.
std::optional<std::vector<std::string>> FailedUnits(const DoctorMachine& machine,
                                                    const std::string& other_than);

}  // namespace hitchview::app

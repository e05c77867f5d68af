#include <algorithm>
#include <system_error>

#include "app/doctor.hpp"

namespace hitchview::app {
namespace {

constexpr const char* kService = "hitchview.service";

/// Why the service cannot be asked about; empty: it can.
std::string Unasked(const DoctorSubject& subject) {
    const SystemdUnit& service = subject.service;
    if (!service.is_told) return "systemd does not run here";
    return service.load_state == "not-found" ? "hitchview.service is not installed" : "";
}

Diagnosis CheckEnabled(const DoctorSubject& subject) {
    if (const std::string why = Unasked(subject); !why.empty()) return {.what = why};
    const SystemdUnit& service = subject.service;
    const std::string what =
        "hitchview.service is " +
        (service.unit_file_state.empty() ? service.load_state : service.unit_file_state);
    if (service.unit_file_state == "enabled") return {Finding::kGood, what};
    std::error_code missing;
    if (!std::filesystem::exists(subject.machine.At(kInstalledRig), missing))
        return {.what = what + ", and there is no rig file yet"};
    return {Finding::kBad, what + ": there will be no panorama after the next start",
            service.load_state == "masked"
                ? "systemctl unmask hitchview; systemctl enable --now hitchview"
                : "systemctl enable --now hitchview"};
}

std::string Journal(const std::string& unit) {
    return "journalctl --unit " + unit + " --lines 50 tells why";
}

Diagnosis CheckService(const DoctorSubject& subject) {
    if (const std::string why = Unasked(subject); !why.empty()) return {.what = why};
    const SystemdUnit& service = subject.service;
    const std::string what = "hitchview.service is " + service.active_state + " (" +
                             service.sub_state + "), " + std::to_string(service.restarts) +
                             " restarts";
    if (service.active_state == "active") return {Finding::kGood, what};
    if (subject.recorder.IsActive())
        return {Finding::kGood, "hitchview-record.service runs in its place"};
    if (subject.rig.state == DoctorRig::State::kAbsent)
        return {.what = what + "; it waits for a rig file"};
    const bool failed = service.active_state == "failed" || service.sub_state == "auto-restart";
    if (failed)
        return {Finding::kBad, what + ", the last time by " + service.result, Journal(kService)};
    if (service.active_state == "activating") {
        // One that was started again and again has not come up.
        if (service.restarts > 0)
            return {Finding::kBad, what + ", and starts once more", Journal(kService)};
        return {.what = what + ": ask again in half a minute"};
    }
    return {Finding::kBad, what, "systemctl start hitchview"};
}

Diagnosis CheckUnits(const DoctorSubject& subject) {
    const auto failed = FailedUnits(subject.machine, kService);
    if (!failed) return {.what = "systemd does not run here"};
    if (failed->empty()) return {Finding::kGood, "no other unit of Hitchview failed"};
    std::string units;
    for (const std::string& unit : *failed) units += (units.empty() ? "" : ", ") + unit;
    return {Finding::kBad, "failed: " + units, Journal(failed->front())};
}

}  // namespace

std::vector<DoctorCheck> ServiceChecks(const DoctorCase& subject) {
    return {{"service_enabled", [subject] { return CheckEnabled(*subject); }, {"rig_file"}},
            {"service",
             [subject] { return CheckService(*subject); },
             {"rig_file", "camera_devices", "camera_access", "camera_formats", "can_interface",
              "calibration", "record_folder", "memory", "memory_limit", "real_time_memory_lock",
              "lcm_loopback_multicast", "lcm_multicast_route", "slot_programs", "service_enabled"}},
            {"service_units",
             [subject] { return CheckUnits(*subject); },
             {"rig_file", "calibration", "record_folder", "can_interface", "can_bit_rate", "can_up",
              "lcm_loopback_multicast", "lcm_multicast_route", "slot_programs", "slot_rollback",
              "service"}}};
}

}  // namespace hitchview::app

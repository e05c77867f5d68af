#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/config.hpp"
#include "app/doctor_machine.hpp"
#include "app/doctor_unit.hpp"

namespace hitchview::app {

enum class Finding {
    kGood,
    kBad,
    kUnknown,  ///< this check cannot be made here, or judges nothing; `what` says why
};

constexpr const char* ToString(Finding finding) {
    switch (finding) {
        case Finding::kGood:
            return "good";
        case Finding::kBad:
            return "bad";
        case Finding::kUnknown:
            return "unknown";
    }
    return "unknown";
}

/// What a check found.
struct Diagnosis {
    Finding finding = Finding::kUnknown;
    std::string what{};    ///< with the figures
    std::string remedy{};  ///< a command or a setting; empty unless kBad
};

/// One question about a machine. Its order in a list is the order it is asked in.
struct DoctorCheck {
    const char* name;  ///< stable: scripts read it
    std::function<Diagnosis()> run;
    /// Checks before it, any of which may be why this one is bad: it is then unknown, "after" that.
    std::vector<std::string> needs{};
};

/// The rig file that a machine is asked about.
struct DoctorRig {
    enum class State {
        kAbsent,
        kBroken,  ///< `problem` says how
        kLoaded,
    };

    State state = State::kAbsent;
    std::filesystem::path file{};
    std::string problem{};
    RigConfig config{};        ///< kLoaded only; otherwise what a rig file leaves out
    bool is_installed = true;  ///< it is the one that the service runs
};

/// A machine, what is asked of it, and what the checks share.
struct DoctorSubject {
    DoctorMachine machine{};
    DoctorRig rig{};
    SystemdUnit service{};   ///< hitchview.service
    SystemdUnit recorder{};  ///< hitchview-record.service, which may run in its place

    [[nodiscard]] bool MakesPanoramas() const { return service.IsActive() || recorder.IsActive(); }
    /// Who opens the devices and files: the service's user; empty: there is none, it is who asks.
    [[nodiscard]] std::string user() const;
    /// "user hitchview", "this user".
    [[nodiscard]] std::string who() const;
    [[nodiscard]] std::optional<UserIds> user_ids() const;
};
using DoctorCase = std::shared_ptr<const DoctorSubject>;

/// Reads what the checks share. `rig`: file; empty: the installed one, where there is one.
DoctorCase ExamineMachine(DoctorMachine machine, const std::filesystem::path& rig);

/// Where the service's rig file is.
inline constexpr const char* kInstalledRig = "/etc/hitchview/rig.yaml";

/// Whether there is a rig file, and it is right.
std::vector<DoctorCheck> RigFileChecks(const DoctorCase& subject);
/// Whether panoramas reach subscribers on this machine as `publish` sends them.
std::vector<DoctorCheck> LcmChecks(const DoctorCase& subject);
/// Whether the cameras that the rig names are there, may be opened, and give what it asks.
std::vector<DoctorCheck> CameraChecks(const DoctorCase& subject);
/// Whether the bus that the rig names is there and works.
std::vector<DoctorCheck> CanChecks(const DoctorCase& subject);
/// Whether the calibration can be used with the rig.
std::vector<DoctorCheck> CalibrationChecks(const DoctorCase& subject);
/// Whether recordings have a place.
std::vector<DoctorCheck> DiskChecks(const DoctorCase& subject);
/// Whether a run of the rig finds enough memory.
std::vector<DoctorCheck> MemoryChecks(const DoctorCase& subject);
/// Whether the clocks can be relied on.
std::vector<DoctorCheck> ClockChecks(const DoctorCase& subject);
/// Whether the processor runs as fast as it can.
std::vector<DoctorCheck> PowerChecks(const DoctorCase& subject);
/// Whether a run can have its priority and its memory.
std::vector<DoctorCheck> RealTimeChecks(const DoctorCase& subject);
/// Whether the installed releases are whole, and which one runs.
std::vector<DoctorCheck> SlotChecks(const DoctorCase& subject);
/// Whether the services run, and start with the machine.
std::vector<DoctorCheck> ServiceChecks(const DoctorCase& subject);
/// Whether a panorama is on LCM at this moment.
std::vector<DoctorCheck> DisplayChecks(const DoctorCase& subject);

}  // namespace hitchview::app

#include "app/doctor_verb.hpp"

#include <cstdio>
#include <utility>

#include "app/doctor_answers.hpp"
#include "app/exit_code.hpp"

namespace hitchview::app {
namespace {

using State = DoctorRig::State;

/// Why what a rig file says cannot be asked about; empty: it can.
std::string WhyNoRig(const DoctorRig& rig) {
    switch (rig.state) {
        case State::kAbsent:
            return "there is no rig file";
        case State::kBroken:
            return "after rig_file";
        case State::kLoaded:
            break;
    }
    return "";
}

class CheckList {
 public:
    explicit CheckList(const DoctorCase& subject)
        : subject_(subject), why_no_rig_(WhyNoRig(subject->rig)) {}

    using Maker = std::vector<DoctorCheck> (*)(const DoctorCase& subject);
    void Add(Maker make) {
        for (DoctorCheck& check : make(subject_)) checks_.push_back(std::move(check));
    }
    void AddOfRig(Maker make) {
        for (DoctorCheck& check : make(subject_)) {
            if (!why_no_rig_.empty())
                check.run = [why = why_no_rig_] { return Diagnosis{.what = why}; };
            checks_.push_back(std::move(check));
        }
    }
    std::vector<DoctorCheck> Take() { return std::move(checks_); }

 private:
    DoctorCase subject_;
    std::string why_no_rig_;
    std::vector<DoctorCheck> checks_{};
};

}  // namespace

std::vector<DoctorCheck> AllChecks(const DoctorCase& subject) {
    CheckList list(subject);
    list.Add(RigFileChecks);
    list.Add(LcmChecks);
    list.AddOfRig(CameraChecks);
    list.AddOfRig(CanChecks);
    list.AddOfRig(CalibrationChecks);
    list.AddOfRig(DiskChecks);
    list.AddOfRig(MemoryChecks);
    list.Add(ClockChecks);
    list.Add(PowerChecks);
    list.Add(RealTimeChecks);
    list.Add(SlotChecks);
    list.Add(ServiceChecks);
    list.AddOfRig(DisplayChecks);
    return list.Take();
}

int DoctorVerb(const DoctorOptions& options) {
    const DoctorCase subject = ExamineMachine(ThisMachine(), options.rig);
    if (!options.rig.empty() && subject->rig.state == State::kBroken)
        return Fail(kWrongUse, subject->rig.problem);
    const auto answers = RunChecks(AllChecks(subject));
    const std::string text = options.json ? DoctorJson(answers) : DoctorTable(answers);
    if (std::puts(text.c_str()) < 0 || std::fflush(stdout) != 0)
        return Fail(kMachineFailed, "doctor: the answer cannot be written");
    return IsReady(answers) ? kGood : kBad;
}

}  // namespace hitchview::app

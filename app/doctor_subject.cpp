#include <utility>

#include "app/doctor.hpp"
#include "app/doctor_rig.hpp"

namespace hitchview::app {
namespace {

constexpr const char* kUser = "hitchview";

}  // namespace

std::string DoctorSubject::user() const {
    if (service.IsLoaded()) return service.user.empty() ? "root" : service.user;
    return machine.user(kUser) ? kUser : "";
}

std::string DoctorSubject::who() const {
    const std::string name = user();
    return name.empty() ? "this user" : "user " + name;
}

std::optional<UserIds> DoctorSubject::user_ids() const {
    auto ids = machine.user(user());
    if (!ids) return ids;
    for (const std::string& name : service.supplementary_groups) {
        if (const auto group = machine.group(name)) ids->groups.push_back(*group);
    }
    return ids;
}

DoctorCase ExamineMachine(DoctorMachine machine, const std::filesystem::path& rig) {
    auto subject = std::make_shared<DoctorSubject>();
    subject->machine = std::move(machine);
    subject->rig = ReadRig(subject->machine, rig);
    subject->service = ReadUnit(subject->machine, "hitchview.service");
    subject->recorder = ReadUnit(subject->machine, "hitchview-record.service");
    return subject;
}

}  // namespace hitchview::app

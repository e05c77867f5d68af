#include <unistd.h>

#include <sstream>
#include <system_error>

#include "app/doctor.hpp"

namespace hitchview::app {
namespace {

constexpr const char* kSlots = "/opt/hitchview/slots";
constexpr const char* kReinstall =
    "apt-get install --reinstall hitchview; hitchview-slots status tells what there is";

std::filesystem::path Slots(const DoctorSubject& subject) {
    return subject.machine.At(kSlots);
}

bool AreThere(const DoctorSubject& subject) {
    std::error_code missing;
    return std::filesystem::is_directory(Slots(subject), missing);
}

/// The value of a line `key=value`; empty: there is none.
std::string Value(const std::string& text, const std::string& key) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(key + "=")) return line.substr(key.size() + 1);
    }
    return "";
}

/// a or b; empty: the link is missing, or leads elsewhere.
std::string CurrentSlot(const DoctorSubject& subject) {
    std::error_code failed;
    const std::string slot = std::filesystem::read_symlink(Slots(subject) / "current", failed);
    return slot == "a" || slot == "b" ? slot : "";
}

/// What a slot lacks; empty: nothing.
std::string Missing(const std::filesystem::path& slot) {
    for (const char* program : {"hitchview", "hitchview-web"}) {
        const std::filesystem::path file = slot / "bin" / program;
        std::error_code missing;
        const bool is_program = std::filesystem::is_regular_file(file, missing);
        if (!is_program || access(file.c_str(), X_OK) != 0) return std::string("bin/") + program;
    }
    return ReadText(slot / "release").value_or("").empty() ? "release" : "";
}

Diagnosis CheckPrograms(const DoctorSubject& subject) {
    if (!AreThere(subject)) return {.what = "no release is installed in /opt/hitchview/slots"};
    const std::string slot = CurrentSlot(subject);
    if (slot.empty())
        return {Finding::kBad, "/opt/hitchview/slots/current leads to no slot", kReinstall};
    const std::string missing = Missing(Slots(subject) / slot);
    if (!missing.empty()) {
        return {Finding::kBad, "slot " + slot + ", which runs, lacks " + missing, kReinstall};
    }
    const std::string release = *ReadText(Slots(subject) / slot / "release");
    const auto trial = ReadText(Slots(subject) / "trial");
    const std::string state =
        trial ? ", on trial: " + Value(*trial, "boots_left") + " starts left to prove itself" : "";
    return {Finding::kGood, "release " + release + " in slot " + slot + state};
}

Diagnosis CheckRollback(const DoctorSubject& subject) {
    if (!AreThere(subject)) return {.what = "no release is installed in /opt/hitchview/slots"};
    const auto rolled_back = ReadText(Slots(subject) / "rolled-back");
    if (!rolled_back) return {Finding::kGood, "no release was rolled back"};
    return {Finding::kBad,
            "release " + Value(*rolled_back, "release") + " was rolled back at " +
                Value(*rolled_back, "when") + ": " + Value(*rolled_back, "why"),
            "journalctl --unit hitchview-trial; then install a release that works, or keep this "
            "one: hitchview-slots acknowledge"};
}

}  // namespace

std::vector<DoctorCheck> SlotChecks(const DoctorCase& subject) {
    return {{"slot_programs", [subject] { return CheckPrograms(*subject); }},
            {"slot_rollback", [subject] { return CheckRollback(*subject); }}};
}

}  // namespace hitchview::app

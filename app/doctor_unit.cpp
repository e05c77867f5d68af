#include "app/doctor_unit.hpp"

#include <charconv>
#include <map>
#include <sstream>
#include <system_error>

namespace hitchview::app {
namespace {

constexpr const char* kSystemctl = "/usr/bin/systemctl";

bool DoesSystemdRun(const DoctorMachine& machine) {
    std::error_code missing;
    return std::filesystem::is_directory(machine.At("/run/systemd/system"), missing);
}

/// Lines `Property=value`.
std::map<std::string, std::string> Properties(const std::string& text) {
    std::map<std::string, std::string> properties;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t equals = line.find('=');
        if (equals != std::string::npos)
            properties[line.substr(0, equals)] = line.substr(equals + 1);
    }
    return properties;
}

std::optional<std::uint64_t> Number(const std::string& text) {
    std::uint64_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || rest != end) return std::nullopt;
    return number;
}

std::vector<std::string> Words(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

std::vector<std::string> Writable(std::map<std::string, std::string>& properties) {
    std::vector<std::string> folders = Words(properties["ReadWritePaths"]);
    // Marks of paths that may be missing, or stand below the unit's root.
    for (std::string& folder : folders) folder.erase(0, folder.find('/'));
    std::erase(folders, "");
    for (const std::string& state : Words(properties["StateDirectory"]))
        folders.push_back("/var/lib/" + state);
    return folders;
}

}  // namespace

SystemdUnit ReadUnit(const DoctorMachine& machine, const std::string& unit) {
    if (!DoesSystemdRun(machine)) return {};
    const auto text = machine.output(
        {kSystemctl, "show", unit,
         "--property=LoadState,UnitFileState,ActiveState,SubState,Result,NRestarts,User,"
         "SupplementaryGroups,AmbientCapabilities,LimitRTPRIO,LimitMEMLOCK,"
         "MemoryMax,ProtectSystem,StateDirectory,ReadWritePaths"});
    if (!text) return {};
    auto properties = Properties(*text);
    return {.is_told = properties.contains("LoadState"),
            .load_state = properties["LoadState"],
            .unit_file_state = properties["UnitFileState"],
            .active_state = properties["ActiveState"],
            .sub_state = properties["SubState"],
            .result = properties["Result"],
            .restarts = Number(properties["NRestarts"]).value_or(0),
            .user = properties["User"],
            .supplementary_groups = Words(properties["SupplementaryGroups"]),
            .capabilities = properties["AmbientCapabilities"],
            .priority_limit = Number(properties["LimitRTPRIO"]),
            .locked_limit_bytes = Number(properties["LimitMEMLOCK"]),
            .memory_limit_bytes = Number(properties["MemoryMax"]),
            .is_confined = properties["ProtectSystem"] == "strict",
            .writable = Writable(properties)};
}

std::optional<std::vector<std::string>> FailedUnits(const DoctorMachine& machine,
                                                    const std::string& other_than) {
    if (!DoesSystemdRun(machine)) return std::nullopt;
    const auto text = machine.output({kSystemctl, "list-units", "--state=failed", "--plain",
                                      "--no-legend", "--full", "hitchview*"});
    if (!text) return std::nullopt;
    std::vector<std::string> units;
    std::istringstream lines(*text);
    for (std::string line; std::getline(lines, line);) {
        const auto words = Words(line);
        const std::string unit = words.empty() ? "" : words.front();
        if (unit.starts_with("hitchview") && unit != other_than) units.push_back(unit);
    }
    return units;
}

}  // namespace hitchview::app

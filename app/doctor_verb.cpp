#include "app/doctor_verb.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

namespace hitchview::app {
namespace {

constexpr int kNotReady = 1;
constexpr int kWrongUse = 2;

/// Everything that is asked of this machine.
std::vector<DoctorCheck> AllChecks(const RigConfig& config) {
    std::vector<DoctorCheck> checks = LcmChecks(config.publish);
    for (DoctorCheck& check : RealTimeChecks()) checks.push_back(std::move(check));
    return checks;
}

}  // namespace

std::vector<DoctorAnswer> RunChecks(const std::vector<DoctorCheck>& checks) {
    std::vector<DoctorAnswer> answers;
    for (const DoctorCheck& check : checks) answers.push_back({check.name, check.run()});
    return answers;
}

std::string DoctorTable(const std::vector<DoctorAnswer>& answers) {
    std::size_t widest = 0;
    for (const DoctorAnswer& answer : answers) widest = std::max(widest, answer.name.size());
    std::string text;
    for (const auto& [name, diagnosis] : answers) {
        std::string verdict = ToString(diagnosis.finding);
        verdict.resize(9, ' ');
        text += verdict + name + std::string(widest + 2 - name.size(), ' ') + diagnosis.what + '\n';
        if (!diagnosis.remedy.empty())
            text += std::string(11 + widest, ' ') + "-> " + diagnosis.remedy + '\n';
    }
    return text;
}

std::string DoctorJson(const std::vector<DoctorAnswer>& answers) {
    nlohmann::json checks = nlohmann::json::array();
    for (const auto& [name, diagnosis] : answers) {
        checks.push_back({{"check", name},
                          {"verdict", ToString(diagnosis.finding)},
                          {"what", diagnosis.what},
                          {"remedy", diagnosis.remedy}});
    }
    return nlohmann::json{{"schema", 1}, {"ready", IsReady(answers)}, {"checks", checks}}.dump(2);
}

bool IsReady(const std::vector<DoctorAnswer>& answers) {
    return std::ranges::none_of(answers, [](const DoctorAnswer& answer) {
        return answer.diagnosis.finding == Finding::kBad;
    });
}

int DoctorVerb(const DoctorOptions& options) {
    RigConfig config;
    if (!options.rig.empty()) {
        auto loaded = LoadRigConfig(options.rig);
        if (!loaded) {
            std::fprintf(stderr, "%s\n", loaded.error().c_str());
            return kWrongUse;
        }
        config = std::move(*loaded);
    }
    const auto answers = RunChecks(AllChecks(config));
    std::puts((options.json ? DoctorJson(answers) : DoctorTable(answers)).c_str());
    return IsReady(answers) ? 0 : kNotReady;
}

}  // namespace hitchview::app

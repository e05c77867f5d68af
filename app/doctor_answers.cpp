#include "app/doctor_answers.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/doctor_patience.hpp"

namespace hitchview::app {
namespace {

Diagnosis Ask(const DoctorCheck& check, std::chrono::milliseconds patience) {
    if (auto diagnosis = Within(patience, check.run)) return *std::move(diagnosis);
    return {Finding::kBad, "no answer within " + std::to_string(patience.count()) + " ms",
            "see what the kernel says: dmesg"};
}

/// Of checks that are bad, or that were found so after another one: that one.
using Roots = std::map<std::string, std::string>;

/// Empty: nothing that the check needs is bad.
std::string RootOf(const DoctorCheck& check, const Roots& roots) {
    for (const std::string& need : check.needs) {
        if (const auto root = roots.find(need); root != roots.end()) return root->second;
    }
    return "";
}

Diagnosis After(const std::string& root, const Diagnosis& diagnosis) {
    return {Finding::kUnknown, "after " + root + ": " + diagnosis.what, ""};
}

/// Texts of files and devices hold whatever they like: one line that obeys no terminal.
std::string Shown(std::string text) {
    std::ranges::replace_if(
        text,
        [](char c) {
            const auto code = static_cast<unsigned char>(c);
            return code < ' ' || code == 0x7f;
        },
        ' ');
    return text;
}

}  // namespace

std::vector<DoctorAnswer> RunChecks(const std::vector<DoctorCheck>& checks,
                                    std::chrono::milliseconds patience) {
    std::vector<DoctorAnswer> answers;
    Roots roots;
    for (const DoctorCheck& check : checks) {
        Diagnosis diagnosis = Ask(check, patience);
        if (diagnosis.finding == Finding::kBad) {
            const std::string root = RootOf(check, roots);
            roots[check.name] = root.empty() ? check.name : root;
            if (!root.empty()) diagnosis = After(root, diagnosis);
        }
        answers.push_back({check.name, std::move(diagnosis)});
    }
    return answers;
}

std::string DoctorTable(const std::vector<DoctorAnswer>& answers) {
    std::size_t widest = 0;
    for (const DoctorAnswer& answer : answers) widest = std::max(widest, answer.name.size());
    std::string text;
    for (const auto& [name, diagnosis] : answers) {
        std::string verdict = ToString(diagnosis.finding);
        verdict.resize(9, ' ');
        text += verdict + name + std::string(widest + 2 - name.size(), ' ') +
                Shown(diagnosis.what) + '\n';
        if (!diagnosis.remedy.empty())
            text += std::string(11 + widest, ' ') + "-> " + Shown(diagnosis.remedy) + '\n';
    }
    return text;
}

std::string DoctorJson(const std::vector<DoctorAnswer>& answers) {
    using nlohmann::json;
    json checks = json::array();
    for (const auto& [name, diagnosis] : answers) {
        checks.push_back({{"check", name},
                          {"verdict", ToString(diagnosis.finding)},
                          {"what", diagnosis.what},
                          {"remedy", diagnosis.remedy}});
    }
    const json all{{"schema", 1}, {"ready", IsReady(answers)}, {"checks", checks}};
    return all.dump(2, ' ', false, json::error_handler_t::replace);
}

bool IsReady(const std::vector<DoctorAnswer>& answers) {
    return std::ranges::none_of(answers, [](const DoctorAnswer& answer) {
        return answer.diagnosis.finding == Finding::kBad;
    });
}

}  // namespace hitchview::app

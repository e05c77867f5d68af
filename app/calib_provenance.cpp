#include "app/calib_provenance.hpp"

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "app/report.hpp"

namespace hitchview::app {

std::string DateText() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32] = "";
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
    return text;
}

std::string WrittenBy(const std::string& command, const std::string& limits) {
    return command + ", " + DateText() + (limits.empty() ? "" : "; limits: " + limits);
}

std::string WriteFigures(nlohmann::json figures, const std::string& command,
                         const std::filesystem::path& file) {
    figures["command"] = command;
    figures["date"] = DateText();
    return WriteJson(figures, file);
}

}  // namespace hitchview::app

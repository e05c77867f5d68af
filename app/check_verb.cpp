#include "app/check_verb.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/exit_code.hpp"
#include "app/log_check.hpp"
#include "app/log_progress.hpp"
#include "app/log_repair.hpp"
#include "app/log_report.hpp"

namespace hitchview::app {
namespace {

hal::Checked<LogFigures> Measure(LogRecording& recording) {
    LogCheck check;
    LogProgress progress("reading");
    auto event = recording.Next();
    for (; event; event = recording.Next()) {
        check.Add(event.value());
        progress.Show(recording);
    }
    if (event.error() != hal::Error::kEndOfStream) return recording.failure();
    LogFigures figures = check.Figures();
    figures.segments = recording.segments();
    figures.bytes = recording.size_bytes();
    figures.damage = recording.damage();
    if (figures.events == 0) return std::string("no event of an LCM log is in it");
    return figures;
}

int Repair(LogRecording& recording, const CheckOptions& options) {
    std::error_code failed;
    if (std::filesystem::exists(options.repair, failed))
        return Fail(kWrongUse, options.repair.string() + ": exists already");
    const auto repaired = RepairLog(recording, options.repair);
    if (!repaired) return Fail(kMachineFailed, repaired.error());
    const drivers::LcmLogDamage damage = recording.damage();
    std::fprintf(options.json ? stderr : stdout,
                 "\n%s: %llu events, %llu bytes; left out %llu bytes in %llu places, at least %llu "
                 "events\n",
                 options.repair.c_str(), static_cast<unsigned long long>(repaired.value().events),
                 static_cast<unsigned long long>(repaired.value().bytes),
                 static_cast<unsigned long long>(damage.skipped_bytes),
                 static_cast<unsigned long long>(damage.places),
                 static_cast<unsigned long long>(damage.lost_events));
    return 0;
}

}  // namespace

int CheckVerb(const CheckOptions& options, const std::atomic<bool>& stop) {
    const auto files = LogFiles(options.logs);
    if (!files) return Fail(kWrongUse, files.error());
    LogRecording recording(files.value(), stop);
    const auto figures = Measure(recording);
    if (!figures) return Fail(kWrongUse, figures.error());
    const LogVerdict verdict = Judge(figures.value());
    const std::string answer = options.json ? LogReport(figures.value(), verdict).dump(2) + '\n'
                                            : LogTable(figures.value(), verdict);
    std::fputs(answer.c_str(), stdout);
    const int repaired = options.repair.empty() ? 0 : Repair(recording, options);
    if (repaired != 0) return repaired;
    return verdict.good() ? 0 : kBad;
}

}  // namespace hitchview::app

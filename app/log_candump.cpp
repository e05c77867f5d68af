#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>

#include "app/candump_writer.hpp"
#include "app/log_export.hpp"

namespace hitchview::app {
namespace {

using hal::Checked;
using hal::Done;

/// The name of an interface of Linux.
bool IsInterface(std::string_view name) {
    return !name.empty() && name.size() < 16 &&
           std::ranges::all_of(name, [](char c) { return c > ' ' && c < 0x7F; });
}

class CandumpExport final : public LogExport {
 public:
    explicit CandumpExport(const std::filesystem::path& file)
        : file_(file.string()), out_(file, std::ios::binary) {}

    [[nodiscard]] Checked<Done> Refusal() const {
        if (out_) return Done{};
        return file_ + ": cannot be written: " + std::strerror(errno);
    }

    Checked<Done> Add(const drivers::LcmLogEvent& event, drivers::LoggedKind kind) override {
        if (kind != drivers::LoggedKind::kCanFrame) return Done{};
        const auto logged = drivers::ParseLoggedCanFrame(event.data);
        if (!logged || !IsInterface(logged.value().bus)) {
            CountDamaged();
            return Done{};
        }
        out_ << LineOf(logged.value().bus).Format(logged.value().frame);
        CountWritten();
        return Refusal();
    }

    Checked<Done> Finish() override {
        out_.close();
        return Refusal();
    }

 private:
    CandumpLine& LineOf(std::string_view bus) {
        return lines_.try_emplace(std::string(bus), bus).first->second;
    }

    std::string file_;
    std::ofstream out_;
    std::map<std::string, CandumpLine> lines_;  ///< of each bus
};

}  // namespace

LogExportResult ExportCandump(const std::filesystem::path& file) {
    auto self = std::make_unique<CandumpExport>(file);
    if (auto refusal = self->Refusal(); !refusal) return refusal.error();
    return LogExportResult(std::move(self));
}

}  // namespace hitchview::app

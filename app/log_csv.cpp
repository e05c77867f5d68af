#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <numbers>

#include "app/log_export.hpp"
#include "app/log_time.hpp"

namespace hitchview::app {
namespace {

using hal::Checked;
using hal::Done;

constexpr const char* kHeader =
    "time,utime_us,sequence,capture_ns,latency_ms,spread_ms,cameras_missing,seam_left,seam_right,"
    "seam_matches_left,seam_matches_right,features_tractor,features_trailer,total_ms,"
    "deadline_misses,dropped,articulation_deg,articulation_sigma_deg,hitch_angle_deg\n";

class CsvExport final : public LogExport {
 public:
    explicit CsvExport(const std::filesystem::path& file)
        : file_(file.string()), out_(file, std::ios::binary) {
        out_ << kHeader << std::fixed;
    }

    [[nodiscard]] Checked<Done> Refusal() const {
        if (out_) return Done{};
        return file_ + ": cannot be written: " + std::strerror(errno);
    }

    Checked<Done> Add(const drivers::LcmLogEvent& event, drivers::LoggedKind kind) override {
        if (kind == drivers::LoggedKind::kHitchAngle) AddHitchAngle(event.data);
        if (kind == drivers::LoggedKind::kStatus) AddStatus(event.data);
        return Refusal();
    }

    Checked<Done> Finish() override {
        out_.close();
        return Refusal();
    }

 private:
    void AddHitchAngle(std::span<const std::uint8_t> message) {
        const auto logged = drivers::ParseLoggedHitchAngle(message);
        if (!logged) return CountDamaged();
        const bool valid = logged.value().angle.quality == hal::HitchAngleQuality::kValid;
        hitch_angle_rad_ = valid ? logged.value().angle.angle_rad : std::nan("");
    }

    void AddStatus(std::span<const std::uint8_t> message) {
        const auto logged = drivers::ParseLoggedStatus(message);
        if (!logged) return CountDamaged();
        const hal::PanoramaStatus& s = logged.value().status;
        out_ << UtcText(logged.value().utime_us) << ',' << logged.value().utime_us << ','
             << s.sequence << ',' << s.captured_from.count() << ',' << std::setprecision(3)
             << Milliseconds(s.published_at - s.captured_from) << ',' << Milliseconds(s.spread)
             << ",0x" << std::hex << s.cameras_missing << std::dec << ',' << ToString(s.seams[0])
             << ',' << ToString(s.seams[1]) << ',' << s.seam_matches[0] << ',' << s.seam_matches[1]
             << ',' << s.unit_features[0] << ',' << s.unit_features[1] << ',' << s.total_ms << ','
             << s.deadline_misses << ',' << s.dropped;
        for (const double rad : {s.articulation_rad, s.articulation_sigma_rad, hitch_angle_rad_})
            AppendDegrees(rad);
        out_ << '\n';
        CountWritten();
    }

    /// An empty cell for what is not known.
    void AppendDegrees(double rad) {
        out_ << ',' << std::setprecision(4);
        if (std::isfinite(rad)) out_ << rad * 180 / std::numbers::pi;
    }

    std::string file_;
    std::ofstream out_;
    double hitch_angle_rad_ = std::nan("");  ///< newest; not a number unless valid
};

}  // namespace

LogExportResult ExportCsv(const std::filesystem::path& file) {
    auto self = std::make_unique<CsvExport>(file);
    if (auto refusal = self->Refusal(); !refusal) return refusal.error();
    return LogExportResult(std::move(self));
}

}  // namespace hitchview::app

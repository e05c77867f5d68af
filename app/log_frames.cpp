#include <array>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "app/log_export.hpp"
#include "app/log_picture.hpp"

namespace hitchview::app {
namespace {

using hal::Checked;
using hal::Done;

std::string FrameName(std::uint64_t number, std::int64_t utime_us) {
    std::array<char, 64> name{};
    std::snprintf(name.data(), name.size(), "%06llu_%lld.png",
                  static_cast<unsigned long long>(number), static_cast<long long>(utime_us));
    return name.data();
}

class FramesExport final : public LogExport {
 public:
    FramesExport(std::filesystem::path folder, PictureChoice choice)
        : folder_(std::move(folder)), choice_(std::move(choice)) {}

    Checked<Done> Add(const drivers::LcmLogEvent& event, drivers::LoggedKind kind) override {
        if (!choice_.Means(event, kind)) return Done{};
        const auto image = drivers::ParseLoggedImage(event.data);
        const cv::Mat picture = image ? PictureOf(image.value()) : cv::Mat();
        if (picture.empty()) {
            CountDamaged();
            return Done{};
        }
        const auto file = folder_ / FrameName(written(), image.value().utime_us);
        if (!Write(file, picture)) return file.string() + ": cannot be written";
        CountWritten();
        return Done{};
    }

    Checked<Done> Finish() override { return Done{}; }

 private:
    static bool Write(const std::filesystem::path& file, const cv::Mat& picture) {
        try {
            return cv::imwrite(file, picture);
        } catch (const cv::Exception&) {
            return false;
        }
    }

    std::filesystem::path folder_;
    PictureChoice choice_;
};

}  // namespace

LogExportResult ExportFrames(const std::filesystem::path& folder, const PictureChoice& choice) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed) return folder.string() + ": cannot be made: " + failed.message();
    return LogExportResult(std::make_unique<FramesExport>(folder, choice));
}

}  // namespace hitchview::app

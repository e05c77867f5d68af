#include <algorithm>
#include <cmath>
#include <optional>

#include "app/ffmpeg_pipe.hpp"
#include "app/log_export.hpp"
#include "app/log_picture.hpp"
#include "app/log_time.hpp"

namespace hitchview::app {
namespace {

using hal::Checked;
using hal::Done;
using hal::Instant;

/// Which picture of a video at a constant rate a moment is.
class ConstantRate {
 public:
    explicit ConstantRate(double period_ms) : period_ms_(period_ms) {}

    /// How often the picture before has to be shown again until it is the turn of this one.
    std::int64_t Repeats(Instant at) {
        constexpr double kLongestStill_ms = 2000;
        const auto longest = static_cast<std::int64_t>(kLongestStill_ms / period_ms_);
        if (!start_) start_ = at;
        const std::int64_t turn = std::llround(Milliseconds(at - *start_) / period_ms_);
        const std::int64_t missing = turn - next_;
        const std::int64_t repeats = std::clamp<std::int64_t>(missing, 0, longest);
        // After a pause, or in a recording of another day, counting goes on from here.
        if (repeats < missing || missing < -longest)
            start_ = at - Instant(std::llround(1e6 * period_ms_) * (next_ + repeats));
        next_ += repeats + 1;
        return repeats;
    }

 private:
    double period_ms_;
    std::optional<Instant> start_;
    std::int64_t next_ = 0;
};

class Mp4Export final : public LogExport {
 public:
    Mp4Export(std::filesystem::path file, PictureChoice choice, double period_ms)
        : file_(std::move(file)),
          choice_(std::move(choice)),
          period_ms_(period_ms),
          rate_(period_ms) {}

    Checked<Done> Add(const drivers::LcmLogEvent& event, drivers::LoggedKind kind) override {
        if (!choice_.Means(event, kind)) return Done{};
        const auto image = drivers::ParseLoggedImage(event.data);
        const cv::Mat picture = image ? PictureOf(image.value()) : cv::Mat();
        if (picture.empty() || (!shown_.empty() && picture.size() != shown_.size())) {
            CountDamaged();
            return Done{};
        }
        if (auto started = Start(picture.size()); !started) return started;
        const Instant utime = std::chrono::microseconds(image.value().utime_us);
        return Show(picture, image.value().captured_at.value_or(utime));
    }

    Checked<Done> Finish() override {
        if (video_ == nullptr) return Done{};
        return video_->Finish();
    }

 private:
    Checked<Done> Start(cv::Size size_px) {
        if (video_ != nullptr) return Done{};
        auto video = FfmpegPipe::Start(file_, {.size_px = size_px, .rate_hz = 1000 / period_ms_});
        if (!video) return video.error();
        video_ = std::move(*video);
        return Done{};
    }

    Checked<Done> Show(const cv::Mat& picture, Instant at) {
        bool sent = true;
        for (std::int64_t n = rate_.Repeats(at); n > 0 && sent; --n)
            sent = video_->Append(shown_).ok();
        shown_ = picture;
        sent = sent && video_->Append(shown_).ok();
        if (!sent) return EndedEarly();
        CountWritten();
        return Done{};
    }

    Checked<Done> EndedEarly() {
        auto ended = video_->Finish();
        return ended ? file_.string() + ": ffmpeg ended too early" : ended;
    }

    std::filesystem::path file_;
    PictureChoice choice_;
    double period_ms_;
    ConstantRate rate_;
    cv::Mat shown_;
    std::unique_ptr<FfmpegPipe> video_;
};

}  // namespace

LogExportResult ExportMp4(const std::filesystem::path& file, const PictureChoice& choice,
                          double period_ms) {
    HV_EXPECT(period_ms > 0);
    return LogExportResult(std::make_unique<Mp4Export>(file, choice, period_ms));
}

}  // namespace hitchview::app

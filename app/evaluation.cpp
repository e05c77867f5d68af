#include "app/evaluation.hpp"

#include <chrono>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "app/evaluation_path.hpp"
#include "app/evaluation_seam.hpp"
#include "app/evaluation_view.hpp"
#include "drivers/replay_camera.hpp"

namespace hitchview::app {
namespace {

using algo::Overlap;
using algo::PerOverlap;
using algo::PerUnit;
using algo::Unit;
using nlohmann::json;

// One video's grey frames; without a path it has none and never ends.
class GreyVideo {
 public:
    hal::Checked<hal::Done> Open(const std::string& path) {
        path_ = path;
        if (path.empty()) return hal::Done{};
        auto camera = drivers::ReplayCamera::Open(path, {.name = "eval"});
        if (!camera) return camera.error();
        camera_ = std::move(*camera);
        return hal::Done{};
    }

    /// False at the end.
    hal::Checked<bool> Next() {
        if (!camera_) return true;
        auto frame = camera_->WaitFrame(std::chrono::minutes(1));
        if (frame) {
            lease_ = std::move(*frame);
            return true;
        }
        if (frame.error() == hal::Error::kEndOfStream) return false;
        return path_ + ": " + ToString(frame.error());
    }

    [[nodiscard]] bool known() const { return camera_ != nullptr; }
    [[nodiscard]] double rate_hz() const { return camera_->rate_hz(); }
    /// Borrowed until Next.
    [[nodiscard]] cv::Mat grey() const {
        const hal::FrameView& view = lease_.view();
        return {view.format.height_px, view.format.width_px, CV_8U,
                const_cast<std::uint8_t*>(view.planes[0].data),
                static_cast<std::size_t>(view.planes[0].stride_bytes)};
    }

 private:
    std::string path_;
    std::unique_ptr<drivers::ReplayCamera> camera_;
    hal::FrameLease lease_;  ///< dies before its camera
};

json Known(const std::optional<double>& maybe_value) {
    return maybe_value ? json(*maybe_value) : json(nullptr);
}

class UnitEvaluation {
 public:
    hal::Checked<hal::Done> Open(const UnitVideos& videos) {
        if (auto opened = in_.Open(videos.in); !opened) return opened;
        return out_.Open(videos.out);
    }
    hal::Checked<bool> Next() {
        auto more = in_.Next();
        return more && *more ? out_.Next() : more;
    }
    [[nodiscard]] bool known() const { return in_.known() || out_.known(); }
    [[nodiscard]] const GreyVideo& out() const { return out_; }

    void Measure(bool matched) {
        if (in_.known()) in_path_.Append(in_.grey());
        if (out_.known()) out_path_.Append(out_.grey());
        if (in_.known() && out_.known() && matched) view_.Append(in_.grey(), out_.grey());
    }

    [[nodiscard]] json Report() const {
        const PathScores in = in_path_.Scores();
        const PathScores out = out_path_.Scores();
        const ViewScores view = view_.Scores();
        const auto jitter_ratio =
            in_.known() ? JitterRatio(out_path_, in_path_, in_.rate_hz()) : std::nullopt;
        return {{"cropping_mean", Known(view.cropping_mean)},
                {"cropping_min", Known(view.cropping_min)},
                {"distortion_min", Known(view.distortion_min)},
                {"distortion_p01", Known(view.distortion_p01)},
                {"distortion_eigen_min", Known(view.distortion_eigen_min)},
                {"stability", Known(out.stability)},
                {"stability_in", Known(in.stability)},
                {"stability_detrended", Known(out.stability_detrended)},
                {"stability_frames", out.stability_frames},
                {"jitter_ratio", Known(jitter_ratio)},
                {"jerk_in_px", Known(in.jerk_px)},
                {"jerk_out_px", Known(out.jerk_px)},
                {"rot_jerk_out_rad", Known(out.rot_jerk_rad)},
                {"frames_unmatched", view.frames_failed},
                {"frames_lost", out_path_.lost()},
                {"frames_repeated", out_path_.repeated()}};
    }

 private:
    GreyVideo in_;
    GreyVideo out_;
    PathMeter in_path_;
    PathMeter out_path_;
    ViewMeter view_;
};

class Evaluation {
 public:
    hal::Checked<hal::Done> Open(const EvaluationOptions& options) {
        for (const Unit unit : algo::kUnits) {
            if (auto opened = units_[unit].Open(options.units[unit]); !opened) return opened;
        }
        return panorama_.Open(options.panorama);
    }

    hal::Checked<bool> Next() {
        for (UnitEvaluation& unit : units_.of) {
            auto more = unit.Next();
            if (!more || !*more) return more;
        }
        return panorama_.Next();
    }

    hal::Checked<hal::Done> Measure(bool matched) {
        ++frames_;
        for (UnitEvaluation& unit : units_.of) unit.Measure(matched);
        if (panorama_.known()) panorama_path_.Append(panorama_.grey());
        return matched ? MeasureSeams() : hal::Done{};
    }

    [[nodiscard]] json Report() const {
        json report{{"frames", frames_}, {"units", json::object()}, {"seams", json::object()}};
        for (const Unit unit : algo::kUnits) {
            if (units_[unit].known()) report["units"][ToString(unit)] = units_[unit].Report();
        }
        for (const Overlap overlap : algo::kOverlaps) {
            report["seams"][ToString(overlap)] = ReportSeam(seams_[overlap].Scores());
        }
        const PathScores panorama = panorama_path_.Scores();
        report["panorama"] = {{"stability", Known(panorama.stability)},
                              {"jerk_px", Known(panorama.jerk_px)}};
        return report;
    }

 private:
    hal::Checked<hal::Done> MeasureSeams() {
        const GreyVideo& tractor = units_[Unit::kTractor].out();
        const GreyVideo& trailer = units_[Unit::kTrailer].out();
        if (!tractor.known() || !trailer.known()) return hal::Done{};
        if (tractor.grey().size() != trailer.grey().size()) {
            return std::string(
                "the tractor's and the trailer's output differ in size: not one canvas");
        }
        const PerOverlap<cv::Mat> masks = OverlapMasks(tractor.grey(), trailer.grey());
        for (const Overlap overlap : algo::kOverlaps) {
            seams_[overlap].Append(tractor.grey(), trailer.grey(), masks[overlap]);
        }
        return hal::Done{};
    }

    static json ReportSeam(const SeamScores& seam) {
        return {{"median_px", Known(seam.median_px)},
                {"p95_px", Known(seam.p95_px)},
                {"worst_frame_px", Known(seam.worst_frame_px)},
                {"horizontal_median_px", Known(seam.horizontal_median_px)},
                {"vertical_median_px", Known(seam.vertical_median_px)},
                {"measured_share", Known(seam.measured_share)},
                {"locked_share", nullptr}};
    }

    PerUnit<UnitEvaluation> units_;
    GreyVideo panorama_;
    PathMeter panorama_path_;
    PerOverlap<SeamMeter> seams_;
    int frames_ = 0;
};

hal::Checked<json> Run(const EvaluationOptions& options) {
    Evaluation evaluation;
    if (auto opened = evaluation.Open(options); !opened) return opened.error();
    for (int frame = 0;; ++frame) {
        const auto more = evaluation.Next();
        if (!more) return more.error();
        if (!more.value()) break;
        const auto measured = evaluation.Measure(frame % options.step == 0);
        if (!measured) return measured.error();
        options.progress(frame + 1);
    }
    return evaluation.Report();
}

bool AnyVideo(const EvaluationOptions& options) {
    bool any = !options.panorama.empty();
    for (const UnitVideos& unit : options.units.of) any |= !unit.in.empty() || !unit.out.empty();
    return any;
}

}  // namespace

hal::Checked<json> Evaluate(const EvaluationOptions& options) {
    HV_EXPECT(options.step >= 1);
    if (!AnyVideo(options)) return std::string("no video to evaluate");
    try {
        return Run(options);
    } catch (const cv::Exception& exception) {
        return std::string("evaluation failed: ") + exception.what();
    }
}

}  // namespace hitchview::app

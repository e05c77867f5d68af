#include "app/evaluation.hpp"

#include <chrono>
#include <memory>
#include <opencv2/core.hpp>
#include <utility>

#include "app/evaluation_figures.hpp"
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

class UnitEvaluation {
 public:
    hal::Checked<hal::Done> Open(const UnitVideos& videos) {
        if (auto opened = in_.Open(videos.in); !opened) return opened;
        if (auto opened = out_.Open(videos.out); !opened) return opened;
        if (known()) meters_.rate_hz = in_.known() ? in_.rate_hz() : out_.rate_hz();
        return hal::Done{};
    }
    hal::Checked<bool> Next() {
        auto more = in_.Next();
        return more && *more ? out_.Next() : more;
    }
    [[nodiscard]] bool known() const { return in_.known() || out_.known(); }
    [[nodiscard]] const GreyVideo& out() const { return out_; }
    [[nodiscard]] const UnitMeters& meters() const { return meters_; }

    void Measure(int frame, bool matched) {
        if (in_.known()) meters_.in.Append(in_.grey());
        if (out_.known()) meters_.out.Append(out_.grey());
        if (in_.known() && out_.known() && matched) {
            meters_.view.Append(in_.grey(), out_.grey(), frame);
        }
    }

 private:
    GreyVideo in_;
    GreyVideo out_;
    UnitMeters meters_;
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
        const int frame = frames_++;
        for (UnitEvaluation& unit : units_.of) unit.Measure(frame, matched);
        if (panorama_.known()) panorama_path_.Append(panorama_.grey());
        if (panorama_.known() && matched) coverage_.Append(panorama_.grey(), frame);
        return matched ? MeasureSeams(frame) : hal::Done{};
    }

    [[nodiscard]] Quality Report() const {
        Quality quality{.figures = Figures()};
        quality.figures["series"] = Series();
        for (const Unit unit : algo::kUnits) {
            quality.worst_views[unit] = units_[unit].meters().view.worst();
        }
        for (const Overlap overlap : algo::kOverlaps) {
            quality.worst_seams[overlap] = seams_[overlap].worst();
        }
        return quality;
    }

 private:
    hal::Checked<hal::Done> MeasureSeams(int frame) {
        const GreyVideo& tractor = units_[Unit::kTractor].out();
        const GreyVideo& trailer = units_[Unit::kTrailer].out();
        if (!tractor.known() || !trailer.known()) return hal::Done{};
        if (tractor.grey().size() != trailer.grey().size()) {
            return std::string(
                "the tractor's and the trailer's output differ in size: not one canvas");
        }
        const PerOverlap<cv::Mat> masks = OverlapMasks(tractor.grey(), trailer.grey());
        for (const Overlap overlap : algo::kOverlaps) {
            seams_[overlap].Append(tractor.grey(), trailer.grey(), masks[overlap], frame);
        }
        return hal::Done{};
    }

    [[nodiscard]] json Figures() const {
        json figures{{"frames", frames_}, {"units", json::object()}, {"seams", json::object()}};
        for (const Unit unit : algo::kUnits) {
            if (!units_[unit].known()) continue;
            figures["units"][ToString(unit)] = UnitFigures(units_[unit].meters());
        }
        for (const Overlap overlap : algo::kOverlaps) {
            figures["seams"][ToString(overlap)] = SeamFigures(seams_[overlap]);
        }
        figures["panorama"] = PanoramaFigures(panorama_path_, coverage_);
        return figures;
    }

    [[nodiscard]] json Series() const {
        json series{{"units", json::object()}, {"seams", json::object()}, {"rate_hz", RateHz()}};
        for (const Unit unit : algo::kUnits) {
            if (!units_[unit].known()) continue;
            series["units"][ToString(unit)] = UnitSeries(units_[unit].meters());
        }
        for (const Overlap overlap : algo::kOverlaps) {
            series["seams"][ToString(overlap)] = SeamSeries(seams_[overlap]);
        }
        series["panorama"] = CoverageSeries(coverage_);
        return series;
    }

    [[nodiscard]] double RateHz() const {
        for (const UnitEvaluation& unit : units_.of) {
            if (unit.known()) return unit.meters().rate_hz;
        }
        return panorama_.rate_hz();
    }

    PerUnit<UnitEvaluation> units_;
    GreyVideo panorama_;
    PathMeter panorama_path_;
    CoverageMeter coverage_;
    PerOverlap<SeamMeter> seams_;
    int frames_ = 0;
};

json Recordings(const EvaluationOptions& options) {
    json recordings{{"units", json::object()}};
    for (const Unit unit : algo::kUnits) {
        const auto& [in, out] = options.units[unit];
        if (!in.empty()) recordings["units"][ToString(unit)]["in"] = in;
        if (!out.empty()) recordings["units"][ToString(unit)]["out"] = out;
    }
    if (!options.panorama.empty()) recordings["panorama"] = options.panorama;
    return recordings;
}

hal::Checked<Quality> Run(const EvaluationOptions& options) {
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
    Quality quality = evaluation.Report();
    quality.figures["recordings"] = Recordings(options);
    quality.figures["series"]["step"] = options.step;
    return quality;
}

bool AnyVideo(const EvaluationOptions& options) {
    bool any = !options.panorama.empty();
    for (const UnitVideos& unit : options.units.of) any |= !unit.in.empty() || !unit.out.empty();
    return any;
}

}  // namespace

hal::Checked<Quality> Evaluate(const EvaluationOptions& options) {
    HV_EXPECT(options.step >= 1);
    if (!AnyVideo(options)) return std::string("no video to evaluate");
    try {
        return Run(options);
    } catch (const cv::Exception& exception) {
        return std::string("evaluation failed: ") + exception.what();
    }
}

}  // namespace hitchview::app

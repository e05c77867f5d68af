#include "app/evaluation_figures.hpp"

#include <cmath>
#include <optional>

#include "app/evaluation_statistics.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

json Known(const std::optional<double>& maybe_value) {
    return maybe_value ? json(*maybe_value) : json(nullptr);
}

// Series are for looking at: six digits behind the point, so that the file stays readable.
json Rounded(const std::vector<double>& values) {
    json rounded = json::array();
    for (const double value : values) rounded.push_back(std::round(value * 1e6) / 1e6);
    return rounded;
}

template <typename Record>
json Column(const std::vector<Record>& records, double Record::*member) {
    return Rounded(Collect(records, member));
}

// Where the picture went, by component, and how it shakes.
json PathSeries(const PathMeter& meter, double rate_hz) {
    std::vector<double> x_px;
    std::vector<double> y_px;
    std::vector<double> rotation_rad;
    for (const cv::Vec3d& pose : meter.path()) {
        x_px.push_back(pose[0]);
        y_px.push_back(pose[1]);
        rotation_rad.push_back(pose[2]);
    }
    const Spectrum spectrum = ShakeSpectrum(meter.path(), rate_hz);
    return {{"x_px", Rounded(x_px)},
            {"y_px", Rounded(y_px)},
            {"rotation_rad", Rounded(rotation_rad)},
            {"spectrum",
             {{"hz", Rounded(spectrum.hz)}, {"amplitude_px", Rounded(spectrum.amplitude_px)}}}};
}

json WarpSeries(const std::vector<WarpFigures>& frames) {
    return {{"cropping", Column(frames, &WarpFigures::cropping)},
            {"distortion", Column(frames, &WarpFigures::distortion)},
            {"distortion_eigen", Column(frames, &WarpFigures::distortion_eigen)}};
}

json SlowFigures(const SlowShares& shares) {
    return {{"translation", Known(shares.translation)}, {"rotation", Known(shares.rotation)}};
}

json PaperFigures(const PathScores& in, const PathScores& out, const ViewScores& view) {
    return {{"cropping", Known(view.picture_cropping_mean)},
            {"distortion", Known(view.picture_distortion_eigen_min)},
            {"stability", Known(out.stability.Mean())},
            {"stability_in", Known(in.stability.Mean())}};
}

}  // namespace

json UnitFigures(const UnitMeters& meters) {
    const PathScores in = meters.in.Scores();
    const PathScores out = meters.out.Scores();
    const ViewScores view = meters.view.Scores();
    return {{"cropping_mean", Known(view.cropping_mean)},
            {"cropping_min", Known(view.cropping_min)},
            {"distortion_min", Known(view.distortion_min)},
            {"distortion_p01", Known(view.distortion_p01)},
            {"distortion_eigen_min", Known(view.distortion_eigen_min)},
            {"kept_mean", Known(view.kept_mean)},
            {"kept_min", Known(view.kept_min)},
            {"stability", Known(out.stability.Smaller())},
            {"stability_in", Known(in.stability.Smaller())},
            {"stability_parts", SlowFigures(out.stability)},
            {"stability_detrended", Known(out.stability_detrended.Smaller())},
            {"stability_detrended_in", Known(in.stability_detrended.Smaller())},
            {"stability_detrended_parts", SlowFigures(out.stability_detrended)},
            {"stability_frames", out.stability_frames},
            {"jitter_ratio", Known(JitterRatio(meters.out, meters.in, meters.rate_hz))},
            {"jerk_in_px", Known(in.jerk_px)},
            {"jerk_out_px", Known(out.jerk_px)},
            {"rot_jerk_in_rad", Known(in.rot_jerk_rad)},
            {"rot_jerk_out_rad", Known(out.rot_jerk_rad)},
            {"frames_unmatched", view.frames_failed},
            {"frames_lost", meters.out.lost()},
            {"frames_repeated", meters.out.repeated()},
            {"paper", PaperFigures(in, out, view)}};
}

json SeamFigures(const SeamMeter& meter) {
    const SeamScores seam = meter.Scores();
    return {{"median_px", Known(seam.median_px)},
            {"p95_px", Known(seam.p95_px)},
            {"worst_frame_px", Known(seam.worst_frame_px)},
            {"horizontal_median_px", Known(seam.horizontal_median_px)},
            {"horizontal_p95_px", Known(seam.horizontal_p95_px)},
            {"vertical_median_px", Known(seam.vertical_median_px)},
            {"vertical_p95_px", Known(seam.vertical_p95_px)},
            {"measured_share", Known(seam.measured_share)},
            {"locked_share", nullptr},
            {"paper", {{"stitching_score_px", Known(seam.worst_frame_px)}}}};
}

json PanoramaFigures(const PathMeter& path, const CoverageMeter& coverage) {
    const PathScores scores = path.Scores();
    const std::vector<double> shares = Collect(coverage.frames(), &CoverageFrame::share);
    return {{"stability", Known(scores.stability.Smaller())},
            {"jerk_px", Known(scores.jerk_px)},
            {"coverage_mean", Known(Mean(shares))},
            {"coverage_min", Known(Quantile(shares, 0))},
            {"common_rectangle_share", Known(coverage.CommonRectangleShare())}};
}

json UnitSeries(const UnitMeters& meters) {
    const std::vector<ViewFrame>& frames = meters.view.frames();
    json view = WarpSeries(Collect(frames, &ViewFrame::plane));
    view["frame"] = Collect(frames, &ViewFrame::frame);
    view["kept"] = Column(frames, &ViewFrame::kept);
    view["picture"] = WarpSeries(Collect(frames, &ViewFrame::picture));
    return {{"in", PathSeries(meters.in, meters.rate_hz)},
            {"out", PathSeries(meters.out, meters.rate_hz)},
            {"view", view}};
}

json SeamSeries(const SeamMeter& meter) {
    const std::vector<SeamFrame>& frames = meter.frames();
    return {{"frame", Collect(frames, &SeamFrame::frame)},
            {"pairs", Collect(frames, &SeamFrame::pairs)},
            {"mean_px", Column(frames, &SeamFrame::mean_px)},
            {"p95_px", Column(frames, &SeamFrame::p95_px)}};
}

json CoverageSeries(const CoverageMeter& coverage) {
    return {{"frame", Collect(coverage.frames(), &CoverageFrame::frame)},
            {"coverage", Column(coverage.frames(), &CoverageFrame::share)}};
}

}  // namespace hitchview::app

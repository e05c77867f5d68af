#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "app/evaluation.hpp"
#include "app/evaluation_path.hpp"
#include "app/evaluation_seam.hpp"
#include "app/evaluation_statistics.hpp"
#include "app/evaluation_view.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview::app {
namespace {

using algo::Overlap;
using algo::Unit;

constexpr int kFrames = 60;
constexpr double kRateHz = 30;
const cv::Size kView{320, 240};

// Where the picture is in a frame: shift of the centre and rotation about it.
struct Pose {
    double x_px = 0;
    double y_px = 0;
    double angle_rad = 0;
};

// A view of a large texture. H_view_world: texture px to view px.
cv::Mat Look(const cv::Mat& world, const cv::Matx33d& H_view_world, cv::Size size = kView) {
    cv::Mat view;
    cv::warpPerspective(world, view, H_view_world, size, cv::INTER_CUBIC);
    return view;
}

cv::Matx33d Shift(double x_px, double y_px) {
    return {1, 0, x_px, 0, 1, y_px, 0, 0, 1};
}

cv::Mat LookFrom(const cv::Mat& world, const Pose& pose) {
    const double c = std::cos(pose.angle_rad);
    const double s = std::sin(pose.angle_rad);
    const cv::Matx33d turn(c, -s, 0, s, c, 0, 0, 0, 1);
    return Look(world, Shift(kView.width / 2.0 + pose.x_px, kView.height / 2.0 + pose.y_px) * turn *
                           Shift(-world.cols / 2.0, -world.rows / 2.0));
}

double Wave(int frame, double hz) {
    return std::sin(2 * std::numbers::pi * hz * frame / kRateHz);
}

PathMeter Measure(const std::function<Pose(int)>& pose) {
    const cv::Mat world = tests::Texture({480, 400}, 7);
    PathMeter meter;
    for (int i = 0; i < kFrames; ++i) meter.Append(LookFrom(world, pose(i)));
    return meter;
}

double RmsSecondDifference(const std::function<double(int)>& signal) {
    double sum = 0;
    for (int i = 2; i < kFrames; ++i) {
        sum += std::pow(signal(i) - 2 * signal(i - 1) + signal(i - 2), 2);
    }
    return std::sqrt(sum / (kFrames - 2));
}

TEST(PathMeterTest, AStillVideoHasNoJerk) {
    const PathMeter meter = Measure([](int) { return Pose{}; });
    EXPECT_LT(meter.Scores().jerk_px.value(), 1e-6);
    EXPECT_LT(meter.Scores().rot_jerk_rad.value(), 1e-9);
    EXPECT_FALSE(meter.Scores().stability.Mean());
    EXPECT_EQ(meter.repeated(), kFrames - 1);
    EXPECT_EQ(meter.lost(), 0);
}

TEST(PathMeterTest, AKnownShakeHasItsJerk) {
    const PathMeter meter =
        Measure([](int i) { return Pose{.x_px = 4 * Wave(i, 5), .y_px = 3 * Wave(i, 3.3)}; });
    const double x = RmsSecondDifference([](int i) { return 4 * Wave(i, 5); });
    const double y = RmsSecondDifference([](int i) { return 3 * Wave(i, 3.3); });
    EXPECT_NEAR(meter.Scores().jerk_px.value(), std::hypot(x, y), 0.03 * std::hypot(x, y));
    EXPECT_LT(meter.Scores().rot_jerk_rad.value(), 3e-4);
}

TEST(PathMeterTest, AKnownTurnHasItsRotationAndLeavesTheCentreAlone) {
    const auto angle_rad = [](int i) { return 0.02 * Wave(i, 4); };
    const PathMeter meter = Measure([&](int i) { return Pose{.angle_rad = angle_rad(i)}; });
    const double expected = RmsSecondDifference(angle_rad);
    EXPECT_NEAR(meter.Scores().rot_jerk_rad.value(), expected, 0.03 * expected);
    EXPECT_LT(meter.Scores().jerk_px.value(), 0.1);
    for (int i = 0; i < kFrames; ++i) {
        EXPECT_NEAR(meter.path()[static_cast<std::size_t>(i)][2], angle_rad(i), 1e-3) << i;
    }
}

TEST(PathMeterTest, ASwayIsStableAndATrembleIsNot) {
    const auto stability = [](double hz) {
        const PathMeter meter = Measure(
            [&](int i) { return Pose{.x_px = 6 * Wave(i, hz), .angle_rad = 0.01 * Wave(i, hz)}; });
        return meter.Scores();
    };
    const PathScores sway = stability(1.0);  // bin 2 of 60 frames
    EXPECT_GT(sway.stability.Smaller().value(), 0.97);
    EXPECT_GT(sway.stability_detrended.Smaller().value(), 0.97);
    EXPECT_EQ(sway.stability_frames, kFrames);
    EXPECT_LT(stability(6.0).stability.Smaller().value(), 0.1);
}

TEST(PathMeterTest, HalfTheShakeIsHalfTheJitter) {
    const auto shaken = [](double size_px) {
        return Measure([=](int i) {
            return Pose{.x_px = 3 * Wave(i, 0.5) + size_px * Wave(i, 4),
                        .y_px = size_px * Wave(i, 5)};
        });
    };
    EXPECT_NEAR(JitterRatio(shaken(2), shaken(4), kRateHz).value(), 0.5, 0.02);
    EXPECT_FALSE(JitterRatio(shaken(2), Measure([](int) { return Pose{}; }), kRateHz));
}

TEST(PathMeterTest, TheSpectrumHasAShakesAmplitudeAtItsFrequency) {
    const PathMeter meter = Measure([](int i) { return Pose{.x_px = 4 * Wave(i, 5)}; });
    const Spectrum spectrum = ShakeSpectrum(meter.path(), kRateHz);
    const auto peak = std::ranges::max_element(spectrum.amplitude_px);
    EXPECT_NEAR(*peak, 4, 0.1);
    EXPECT_NEAR(spectrum.hz[static_cast<std::size_t>(peak - spectrum.amplitude_px.begin())], 5,
                0.01);
}

TEST(PathMeterTest, TheSameVideoGivesTheSameFiguresToTheLastBit) {
    const auto pose = [](int i) { return Pose{.x_px = 4 * Wave(i, 5)}; };
    EXPECT_EQ(Measure(pose).path(), Measure(pose).path());
}

TEST(PathMeterTest, TooFewFramesGiveNoFigures) {
    PathMeter meter;
    meter.Append(tests::Texture(kView, 1));
    EXPECT_FALSE(meter.Scores().jerk_px);
    EXPECT_FALSE(meter.Scores().stability.Mean());
}

ViewScores MeasureView(const cv::Matx33d& H_out_in, cv::Size out_size) {
    const cv::Mat in = tests::Texture(kView, 3);
    ViewMeter meter;
    meter.Append(in, Look(in, H_out_in, out_size), 0);
    return meter.Scores();
}

TEST(ViewMeterTest, PlacingAViewOnALargerCanvasCropsAndDistortsNothing) {
    const ViewScores scores = MeasureView(Shift(200.4, 31.7), {700, 320});
    EXPECT_NEAR(scores.cropping_mean.value(), 1, 0.002);
    EXPECT_NEAR(scores.distortion_min.value(), 1, 0.003);
    EXPECT_EQ(scores.frames_failed, 0);
}

TEST(ViewMeterTest, AnEnlargementIsCropping) {
    const ViewScores scores = MeasureView({1.25, 0, -40, 0, 1.25, -30, 0, 0, 1}, kView);
    EXPECT_NEAR(scores.cropping_mean.value(), 0.8, 0.002);
    EXPECT_NEAR(scores.cropping_min.value(), 0.8, 0.002);
    EXPECT_NEAR(scores.distortion_min.value(), 1, 0.003);
}

TEST(ViewMeterTest, AStretchIsDistortionInBothForms) {
    const ViewScores scores = MeasureView({1.1, 0, -16, 0, 1, 0, 0, 0, 1}, kView);
    EXPECT_NEAR(scores.distortion_min.value(), 1 / 1.1, 0.003);
    EXPECT_NEAR(scores.distortion_p01.value(), 1 / 1.1, 0.003);
    EXPECT_NEAR(scores.distortion_eigen_min.value(), 1 / 1.1, 0.003);
}

TEST(ViewMeterTest, AShearHasNoEigenvalueDistortionButASingularOne) {
    const ViewScores scores = MeasureView({1, 0.1, -12, 0, 1, 0, 0, 0, 1}, kView);
    const double expected = std::pow((std::sqrt(4 + 0.01) - 0.1) / 2, 2);
    EXPECT_NEAR(scores.distortion_min.value(), expected, 0.003);
    EXPECT_GT(scores.distortion_eigen_min.value(), 0.97);
}

TEST(ViewMeterTest, WhatIsShiftedOffTheCanvasIsNotKept) {
    EXPECT_NEAR(MeasureView(Shift(kView.width / 4.0, 0), kView).kept_min.value(), 0.75, 0.003);
    EXPECT_NEAR(MeasureView(Shift(200, 40), {700, 320}).kept_min.value(), 1, 0.003);
}

TEST(ViewMeterTest, TheWorstViewIsTheMostStretchedOne) {
    const cv::Mat in = tests::Texture(kView, 3);
    ViewMeter meter;
    for (const double stretch : {1.0, 1.1, 1.05}) {
        const cv::Matx33d H(stretch, 0, 0, 0, 1, 0, 0, 0, 1);
        meter.Append(in, Look(in, H), 10 + static_cast<int>(meter.frames().size()));
    }
    EXPECT_EQ(meter.worst().figures.frame, 11);
    EXPECT_NEAR(meter.worst().H_out_in(0, 0), 1.1, 0.003);
}

TEST(ViewMeterTest, UnrelatedPicturesAreNotMeasured) {
    ViewMeter meter;
    meter.Append(tests::Texture(kView, 3), cv::Mat::zeros(kView, CV_8U), 0);
    EXPECT_FALSE(meter.Scores().cropping_mean);
    EXPECT_EQ(meter.Scores().frames_failed, 1);
}

// Tractor in the middle of the canvas, trailer on both sides of it, black elsewhere.
struct Layers {
    cv::Mat tractor = cv::Mat::zeros(240, 640, CV_8U);
    cv::Mat trailer = cv::Mat::zeros(240, 640, CV_8U);

    Layers(cv::Point2d left_error_px, cv::Point2d right_error_px) {
        const cv::Mat world = tests::Texture(tractor.size(), 11);
        const auto copy = [&](const cv::Range& columns, cv::Point2d error_px, cv::Mat& layer) {
            const cv::Mat shifted = Look(world, Shift(error_px.x, error_px.y), world.size());
            shifted.colRange(columns).copyTo(layer.colRange(columns));
        };
        copy({150, 490}, {}, tractor);
        copy({0, 270}, left_error_px, trailer);
        copy({370, 640}, right_error_px, trailer);
    }
};

TEST(SeamMeterTest, EachOverlapHasItsOwnError) {
    const Layers layers({-3, 4}, {1.5, 0});
    const auto masks = OverlapMasks(layers.tractor, layers.trailer);
    algo::PerOverlap<SeamMeter> meters;
    for (const Overlap overlap : algo::kOverlaps) {
        meters[overlap].Append(layers.tractor, layers.trailer, masks[overlap], 0);
    }
    const SeamScores left = meters[Overlap::kLeft].Scores();
    EXPECT_NEAR(left.median_px.value(), 5, 0.15);
    EXPECT_NEAR(left.horizontal_median_px.value(), 3, 0.1);
    EXPECT_NEAR(left.vertical_median_px.value(), 4, 0.1);
    EXPECT_NEAR(left.p95_px.value(), 5, 0.5);
    EXPECT_NEAR(meters[Overlap::kRight].Scores().median_px.value(), 1.5, 0.1);
    EXPECT_EQ(left.measured_share, 1);
}

TEST(SeamMeterTest, TheWorstFrameIsTheWorstMean) {
    SeamMeter meter;
    for (const double error_px : {0.5, 6.0, 1.0}) {
        const Layers layers({0, 0}, {error_px, 0});
        const auto masks = OverlapMasks(layers.tractor, layers.trailer);
        meter.Append(layers.tractor, layers.trailer, masks[Overlap::kRight], 0);
    }
    EXPECT_NEAR(meter.Scores().worst_frame_px.value(), 6, 0.2);
    const WorstSeam& worst = meter.worst();
    EXPECT_NEAR(worst.figures.mean_px, 6, 0.2);
    ASSERT_GE(worst.pairs.size(), 12U);
    EXPECT_NEAR(worst.pairs.second[0].x - worst.pairs.first[0].x, 6, 0.5);
    EXPECT_LT(worst.pairs.first[0].x, static_cast<float>(worst.tractor_grey.cols));
}

TEST(SeamMeterTest, WithoutAnOverlapNothingIsKnown) {
    const Layers layers({}, {});
    SeamMeter meter;
    meter.Append(layers.tractor, layers.trailer, cv::Mat::zeros(layers.tractor.size(), CV_8U), 0);
    EXPECT_FALSE(meter.Scores().median_px);
    EXPECT_EQ(meter.Scores().measured_share, 0);
    EXPECT_FALSE(SeamMeter().Scores().measured_share);
}

TEST(EvaluationStatisticsTest, QuantilesLieBetweenTheValues) {
    EXPECT_EQ(Quantile({4, 1, 3, 2}, 0), 1);
    EXPECT_EQ(Quantile({4, 1, 3, 2}, 0.5), 2.5);
    EXPECT_EQ(Quantile({4, 1, 3, 2}, 1), 4);
    EXPECT_FALSE(Quantile({}, 0.5));
}

std::string WriteVideo(const std::string& path, double shake_px, int frames) {
    const cv::Mat world = tests::Texture({480, 400}, 7);
    cv::VideoWriter writer(path, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           kRateHz, kView);
    for (int i = 0; i < frames; ++i) {
        cv::Mat bgr;
        const cv::Mat grey = LookFrom(world, {.x_px = shake_px * Wave(i, 5)});
        cv::cvtColor(grey, bgr, cv::COLOR_GRAY2BGR);
        writer.write(bgr);
    }
    return path;
}

TEST(EvaluateTest, OneUnitGivesItsFiguresAndNullForWhatCannotBeKnown) {
    const tests::TemporaryFolder folder;
    EvaluationOptions options{.step = 10};
    options.units[Unit::kTractor] = {.in = WriteVideo(folder / "in.avi", 4, 50),
                                     .out = WriteVideo(folder / "out.avi", 1, 48)};
    const auto evaluated = Evaluate(options);
    ASSERT_TRUE(evaluated) << evaluated.error();
    const nlohmann::json& report = evaluated.value().figures;
    const nlohmann::json& tractor = report["units"]["tractor"];
    EXPECT_EQ(report["frames"], 48);
    EXPECT_NEAR(tractor["jitter_ratio"].get<double>(), 0.25, 0.02);
    EXPECT_NEAR(tractor["cropping_mean"].get<double>(), 1, 0.003);
    EXPECT_NEAR(tractor["jerk_in_px"].get<double>() / tractor["jerk_out_px"].get<double>(), 4, 0.3);
    EXPECT_FALSE(report["units"].contains("trailer"));
    EXPECT_NEAR(tractor["paper"]["cropping"].get<double>(), 1, 0.003);
    EXPECT_GT(tractor["paper"]["distortion"].get<double>(), 0.99);
    EXPECT_LT(tractor["paper"]["stability"].get<double>(), 0.2);
    const nlohmann::json& series = report["series"]["units"]["tractor"];
    EXPECT_EQ(series["view"]["frame"], nlohmann::json({0, 10, 20, 30, 40}));
    EXPECT_EQ(series["view"]["picture"]["distortion"].size(), 5U);
    ASSERT_EQ(series["in"]["x_px"].size(), 48U);
    EXPECT_NEAR(series["in"]["x_px"][2].get<double>(), 4 * Wave(2, 5), 0.1);
    EXPECT_NEAR(series["out"]["x_px"][2].get<double>(), 1 * Wave(2, 5), 0.1);
    EXPECT_TRUE(report["seams"]["left"]["median_px"].is_null());
    EXPECT_TRUE(report["seams"]["right"]["locked_share"].is_null());
    EXPECT_TRUE(report["panorama"]["stability"].is_null());
}

TEST(EvaluateTest, LayersWithAKnownOffsetHaveItAsStitchingScore) {
    const tests::TemporaryFolder folder;
    EvaluationOptions options;
    for (const Unit unit : algo::kUnits) {
        options.units[unit].out = folder / std::string(ToString(unit)) + ".avi";
        cv::VideoWriter writer(options.units[unit].out, cv::CAP_OPENCV_MJPEG,
                               cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kRateHz, {640, 240});
        for (const double error_px : {0.0, 4.0, 1.0}) {
            const Layers layers({0, 0}, {0, error_px});
            cv::Mat bgr;
            cv::cvtColor(unit == Unit::kTractor ? layers.tractor : layers.trailer, bgr,
                         cv::COLOR_GRAY2BGR);
            writer.write(bgr);
        }
    }
    const auto evaluated = Evaluate(options);
    ASSERT_TRUE(evaluated) << evaluated.error();
    const nlohmann::json& figures = evaluated.value().figures;
    const auto score_px = [&](const char* seam) {
        return figures["seams"][seam]["paper"]["stitching_score_px"].get<double>();
    };
    EXPECT_NEAR(score_px("right"), 4, 0.2);
    EXPECT_LT(score_px("left"), 0.3);
    EXPECT_NEAR(figures["seams"]["right"]["vertical_p95_px"].get<double>(), 4, 0.3);
    EXPECT_LT(figures["seams"]["right"]["horizontal_median_px"].get<double>(), 0.2);
    EXPECT_EQ(figures["series"]["seams"]["right"]["frame"], nlohmann::json({0, 1, 2}));
    EXPECT_EQ(evaluated.value().worst_seams[Overlap::kRight].figures.frame, 1);
}

TEST(EvaluateTest, WhatCannotBeReadIsNamed) {
    EvaluationOptions options;
    EXPECT_EQ(Evaluate(options).error(), "no video to evaluate");
    options.panorama = "/nowhere/panorama.avi";
    EXPECT_EQ(Evaluate(options).error(), "/nowhere/panorama.avi: no such file");
}

}  // namespace
}  // namespace hitchview::app

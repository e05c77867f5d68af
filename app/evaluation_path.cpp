#include "app/evaluation_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/calib3d.hpp>

#include "app/evaluation_features.hpp"

namespace hitchview::app {
namespace {

constexpr std::size_t kFewestFrames = 16;
constexpr std::size_t kStabilityFrames = 300;
constexpr std::size_t kSlowBins = 5;
// Energies below this (px^2, rad^2) are rounding: the path does not move.
constexpr double kStillEnergy = 1e-9;

using Signal = std::vector<double>;

Signal Component(const std::vector<cv::Vec3d>& path, int component) {
    Signal signal(path.size());
    std::ranges::transform(path, signal.begin(), [&](const cv::Vec3d& p) { return p[component]; });
    return signal;
}

// Without mean and linear trend (least squares), under a Hann window.
Signal Detrended(const Signal& signal) {
    const auto count = static_cast<double>(signal.size());
    const double middle = (count - 1) / 2;
    const double mean = std::accumulate(signal.begin(), signal.end(), 0.0) / count;
    double slope = 0;
    for (std::size_t i = 0; i < signal.size(); ++i) {
        slope += (static_cast<double>(i) - middle) * signal[i];
    }
    slope /= count * (count * count - 1) / 12;
    Signal result(signal.size());
    for (std::size_t i = 0; i < signal.size(); ++i) {
        const auto t = static_cast<double>(i);
        const double hann = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * t / (count - 1));
        result[i] = hann * (signal[i] - mean - slope * (t - middle));
    }
    return result;
}

// |DFT|^2 of bins 0 to N/2.
Signal Power(const Signal& signal) {
    cv::Mat spectrum;
    cv::dft(cv::Mat(signal).reshape(1, 1), spectrum, cv::DFT_COMPLEX_OUTPUT);
    Signal power(signal.size() / 2 + 1);
    for (std::size_t k = 0; k < power.size(); ++k) {
        const auto bin = spectrum.at<cv::Vec2d>(0, static_cast<int>(k));
        power[k] = bin.dot(bin);
    }
    return power;
}

double Energy(const Signal& power, std::size_t first_bin, std::size_t end_bin) {
    double energy = 0;
    for (std::size_t k = first_bin; k < std::min(end_bin, power.size()); ++k) energy += power[k];
    return energy;
}

Signal Sum(const Signal& a, const Signal& b) {
    Signal sum(a.size());
    std::ranges::transform(a, b, sum.begin(), std::plus{});
    return sum;
}

std::optional<double> SlowShare(const Signal& power) {
    const double all = Energy(power, 1, power.size());
    if (all < kStillEnergy) return std::nullopt;
    return Energy(power, 1, 1 + kSlowBins) / all;
}

// `Prepare` is applied to each component before its spectrum is taken.
template <typename Prepare>
SlowShares Stability(const std::vector<cv::Vec3d>& path, Prepare prepare) {
    const auto power = [&](int component) { return Power(prepare(Component(path, component))); };
    return {.translation = SlowShare(Sum(power(0), power(1))), .rotation = SlowShare(power(2))};
}

// Root of the mean square of second differences, summed over components [first, end).
double RmsSecondDifference(const std::vector<cv::Vec3d>& path, int first, int end) {
    double sum = 0;
    for (std::size_t i = 2; i < path.size(); ++i) {
        const cv::Vec3d second = path[i] - 2 * path[i - 1] + path[i - 2];
        for (int c = first; c < end; ++c) sum += second[c] * second[c];
    }
    return std::sqrt(sum / static_cast<double>(path.size() - 2));
}

Signal DetrendedPower(const std::vector<cv::Vec3d>& path) {
    const auto power = [&](int component) { return Power(Detrended(Component(path, component))); };
    return Sum(power(0), power(1));
}

double FastEnergy(const std::vector<cv::Vec3d>& path, double rate_hz) {
    constexpr double kFastHz = 1;
    const auto bins_per_hz = static_cast<double>(path.size()) / rate_hz;
    const auto first_bin = static_cast<std::size_t>(std::floor(kFastHz * bins_per_hz)) + 1;
    const Signal power = DetrendedPower(path);
    return Energy(power, first_bin, power.size());
}

// Motion of the frame centre and rotation; empty if it cannot be found.
std::optional<cv::Vec3d> MotionBetween(const cv::Mat& early, const cv::Mat& late) {
    const PointPairs pairs = TrackCorners(early, late);
    if (pairs.size() < 10) return std::nullopt;
    const cv::Mat fit = cv::estimateAffinePartial2D(pairs.first, pairs.second, cv::noArray(),
                                                    cv::RANSAC, 2.0, 2000, 0.999);
    if (fit.empty()) return std::nullopt;
    const cv::Matx23d M_late_early(fit);
    const cv::Vec2d centre(late.cols / 2.0, late.rows / 2.0);
    const cv::Vec2d moved = M_late_early * cv::Vec3d(centre[0], centre[1], 1);
    return cv::Vec3d(moved[0] - centre[0], moved[1] - centre[1],
                     std::atan2(M_late_early(1, 0), M_late_early(0, 0)));
}

bool Equal(const cv::Mat& a, const cv::Mat& b) {
    constexpr double kEqualMeanSquare = 0.02;
    return cv::norm(a, b, cv::NORM_L2SQR) < kEqualMeanSquare * static_cast<double>(a.total());
}

}  // namespace

std::optional<double> SlowShares::Mean() const {
    if (!translation || !rotation) return translation ? translation : rotation;
    return (*translation + *rotation) / 2;
}

std::optional<double> SlowShares::Smaller() const {
    if (!translation || !rotation) return translation ? translation : rotation;
    return std::min(*translation, *rotation);
}

void PathMeter::Append(const cv::Mat& grey) {
    CV_Assert(grey.type() == CV_8U && (early_.empty() || early_.size() == grey.size()));
    if (path_.empty()) {
        path_.emplace_back(0, 0, 0);
    } else {
        const std::optional<cv::Vec3d> maybe_motion = MotionBetween(early_, grey);
        lost_ += maybe_motion ? 0 : 1;
        repeated_ += Equal(early_, grey) ? 1 : 0;
        path_.push_back(path_.back() + maybe_motion.value_or(cv::Vec3d{}));
    }
    grey.copyTo(early_);
}

PathScores PathMeter::Scores() const {
    if (path_.size() < kFewestFrames) return {};
    const auto frames = static_cast<std::ptrdiff_t>(std::min(path_.size(), kStabilityFrames));
    const std::vector<cv::Vec3d> first_frames(path_.begin(), path_.begin() + frames);
    return {.stability = Stability(path_, [](const Signal& signal) { return signal; }),
            .stability_detrended = Stability(first_frames, Detrended),
            .stability_frames = static_cast<int>(frames),
            .jerk_px = RmsSecondDifference(path_, 0, 2),
            .rot_jerk_rad = RmsSecondDifference(path_, 2, 3)};
}

std::optional<double> JitterRatio(const PathMeter& out, const PathMeter& in, double rate_hz) {
    if (std::min(out.path().size(), in.path().size()) < kFewestFrames) return std::nullopt;
    const double in_energy = FastEnergy(in.path(), rate_hz);
    if (in_energy < kStillEnergy) return std::nullopt;
    return std::sqrt(FastEnergy(out.path(), rate_hz) / in_energy);
}

Spectrum ShakeSpectrum(const std::vector<cv::Vec3d>& path, double rate_hz) {
    Spectrum spectrum;
    if (path.size() < kFewestFrames) return spectrum;
    const Signal power = DetrendedPower(path);
    const auto frames = static_cast<double>(path.size());
    for (std::size_t k = 1; k < power.size(); ++k) {
        spectrum.hz.push_back(static_cast<double>(k) * rate_hz / frames);
        // A sinusoid of amplitude 1 has a bin of N / 2, half of which the window lets through.
        spectrum.amplitude_px.push_back(4 * std::sqrt(power[k]) / frames);
    }
    return spectrum;
}

}  // namespace hitchview::app

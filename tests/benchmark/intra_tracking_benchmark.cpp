// CPU time and accuracy of intra motion, beside OpenCV's optical flow on the same pictures:
//   intra_tracking_benchmark [--benchmark_filter=...]
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <ctime>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

#include "algo/feature_tracker.hpp"
#include "algo/stabilization_motion_field.hpp"
#include "algo/unified_options.hpp"
#include "tests/support/sine_texture.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

constexpr int kFeatures = 300;
constexpr int kFrames = 20;
constexpr float kMaxRoundTrip_px = 0.5F;
const cv::Size kSize(1024, 256);

double Cpu_us() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// A shaking camera's pictures of a textured plane, with sensor noise. Known: where each point of
/// the plane lies in each of them. Shown forwards and backwards in turns.
class ShakenWorld {
 public:
    ShakenWorld() {
        const tests::SineTexture texture(11, 5, 60);
        cv::RNG random(3);
        for (int i = 0; i < kFrames; ++i) {
            cv::Mat picture;
            const Eigen::Affine2d plane_picture = PictureOfPlane(i).inverse();
            texture
                .Picture(kSize, [&](int x, int y) { return plane_picture * Eigen::Vector2d(x, y); })
                .convertTo(picture, CV_16S);
            cv::Mat noise(kSize, CV_16S);
            random.fill(noise, cv::RNG::NORMAL, 0, 2);
            cv::Mat1b noisy;
            cv::Mat(picture + noise).convertTo(noisy, CV_8U);
            pictures_.push_back(noisy);
        }
    }

    [[nodiscard]] const cv::Mat1b& Picture(int frame) const {
        return pictures_[static_cast<std::size_t>(Index(frame))];
    }
    /// Where what lies at `early_px` in the frame before `frame` lies in `frame`.
    [[nodiscard]] Vector2f Truth(int frame, const Vector2f& early_px) const {
        const Eigen::Affine2d late_early =
            PictureOfPlane(Index(frame)) * PictureOfPlane(Index(frame - 1)).inverse();
        return (late_early * early_px.cast<double>()).cast<float>();
    }

 private:
    static int Index(int frame) {
        const int i = frame % (2 * kFrames - 2);
        return i < kFrames ? i : 2 * kFrames - 2 - i;
    }
    static Eigen::Affine2d PictureOfPlane(int i) {
        const Eigen::Vector2d centre(0.5 * kSize.width, 0.5 * kSize.height);
        return Eigen::Translation2d(centre) *
               Eigen::Translation2d(9 * std::sin(0.9 * i), 5 * std::sin(1.3 * i + 1)) *
               Eigen::Rotation2Dd(0.01 * std::sin(0.7 * i)) * Eigen::Translation2d(-centre);
    }

    std::vector<cv::Mat1b> pictures_;
};

const ShakenWorld& World() {
    static const ShakenWorld world;
    return world;
}

struct Figures {
    double cpu_us = 0;
    double squared_px2 = 0;
    double tracks = 0;
    double lost = 0;  ///< believed, but more than a pixel off

    void Add(int frame, const Vector2f& early_px, const Vector2f& late_px) {
        const double error_px = (late_px - World().Truth(frame, early_px)).norm();
        if (error_px > 1) {
            ++lost;
            return;
        }
        squared_px2 += error_px * error_px;
        ++tracks;
    }
    [[nodiscard]] double rms_px() const { return std::sqrt(squared_px2 / tracks); }
};

/// Corners every fifth frame, a pyramid of each, flow there and back.
class OpenCvChain {
 public:
    explicit OpenCvChain(int window_px) : window_(window_px, window_px) { cv::setNumThreads(1); }

    void Follow(int frame, Figures& figures) {
        const cv::Mat1b& picture = World().Picture(frame);
        const double start_us = Cpu_us();
        std::swap(early_, late_);
        cv::buildOpticalFlowPyramid(picture, late_, window_, kMaxLevel);
        to_.clear();
        if (!from_.empty()) {
            cv::calcOpticalFlowPyrLK(early_, late_, from_, to_, found_, cv::noArray(), window_,
                                     kMaxLevel);
            cv::calcOpticalFlowPyrLK(late_, early_, to_, back_, found_back_, cv::noArray(), window_,
                                     kMaxLevel);
        }
        const std::vector<cv::Point2f> tracked = TakeTracks();
        if (frame % 5 == 0) cv::goodFeaturesToTrack(picture, to_, kFeatures, 0.004, 7);
        figures.cpu_us += Cpu_us() - start_us;
        for (std::size_t i = 0; i < tracked.size(); ++i) {
            figures.Add(frame, {tracked[i].x, tracked[i].y}, {late_of_[i].x, late_of_[i].y});
        }
        from_ = to_;
    }

 private:
    static constexpr int kMaxLevel = 3;

    /// Features of the early picture that came back; `to_` keeps where they are now.
    std::vector<cv::Point2f> TakeTracks() {
        std::vector<cv::Point2f> tracked;
        late_of_.clear();
        for (std::size_t i = 0; i < to_.size(); ++i) {
            const bool returned = found_[i] != 0 && found_back_[i] != 0 &&
                                  cv::norm(back_[i] - from_[i]) < kMaxRoundTrip_px;
            if (!returned) continue;
            tracked.push_back(from_[i]);
            late_of_.push_back(to_[i]);
        }
        to_ = late_of_;
        return tracked;
    }

    cv::Size window_;
    std::vector<cv::Mat> early_;
    std::vector<cv::Mat> late_;
    std::vector<cv::Point2f> from_;
    std::vector<cv::Point2f> to_;
    std::vector<cv::Point2f> back_;
    std::vector<cv::Point2f> late_of_;
    std::vector<std::uint8_t> found_;
    std::vector<std::uint8_t> found_back_;
};

class TrackerChain {
 public:
    void Follow(int frame, Figures& figures) {
        swap(early_, late_);
        World().Picture(frame).copyTo(late_.base());
        const double start_us = Cpu_us();
        late_.Build();
        tracker_->Follow(early_, late_, mask_, *tracks_);
        figures.cpu_us += Cpu_us() - start_us;
        for (const FeatureTracker::Track& track : *tracks_) {
            figures.Add(frame, track.early_px, track.late_px);
        }
    }

 private:
    GreyPyramid early_{kSize.width, kSize.height};
    GreyPyramid late_{kSize.width, kSize.height};
    cv::Mat1b mask_{kSize, std::uint8_t{255}};
    std::unique_ptr<FeatureTracker> tracker_ = std::make_unique<FeatureTracker>(
        kSize.width, kSize.height,
        FeatureTrackerOptions{.features = kFeatures, .max_round_trip_px = kMaxRoundTrip_px});
    std::unique_ptr<FeatureTracker::Tracks> tracks_ = std::make_unique<FeatureTracker::Tracks>();
};

/// Argument: the side of OpenCV's window.
void TrackingBesideOpenCv(benchmark::State& state) {
    World();
    Figures ours;
    Figures theirs;
    TrackerChain tracker;
    OpenCvChain opencv(static_cast<int>(state.range(0)));
    int frame = 0;
    for (auto _ : state) {
        tracker.Follow(frame, ours);
        opencv.Follow(frame, theirs);
        ++frame;
    }
    using benchmark::Counter;
    state.counters["ours_us"] = Counter(ours.cpu_us, Counter::kAvgIterations);
    state.counters["opencv_us"] = Counter(theirs.cpu_us, Counter::kAvgIterations);
    state.counters["ratio"] = ours.cpu_us / theirs.cpu_us;
    state.counters["ours_rms_px"] = ours.rms_px();
    state.counters["opencv_rms_px"] = theirs.rms_px();
    state.counters["ours_tracks"] = Counter(ours.tracks, Counter::kAvgIterations);
    state.counters["opencv_tracks"] = Counter(theirs.tracks, Counter::kAvgIterations);
    state.counters["ours_wrong"] = Counter(ours.lost, Counter::kAvgIterations);
    state.counters["opencv_wrong"] = Counter(theirs.lost, Counter::kAvgIterations);
}
BENCHMARK(TrackingBesideOpenCv)->Arg(15)->Arg(21)->Unit(benchmark::kMicrosecond);

void Pyramid(benchmark::State& state) {
    GreyPyramid pyramid(kSize.width, kSize.height);
    World().Picture(0).copyTo(pyramid.base());
    for (auto _ : state) pyramid.Build();
}
BENCHMARK(Pyramid)->Unit(benchmark::kMicrosecond);

void CornerDetection(benchmark::State& state) {
    const auto detector =
        std::make_unique<CornerDetector>(kSize.width, kSize.height, CornerDetectorOptions{});
    const auto corners = std::make_unique<CornerDetector::Corners>();
    for (auto _ : state) detector->Detect(World().Picture(0), {}, {}, kFeatures, *corners);
}
BENCHMARK(CornerDetection)->Unit(benchmark::kMicrosecond);

/// What a driving unit's cameras see of points 5 to 80 m away, all round, to a third of a pixel.
struct DrivenRing {
    Projection view = Projection::Cylinder(2048, 480, 0.5);
    FeatureMotions features;
    std::vector<SightMotion> sights;

    DrivenRing() {
        cv::RNG random(9);
        const Eigen::AngleAxisd R(0.012, Eigen::Vector3d(0.2, -0.5, 0.8).normalized());
        const Eigen::Vector3d t_m(-0.27, 0.02, -0.01);
        for (int i = 0; i < kFeatures; ++i) {
            const double azimuth = random.uniform(-2.2, 2.2);
            const Eigen::Vector3d origin_m{std::abs(azimuth) < 0.5 ? 4.0 : 0.9,
                                           azimuth > 0 ? 1.2 : -1.2, 1};
            const Eigen::Vector3d point_m =
                origin_m +
                Eigen::Vector3d{std::cos(azimuth), std::sin(azimuth), random.uniform(-0.3, 0.3)} /
                    random.uniform(1.0 / 80, 1.0 / 5);
            const Eigen::Vector3d early = (point_m - origin_m).normalized();
            Eigen::Vector3d late = (R * point_m + t_m - origin_m).normalized();
            for (double& v : late) v += random.gaussian(0.3 / view.focal_px);
            features.push_back({view.Pixel(early), view.Pixel(late)});
            sights.push_back({early, late.normalized(), origin_m});
        }
    }
};

void MotionField(benchmark::State& state) {
    const DrivenRing ring;
    const auto field = std::make_unique<StabilizationMotionField>(
        ring.view, AnalysisOptions(ring.view, 0.5).field);
    IntraMotion motion;
    for (auto _ : state) field->Estimate(ring.features, ring.sights, motion);
    state.counters["inliers"] = motion.inliers;
}
BENCHMARK(MotionField)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hitchview::algo

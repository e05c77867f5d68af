#include "tests/support/six_camera_ring.hpp"

#include <gtest/gtest.h>

#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "app/rig_geometry.hpp"
#include "tests/support/shown_panoramas.hpp"
#include "tests/support/test_data.hpp"

// Pictures that are not part of the project: see tests/support/test_data.hpp.
namespace hitchview::app {
namespace {

using algo::Unit;
using Eigen::Vector2d;
using Eigen::Vector3d;
using tests::SixCameraRing;

constexpr double kDegree = std::numbers::pi / 180;

/// Two pixels of neighbouring cameras that show the same thing.
struct Match {
    Vector2d first_px;
    Vector2d second_px;
};

/// A camera of the ring as the rig has it.
struct Mounted {
    algo::CameraGeometry geometry;
    Unit unit = Unit::kTractor;
    int index = 0;  ///< within its unit
};

struct Features {
    std::vector<cv::KeyPoint> points;
    cv::Mat descriptors;
};

Vector3d RayOf(const Mounted& camera, const Vector2d& pixel) {
    return camera.geometry.T_unit_camera.linear() * camera.geometry.model.Unproject(pixel).value();
}

/// Where `there` sees what is far away, too.
cv::Mat SharedWith(const Mounted& there, const Mounted& here) {
    constexpr int kBlock_px = 10;
    constexpr double kParallax_px = 100;
    cv::Mat mask(900 / kBlock_px, 1600 / kBlock_px, CV_8U, cv::Scalar(0));
    for (int y = 0; y < mask.rows; ++y) {
        for (int x = 0; x < mask.cols; ++x) {
            const Vector3d ray = RayOf(here, kBlock_px * Vector2d(x + 0.5, y + 0.5));
            const auto pixel = there.geometry.model.Project(
                there.geometry.T_unit_camera.linear().transpose() * ray);
            if (pixel && pixel->x() > -kParallax_px && pixel->x() < 1600 + kParallax_px)
                mask.at<std::uint8_t>(y, x) = 255;
        }
    }
    cv::resize(mask, mask, {1600, 900}, 0, 0, cv::INTER_NEAREST);
    return mask;
}

Features Describe(const std::string& picture, const cv::Mat& mask) {
    Features features;
    const cv::Mat grey = cv::imread(picture, cv::IMREAD_GRAYSCALE);
    cv::SIFT::create(3000, 3, 0.02)
        ->detectAndCompute(grey, mask, features.points, features.descriptors);
    return features;
}

Vector2d At(const cv::KeyPoint& point) {
    return {point.pt.x, point.pt.y};
}

/// Angle by which the second sight line passes over the first, whatever the distance of what they
/// meet in.
double Skew_rad(const Mounted& a, const Vector3d& ray_a, const Mounted& b, const Vector3d& ray_b) {
    const Vector3d baseline =
        a.geometry.T_unit_camera.translation() - b.geometry.T_unit_camera.translation();
    const Vector3d normal = baseline.cross(ray_a).normalized();
    return std::asin(normal.dot(ray_b));
}

class SixCameraRingTest : public testing::Test {
 protected:
    void SetUp() override {
        const std::string data = tests::TestData("stills/six-camera-ring");
        if (data.empty()) {
            GTEST_SKIP() << "stills/six-camera-ring is not there: set HITCHVIEW_TEST_DATA";
        }
        ring_ = std::make_unique<SixCameraRing>(data);
        kept_ = tests::RunAndKeep(ring_->Rig());
        ASSERT_EQ(kept_.size(), static_cast<std::size_t>(SixCameraRing::kFrames));
        Mount();
    }

    /// Of the last panorama: median distance between where neighbours show the same thing. Empty
    /// where too little is recognised in both pictures.
    std::optional<double> Misalignment_px(std::size_t first, std::size_t second) {
        constexpr std::size_t kFewest = 8;
        std::vector<double> apart;
        for (const Match& match : Matches(first, second)) {
            const auto a = OnCanvas(first, match.first_px);
            const auto b = OnCanvas(second, match.second_px);
            apart.push_back(geometry_->canvas.Difference(a, b).norm());
        }
        std::printf("%-12s %-12s %4zu matches", SixCameraRing::kCameras[first].name,
                    SixCameraRing::kCameras[second].name, apart.size());
        if (apart.size() < kFewest) {
            std::puts(", not measured");
            return std::nullopt;
        }
        std::nth_element(apart.begin(), apart.begin() + std::ssize(apart) / 2, apart.end());
        const double median = apart[apart.size() / 2];
        std::printf(", median %.1f px\n", median);
        return median;
    }

    std::vector<tests::KeptPanorama> kept_;

 private:
    void Mount() {
        const auto config = LoadRigConfig(ring_->Rig());
        ASSERT_TRUE(config) << config.error();
        const auto calibration = LoadCalibrationFor(config.value());
        ASSERT_TRUE(calibration) << calibration.error();
        algo::PerUnit<int> count;
        CameraFormats formats;
        for (const auto& [name, unit] : SixCameraRing::kCameras) {
            cameras_.push_back(
                {calibration.value().cameras.at(name).Geometry(), unit, count[unit]++});
            formats[unit].push_back({1600, 900, hal::PixelFormat::kNv12, hal::Range::kFull});
        }
        auto geometry = MakeRigGeometry(config.value(), calibration.value(), formats);
        ASSERT_TRUE(geometry) << geometry.error();
        geometry_ = std::move(geometry.value());
    }

    /// Features of the pictures themselves, held to the geometry of the pair and to nothing
    /// else: mutual nearest neighbours whose sight lines meet far enough away. They miss each other
    /// by the same angle all over a joint, which is 0 only if the cameras stand as calibrated.
    std::vector<Match> Matches(std::size_t first, std::size_t second) {
        const Features a = Described(first, second);
        const Features b = Described(second, first);
        std::vector<cv::DMatch> nearest;
        cv::BFMatcher(cv::NORM_L2, true).match(a.descriptors, b.descriptors, nearest);
        std::vector<Match> matches;
        std::vector<double> skews_rad;
        for (const cv::DMatch& m : nearest) {
            const Match match{At(a.points[static_cast<std::size_t>(m.queryIdx)]),
                              At(b.points[static_cast<std::size_t>(m.trainIdx)])};
            const auto skew_rad = SkewIfTrue(first, second, match);
            if (!skew_rad) continue;
            matches.push_back(match);
            skews_rad.push_back(*skew_rad);
        }
        return Agreeing(matches, skews_rad);
    }

    /// Those with the most common skew.
    static std::vector<Match> Agreeing(const std::vector<Match>& matches,
                                       const std::vector<double>& skews_rad) {
        constexpr double kSpread_rad = 0.3 * kDegree;
        std::vector<Match> best;
        for (const double centre_rad : skews_rad) {
            std::vector<Match> agreeing;
            for (std::size_t i = 0; i < matches.size(); ++i) {
                if (std::abs(skews_rad[i] - centre_rad) < kSpread_rad)
                    agreeing.push_back(matches[i]);
            }
            if (agreeing.size() > best.size()) best = std::move(agreeing);
        }
        return best;
    }

    [[nodiscard]] Features Described(std::size_t camera, std::size_t neighbour) const {
        return Describe(ring_->Picture(SixCameraRing::kCameras[camera].name),
                        SharedWith(cameras_[neighbour], cameras_[camera]));
    }

    [[nodiscard]] std::optional<double> SkewIfTrue(std::size_t first, std::size_t second,
                                                   const Match& match) const {
        const Mounted& a = cameras_[first];
        const Mounted& b = cameras_[second];
        const Vector3d ray_a = RayOf(a, match.first_px);
        const Vector3d ray_b = RayOf(b, match.second_px);
        const double apart_rad = std::acos(std::clamp(ray_a.dot(ray_b), -1.0, 1.0));
        const double skew_rad = Skew_rad(a, ray_a, b, ray_b);
        if (std::abs(skew_rad) > 1.5 * kDegree || apart_rad > 6 * kDegree) return std::nullopt;
        return skew_rad;
    }

    [[nodiscard]] Vector2d OnCanvas(std::size_t camera, const Vector2d& pixel) const {
        const Mounted& mounted = cameras_[camera];
        const algo::UnitGeometry& unit = *geometry_->units[mounted.unit];
        return ToCanvas(geometry_->canvas, unit.view(), kept_.back().composition, mounted.unit,
                        unit.ViewRay(mounted.index, pixel).value());
    }

    std::unique_ptr<SixCameraRing> ring_;
    std::vector<Mounted> cameras_;
    std::optional<RigGeometry> geometry_;
};

TEST_F(SixCameraRingTest, BothNarrowOverlapsLock) {
    for (const algo::Overlap overlap : algo::kOverlaps) {
        EXPECT_EQ(kept_.back().composition.seams[overlap], algo::SeamState::kLocked)
            << ToString(overlap);
    }
}

TEST_F(SixCameraRingTest, ItsJointsCloseAsFarAsNearThingsAllow) {
    // 11.4 px are a degree; cameras half a metre apart see a thing 5 m away 6 degrees apart. Where
    // units meet, the pictures say what is where; calibration alone leaves 11 and 6 px.
    constexpr double kParallax_px = 20;
    constexpr double kMatched_px = 6.5;
    int measured = 0;
    for (std::size_t i = 0; i < SixCameraRing::kCameras.size(); ++i) {
        const std::size_t next = (i + 1) % SixCameraRing::kCameras.size();
        const auto maybe_px = Misalignment_px(i, next);
        if (!maybe_px) continue;
        ++measured;
        const bool units_meet =
            SixCameraRing::kCameras[i].unit != SixCameraRing::kCameras[next].unit;
        EXPECT_LE(*maybe_px, units_meet ? kMatched_px : kParallax_px);
    }
    EXPECT_GE(measured, 5);
}

TEST_F(SixCameraRingTest, ShowsSomethingInEveryColumn) {
    for (int x = 0; x < kept_.back().width_px; ++x) {
        int brightest = 0;
        for (int y = 200; y < 280; ++y) brightest = std::max(brightest, kept_.back().Luma(x, y));
        EXPECT_GT(brightest, 20) << "column " << x;
    }
}

}  // namespace
}  // namespace hitchview::app

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "algo/multiband_blend.hpp"
#include "algo/panorama_renderer.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "tests/support/nv12_picture.hpp"
#include "tests/support/sine_texture.hpp"
#include "tests/support/small_ring.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using tests::Nv12Picture;
using tests::PanoramaPicture;

const cv::Size kSize(202, 106);  // no multiple of the block

using Rig = PerUnit<std::optional<UnitGeometry>>;

Rig PlaneRig(bool trailer = false) {
    Rig rig;
    rig[Unit::kTractor] = UnitGeometry::Plane(kSize.width, kSize.height);
    if (trailer) rig[Unit::kTrailer] = UnitGeometry::Plane(kSize.width, kSize.height);
    return rig;
}

/// Last piece first.
class ReversedRunner final : public TaskRunner {
    void DoRun(int count, void (*piece)(void* context, int i), void* context) override {
        for (int i = count - 1; i >= 0; --i) piece(context, i);
    }
};

/// Every fourth piece on a thread of its own kind.
class ThreadedRunner final : public TaskRunner {
    void DoRun(int count, void (*piece)(void* context, int i), void* context) override {
        std::array<std::thread, 4> threads;
        for (int t = 0; t < 4; ++t) {
            threads[static_cast<std::size_t>(t)] = std::thread([=] {
                for (int i = t; i < count; i += 4) piece(context, i);
            });
        }
        for (std::thread& thread : threads) thread.join();
    }
};

/// Builds the map and renders once.
PanoramaPicture Render(const Projection& canvas, const Rig& rig, const Composition& composition,
                       const RigFrames& frames, NoData no_data, TaskRunner& runner) {
    ComposedMap map(canvas, rig, {});
    map.Build(composition, runner);
    PanoramaPicture panorama({canvas.width_px, canvas.height_px});
    PanoramaRenderer().Render(map, frames, no_data, panorama.planes(), runner);
    return panorama;
}

PanoramaPicture RenderPlane(const Matrix3d& M_canvas_view, const CameraFrame& frame,
                            NoData no_data = NoData::kPattern, int canvas_width_px = kSize.width) {
    SerialRunner runner;
    Composition composition;
    composition.M_canvas_view[Unit::kTractor] = M_canvas_view;
    RigFrames frames;
    frames[Unit::kTractor][0] = frame;
    return Render(Projection::Plane(canvas_width_px, kSize.height), PlaneRig(), composition, frames,
                  no_data, runner);
}

/// While it lives, the processor is one whose vectors the kernel leaves alone: every pixel is drawn
/// by itself.
class NoKernel {
 public:
    static bool IsPossible() {
        return std::ranges::count(hwy::SupportedAndGeneratedTargets(), HWY_SCALAR) > 0;
    }
    NoKernel() { hwy::SetSupportedTargetsForTest(HWY_SCALAR); }
    ~NoKernel() { hwy::SetSupportedTargetsForTest(0); }
    NoKernel(const NoKernel&) = delete;
    NoKernel& operator=(const NoKernel&) = delete;
};

/// Luma of the pattern that stands where a camera is missing.
int Hatched(int x, int y) {
    return (x + y) / 8 % 2 != 0 ? 72 : 40;
}

Matrix3d TurnAndShift(double turn_rad, double dx, double dy) {
    Matrix3d m;
    m << std::cos(turn_rad), -std::sin(turn_rad), dx, std::sin(turn_rad), std::cos(turn_rad), dy, 0,
        0, 1;
    return m;
}

TEST(PanoramaRendererTest, APlaneLeftWhereItIsIsCopiedBitForBit) {
    const cv::Mat1b luma = tests::Texture(kSize, 5);
    Nv12Picture picture(luma);
    cv::RNG(6).fill(picture.chroma(), cv::RNG::UNIFORM, 0, 256);
    const PanoramaPicture panorama = RenderPlane(Matrix3d::Identity(), picture.frame());
    EXPECT_EQ(cv::norm(panorama.y(), luma, cv::NORM_INF), 0);
    for (int y = 0; y < kSize.height / 2; ++y) {
        for (int x = 0; x < kSize.width / 2; ++x) {
            // The outermost chroma samples lie between two luma pixels, one of them outside.
            ASSERT_EQ(panorama.u()(y, x), picture.chroma()(y, 2 * x)) << x << ' ' << y;
            ASSERT_EQ(panorama.v()(y, x), picture.chroma()(y, 2 * x + 1)) << x << ' ' << y;
        }
    }
}

/// Where a plane is moved to, and a canvas width: corners are 8 or 16 px apart.
class MovedPlaneTest : public testing::TestWithParam<std::tuple<std::array<double, 3>, int>> {
 protected:
    MovedPlaneTest() {
        const auto [turn_rad, dx, dy] = std::get<0>(GetParam());
        M_canvas_view_ = TurnAndShift(turn_rad, dx, dy);
        const Matrix3d inverse = M_canvas_view_.inverse();
        for (int y = 0; y < kSize.height; ++y) {
            for (int x = 0; x < kSize.width; ++x) {
                const Vector2d from = (inverse * Eigen::Vector3d(x, y, 1)).hnormalized();
                map_x_(y, x) = static_cast<float>(from.x());
                map_y_(y, x) = static_cast<float>(from.y());
            }
        }
    }
    void ExpectAsOpenCvDrawsIt() const;

    Matrix3d M_canvas_view_;
    cv::Mat1f map_x_{kSize};
    cv::Mat1f map_y_{kSize};
};

void MovedPlaneTest::ExpectAsOpenCvDrawsIt() const {
    const cv::Mat1b luma = tests::SineTexture(7).Shifted(kSize, 0, 0);
    const PanoramaPicture panorama = RenderPlane(M_canvas_view_, Nv12Picture(luma).frame(),
                                                 NoData::kPattern, std::get<1>(GetParam()));
    cv::Mat1b expected;
    cv::remap(luma, expected, map_x_, map_y_, cv::INTER_LINEAR);
    int compared = 0;
    double brighter = 0;
    for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
            // Distance into the picture from its nearest edge.
            const double depth =
                std::min<double>({map_x_(y, x), map_y_(y, x), kSize.width - 1.0 - map_x_(y, x),
                                  kSize.height - 1.0 - map_y_(y, x)});
            if (depth > 2) {
                ASSERT_NEAR(panorama.y()(y, x), expected(y, x), 1) << x << ' ' << y;
                brighter += panorama.y()(y, x) - expected(y, x);
                ++compared;
            }
            if (depth < -2) {
                ASSERT_EQ(panorama.y()(y, x), 0) << "nothing is shifted in at " << x << ' ' << y;
                ASSERT_EQ(panorama.u()(y / 2, x / 2), 128);
            }
        }
    }
    EXPECT_GT(compared, kSize.area() / 3);
    EXPECT_NEAR(brighter / compared, 0, 0.1) << "rounded to the nearest level, not down";
}

TEST_P(MovedPlaneTest, AgreesWithOpenCvsRemap) {
    ExpectAsOpenCvDrawsIt();
}

TEST_P(MovedPlaneTest, AgreesWithOpenCvsRemapPixelByPixel) {
    if (!NoKernel::IsPossible()) GTEST_SKIP() << "the kernel runs on every processor of this kind";
    const NoKernel pixel_by_pixel;
    ExpectAsOpenCvDrawsIt();
}

INSTANTIATE_TEST_SUITE_P(
    TurnsAndShifts, MovedPlaneTest,
    testing::Combine(testing::Values(std::array{0.0, 17.0, -9.0}, std::array{0.0, 3.25, 2.75},
                                     std::array{0.05, -4.3, 6.1}, std::array{-0.4, 20.5, 40.5},
                                     std::array{0.0, 96.0, 0.5}),
                     testing::Values(kSize.width, 2064)));

TEST(PanoramaRendererTest, AMissingCameraGivesThePatternOrBlackAndNeverStalePixels) {
    const PanoramaPicture pattern = RenderPlane(Matrix3d::Identity(), {}, NoData::kPattern);
    const PanoramaPicture black = RenderPlane(Matrix3d::Identity(), {}, NoData::kBlack);
    EXPECT_EQ(cv::countNonZero(black.y()), 0);
    cv::Mat1b dark;
    cv::Mat1b light;
    cv::compare(pattern.y(), 40, dark, cv::CMP_EQ);
    cv::compare(pattern.y(), 72, light, cv::CMP_EQ);
    EXPECT_EQ(cv::countNonZero(dark) + cv::countNonZero(light), kSize.area());
    EXPECT_GT(cv::countNonZero(dark), kSize.area() / 3);
    EXPECT_GT(cv::countNonZero(light), kSize.area() / 3);
    for (const PanoramaPicture* picture : {&pattern, &black}) {
        EXPECT_EQ(cv::countNonZero(picture->u() != 128), 0);
        EXPECT_EQ(cv::countNonZero(picture->v() != 128), 0);
    }
}

TEST(PanoramaRendererTest, TwoPlanesShowEachUnitOnItsSideAndABlendInTheStripBetween) {
    SerialRunner runner;
    const Projection canvas = Projection::Plane(320, kSize.height);
    Composition composition;
    composition.M_canvas_view[Unit::kTrailer] = TurnAndShift(0, 118, 0);
    const Nv12Picture left(cv::Mat1b(kSize, std::uint8_t{60}));
    const Nv12Picture right(cv::Mat1b(kSize, std::uint8_t{180}));
    RigFrames frames;
    frames[Unit::kTractor][0] = left.frame();
    frames[Unit::kTrailer][0] = right.frame();
    const PanoramaPicture panorama =
        Render(canvas, PlaneRig(true), composition, frames, NoData::kPattern, runner);
    const int seam = (118 + 201) / 2;
    for (int y = 0; y < kSize.height; ++y) {
        EXPECT_EQ(panorama.y()(y, 5), 60);
        EXPECT_EQ(panorama.y()(y, seam - 24), 60);
        EXPECT_EQ(panorama.y()(y, seam + 24), 180);
        EXPECT_EQ(panorama.y()(y, 315), 180);
        EXPECT_NEAR(panorama.y()(y, seam), 120, 35);
        for (int x = 1; x < 320; ++x) ASSERT_GE(panorama.y()(y, x), panorama.y()(y, x - 1)) << x;
    }
}

/// Canvas widths with corners 8 and 16 px apart.
class WidthTest : public testing::TestWithParam<int> {};

TEST_P(WidthTest, PixelsThatOneOfTwoTiltedPicturesShowsAreItsOwnUpToItsEdge) {
    SerialRunner runner;
    PerUnit<Matrix3d> M_view_canvas;
    Composition composition;
    for (const Unit unit : kUnits) {
        const bool tractor = unit == Unit::kTractor;
        composition.M_canvas_view[unit] =
            TurnAndShift(tractor ? 0.3 : -0.2, tractor ? 60 : 140, 50);
        M_view_canvas[unit] = composition.M_canvas_view[unit].inverse();
    }
    const Nv12Picture tractor(cv::Mat1b(kSize, std::uint8_t{60}), 100, 150);
    const Nv12Picture trailer(cv::Mat1b(kSize, std::uint8_t{180}), 100, 150);
    RigFrames frames;
    frames[Unit::kTractor][0] = tractor.frame();
    frames[Unit::kTrailer][0] = trailer.frame();
    const PanoramaPicture panorama = Render(Projection::Plane(GetParam(), 240), PlaneRig(true),
                                            composition, frames, NoData::kBlack, runner);
    // px into the picture; less: outside.
    const auto depth = [&](Unit unit, int x, int y) {
        const Vector2d p = (M_view_canvas[unit] * Eigen::Vector3d(x, y, 1)).hnormalized();
        return std::min({p.x(), p.y(), kSize.width - 1 - p.x(), kSize.height - 1 - p.y()});
    };
    std::array<int, 4> seen_by{};
    for (int y = 0; y < 240; ++y) {
        for (int x = 0; x < 360; ++x) {
            const double a = depth(Unit::kTractor, x, y);
            const double b = depth(Unit::kTrailer, x, y);
            if (std::min(std::abs(a), std::abs(b)) < 0.01) continue;
            const int which = (a > 0 ? 1 : 0) + (b > 0 ? 2 : 0);
            ++seen_by[static_cast<std::size_t>(which)];
            constexpr std::array<std::array<int, 2>, 4> kGrey{
                {{0, 0}, {59, 61}, {179, 181}, {59, 181}}};
            const auto [least, most] = kGrey[static_cast<std::size_t>(which)];
            const int grey = panorama.y()(y, x);
            ASSERT_TRUE(grey >= least && grey <= most) << grey << " at " << x << ' ' << y;
            const int u = std::max(a, b) < -1 ? 128 : 100;
            if (std::abs(std::max(a, b)) > 1) {
                ASSERT_NEAR(panorama.u()(y / 2, x / 2), u, 1) << x << ' ' << y;
            }
        }
    }
    for (const int count : seen_by) EXPECT_GT(count, 3000);
}

INSTANTIATE_TEST_SUITE_P(Corners8And16PxApart, WidthTest, testing::Values(360, 2064));

TEST(PanoramaRendererTest, WhatThePreferredUnitDoesNotCoverComesFromTheOtherOne) {
    SerialRunner runner;
    Composition composition;
    composition.M_canvas_view[Unit::kTractor] = TurnAndShift(0, 0, -24);
    composition.M_canvas_view[Unit::kTrailer] = TurnAndShift(0, 100, 0);
    const Nv12Picture left(cv::Mat1b(kSize, std::uint8_t{60}));
    const Nv12Picture right(cv::Mat1b(kSize, std::uint8_t{180}));
    RigFrames frames;
    frames[Unit::kTractor][0] = left.frame();
    frames[Unit::kTrailer][0] = right.frame();
    const PanoramaPicture panorama = Render(Projection::Plane(302, kSize.height), PlaneRig(true),
                                            composition, frames, NoData::kPattern, runner);
    EXPECT_EQ(panorama.y()(50, 110), 60) << "both see it: the tractor's side of the seam";
    EXPECT_EQ(panorama.y()(100, 110), 180) << "only the trailer sees it";
    EXPECT_EQ(panorama.y()(100, 90), 0) << "nobody sees it";
}

TEST(PanoramaRendererTest, WhatTheOtherUnitSeesTooFillsTheGapOfAMissingCamera) {
    SerialRunner runner;
    RigFrames frames;
    const Nv12Picture here(cv::Mat1b(kSize, std::uint8_t{90}));
    frames[Unit::kTrailer][0] = here.frame();
    Composition composition;
    composition.M_canvas_view[Unit::kTrailer] = TurnAndShift(0, 100, 0);
    const PanoramaPicture panorama = Render(Projection::Plane(302, kSize.height), PlaneRig(true),
                                            composition, frames, NoData::kPattern, runner);
    EXPECT_EQ(panorama.y()(50, 290), 90);
    EXPECT_EQ(panorama.y()(50, 170), 90);
    const int lost = panorama.y()(50, 30);
    EXPECT_TRUE(lost == 40 || lost == 72) << lost;
}

TEST(PanoramaRendererTest, GainsBrightenACameraAndKeepGreyGrey) {
    SerialRunner runner;
    const Rig rig = PlaneRig();
    ComposedMap map(Projection::Plane(kSize.width, kSize.height), rig, {});
    map.Build({}, runner);
    const Nv12Picture picture(cv::Mat1b(kSize, std::uint8_t{100}), 128, 148);
    RigFrames frames;
    frames[Unit::kTractor][0] = picture.frame();
    PanoramaRenderer renderer;
    const auto rendered = [&](float gain) {
        CameraGains gains;
        gains[Unit::kTractor].fill(gain);
        renderer.SetGains(gains);
        PanoramaPicture panorama(kSize);
        renderer.Render(map, frames, NoData::kBlack, panorama.planes(), runner);
        return std::array<int, 3>{panorama.y()(50, 50), panorama.u()(20, 20), panorama.v()(20, 20)};
    };
    EXPECT_EQ(rendered(1.0F), (std::array{100, 128, 148}));
    EXPECT_EQ(rendered(1.5F), (std::array{150, 128, 158}));
    EXPECT_EQ(rendered(3.9F), (std::array{255, 128, 206}));
    EXPECT_EQ(rendered(9.0F), (std::array{100, 128, 148})) << "no gain that a camera could need";
    EXPECT_EQ(rendered(std::numeric_limits<float>::quiet_NaN()), (std::array{100, 128, 148}));
}

class RingRigTest : public testing::Test {
 protected:
    explicit RingRigTest(const Projection& canvas = Projection::Cylinder(768, 132, 0.5))
        : canvas_(canvas) {
        rig_[Unit::kTractor] = UnitGeometry::Ring(canvas_, tests::LevelCameras(3, 1.2, 0), {});
        rig_[Unit::kTrailer] =
            UnitGeometry::Ring(canvas_, tests::LevelCameras(3, 1.2, std::numbers::pi), {});
        for (std::uint64_t i = 0; i < 6; ++i)
            pictures_.emplace_back(tests::Texture({320, 200}, i), 90, 170);
        for (std::size_t i = 0; i < 3; ++i) {
            frames_[Unit::kTractor][i] = pictures_[i].frame();
            frames_[Unit::kTrailer][i] = pictures_[i + 3].frame();
        }
        composition_.M_canvas_view[Unit::kTrailer] = ToPose(canvas_, {{31, 0.02, -0.01}});
        composition_.discrepancy.setConstant(1.7F);
    }
    PanoramaPicture RenderWith(TaskRunner& runner) {
        return Render(canvas_, rig_, composition_, frames_, NoData::kPattern, runner);
    }

    Projection canvas_;
    Rig rig_;
    std::vector<Nv12Picture> pictures_;
    RigFrames frames_;
    Composition composition_;
};

TEST_F(RingRigTest, TheOrderAndTheThreadsOfTheWorkDoNotChangeOneBit) {
    SerialRunner serial;
    ReversedRunner reversed;
    ThreadedRunner threaded;
    const PanoramaPicture first = RenderWith(serial);
    EXPECT_TRUE(first == RenderWith(reversed));
    EXPECT_TRUE(first == RenderWith(threaded));
}

TEST_F(RingRigTest, SceneInfinitelyFarComesOutAtItsAzimuth) {
    // One bright column in the front camera, 20 degrees to the left of its axis.
    SerialRunner serial;
    rig_[Unit::kTrailer].reset();
    const UnitGeometry& geometry = *rig_[Unit::kTractor];
    const double azimuth = 0.35;
    Vector2d pixel;
    ASSERT_TRUE(geometry.Project(1, {std::cos(azimuth), std::sin(azimuth), 0}, pixel));
    cv::Mat1b luma(200, 320, std::uint8_t{50});
    luma(cv::Rect(cvRound(pixel.x()) - 2, 0, 5, 200)).setTo(250);
    const Nv12Picture picture(luma);
    frames_[Unit::kTractor][1] = picture.frame();
    const PanoramaPicture panorama = RenderWith(serial);
    const Vector2d expected = canvas_.Pixel({std::cos(azimuth), std::sin(azimuth), 0});
    EXPECT_GT(panorama.y()(cvRound(expected.y()), cvRound(expected.x())), 240);
    EXPECT_EQ(panorama.y()(cvRound(expected.y()), cvRound(expected.x()) - 14), 50);
    EXPECT_EQ(panorama.y()(cvRound(expected.y()), cvRound(expected.x()) + 14), 50);
}

/// Corners 8 and 16 px apart.
class MissingCameraTest : public RingRigTest, public testing::WithParamInterface<int> {
 protected:
    MissingCameraTest() : RingRigTest(Projection::Cylinder(GetParam(), GetParam() / 6 + 4, 0.5)) {}

    /// Whichever of the tractor's cameras is missing.
    void ExpectBandsBlendBetweenTheCamerasColours();

    /// Angle from the direction in which the tractor's front camera looks.
    [[nodiscard]] double AzimuthOf(int x) const {
        const Eigen::Vector3d ray = canvas_.Ray({static_cast<double>(x), canvas_.horizon_y_px});
        return std::abs(std::atan2(ray.y(), ray.x()));
    }
};

TEST_P(MissingCameraTest, ThePatternStandsInItsPartOnlyAndNothingElseChanges) {
    constexpr double kReach_rad = 1.3;  // of the camera, and of the blocks at its edge
    SerialRunner serial;
    const PanoramaPicture all = RenderWith(serial);
    frames_[Unit::kTractor][1] = {};
    const PanoramaPicture without = RenderWith(serial);
    const auto middle = static_cast<int>(canvas_.Centre().x());
    EXPECT_EQ(without.y()(66, middle), Hatched(middle, 66));
    cv::Mat1b near_seen;  // the pattern comes in whole blocks
    cv::dilate(all.y(), near_seen, cv::Mat1b::ones(31, 31));
    int hatched = 0;
    for (int y = 0; y < canvas_.height_px; ++y) {
        for (int x = 0; x < canvas_.width_px; ++x) {
            const int grey = without.y()(y, x);
            ASSERT_TRUE(near_seen(y, x) != 0 || grey == 0)
                << "no camera ever saw " << x << ' ' << y;
            if (grey == all.y()(y, x)) continue;
            ASSERT_LT(AzimuthOf(x), kReach_rad) << "another camera's part at " << x << ' ' << y;
            hatched += grey == Hatched(x, y) ? 1 : 0;
        }
    }
    EXPECT_GT(hatched, canvas_.width_px * canvas_.height_px / 20);
}

TEST_P(MissingCameraTest, WhatTheOthersSeeIsDrawnWithoutATraceOfThePattern) {
    // Of a picture that is one grey, whatever is left of it is that grey.
    SerialRunner serial;
    const Nv12Picture grey(cv::Mat1b(200, 320, std::uint8_t{150}));
    for (auto& unit : frames_.of) unit.fill(grey.frame());
    frames_[Unit::kTractor][1] = {};
    const PanoramaPicture without = RenderWith(serial);
    int drawn = 0;
    for (int y = 0; y < canvas_.height_px; ++y) {
        for (int x = 0; x < canvas_.width_px; ++x) {
            const int luma = without.y()(y, x);
            ASSERT_TRUE(luma == 150 || luma == 0 || luma == Hatched(x, y))
                << luma << " at " << x << ' ' << y;
            drawn += luma == 150 ? 1 : 0;
        }
    }
    EXPECT_GT(drawn, canvas_.width_px * canvas_.height_px / 3);
}

void MissingCameraTest::ExpectBandsBlendBetweenTheCamerasColours() {
    constexpr int kDarkest = 100;
    constexpr int kBrightest = 150;
    SerialRunner serial;
    std::vector<Nv12Picture> greys;
    for (int grey = kDarkest; grey <= kBrightest; grey += 10)
        greys.emplace_back(cv::Mat1b(200, 320, static_cast<std::uint8_t>(grey)));
    for (std::size_t i = 0; i < 3; ++i) {
        frames_[Unit::kTractor][i] = greys[i].frame();
        frames_[Unit::kTrailer][i] = greys[5 - i].frame();
    }
    ComposedMap map(canvas_, rig_, {});
    map.Build(composition_, serial);
    CameraGains gains;
    for (const Unit unit : kUnits) gains[unit].fill(1);
    for (std::size_t missing = 0; missing < 3; ++missing) {
        RigFrames frames = frames_;
        frames[Unit::kTractor][missing] = {};
        MultibandBlend bands(map);
        bands.Update(map, {frames, gains}, serial);
        PanoramaPicture blended({canvas_.width_px, canvas_.height_px});
        PanoramaRenderer().RenderBlended(map, frames, bands, blended.planes(), serial);
        int mixed = 0;
        for (int y = 0; y < canvas_.height_px; ++y) {
            for (int x = 0; x < canvas_.width_px; ++x) {
                const int luma = blended.y()(y, x);
                ASSERT_TRUE((luma >= kDarkest - 1 && luma <= kBrightest + 1) || luma == 0 ||
                            luma == Hatched(x, y))
                    << luma << " at " << x << ' ' << y << " without " << missing;
                mixed += luma >= kDarkest && luma % 10 != 0 ? 1 : 0;
            }
        }
        EXPECT_GT(mixed, 1000) << missing;
    }
}

TEST_P(MissingCameraTest, BesideThePatternBandsBlendBetweenTheCamerasColours) {
    ExpectBandsBlendBetweenTheCamerasColours();
}

TEST_P(MissingCameraTest, BesideThePatternBandsBlendPixelByPixel) {
    if (!NoKernel::IsPossible()) GTEST_SKIP() << "the kernel runs on every processor of this kind";
    const NoKernel pixel_by_pixel;
    ExpectBandsBlendBetweenTheCamerasColours();
}

INSTANTIATE_TEST_SUITE_P(Corners8And16PxApart, MissingCameraTest, testing::Values(768, 2304));

}  // namespace
}  // namespace hitchview::algo

#include <gtest/gtest.h>

#include <memory>

#include "algo/articulation.hpp"
#include "algo/exposure_gains.hpp"
#include "algo/feature_tracker.hpp"
#include "algo/multiband_blend.hpp"
#include "algo/panorama_renderer.hpp"
#include "algo/semi_surround_view.hpp"
#include "algo/stabilization_motion_field.hpp"
#include "algo/stitching_motion_field.hpp"
#include "algo/trailer_placement.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "algo/unit_smoother.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/hinged_rig.hpp"
#include "tests/support/nv12_picture.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

/// Heap calls that `work` makes on its second run.
template <typename Work>
std::uint64_t HeapCallsOf(Work&& work) {
    work();
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    work();
    return tests::HeapCallsOfThisThread() - before;
}

class HeapTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer brings its own malloc";
    }
    const Projection plane_ = Projection::Plane(320, 200);
};

TEST_F(HeapTest, TheCounterSeesAVector) {
    EXPECT_GT(HeapCallsOf([] { std::make_unique<std::vector<int>>(5).reset(); }), 0U);
}

TEST_F(HeapTest, MotionEstimationTakesNoMemory) {
    FeatureMotions motions;
    CanvasPairs canvas_pairs;
    PerOverlap<InterFeatures> inter;
    for (int i = 0; i < 200; ++i) {
        const Vector2d p{1.5 * i, 199.0 * (i % 13) / 13};
        const Vector2d q = p + (i % 3 == 0 ? Vector2d{40.0 - i, 9} : Vector2d{3, 1});
        motions.push_back({p, q});
        canvas_pairs.push_back({p, q});
        inter[Overlap::kRight].push_back({p, q});
    }
    const auto field =
        std::make_unique<StabilizationMotionField>(plane_, StabilizationMotionFieldOptions{});
    const auto stitching =
        std::make_unique<StitchingMotionField>(plane_, StitchingMotionFieldOptions{});
    const auto placement =
        std::make_unique<TrailerPlacement>(plane_, plane_, TrailerPlacementOptions{});
    UnitSmoother smoother(PathSmoother({.lookahead_frames = 3}));
    UnitSmoother paper_smoother(WalledPaperWeights({.lookahead_frames = 3}));
    IntraMotion motion;
    EXPECT_EQ(HeapCallsOf([&] { field->Estimate(motions, {}, motion); }), 0U);
    EXPECT_TRUE(motion.known);
    EXPECT_EQ(HeapCallsOf([&] {
                  stitching->Update(canvas_pairs);
                  stitching->Extend();
              }),
              0U);
    EXPECT_EQ(HeapCallsOf([&] {
                  placement->Acquire(inter);
                  placement->Predict({{motion, motion}});
                  placement->Correct(inter);
              }),
              0U);
    EXPECT_EQ(HeapCallsOf([&] { smoother.Next({}); }), 0U);
    EXPECT_EQ(HeapCallsOf([&] { paper_smoother.Next({}); }), 0U);
}

TEST_F(HeapTest, RingEstimationTakesNoMemory) {
    const Projection ring = Projection::Cylinder(640, 160, 0.5);
    FeatureMotions motions;
    for (int i = 0; i < 200; ++i) {
        const Vector2d p{3.1 * i, 10.0 + i % 140};
        motions.push_back({p, p + Vector2d{2, i % 4 == 0 ? 9.0 : 0.0}});
    }
    const auto field =
        std::make_unique<StabilizationMotionField>(ring, StabilizationMotionFieldOptions{});
    IntraMotion motion;
    EXPECT_EQ(HeapCallsOf([&] { field->Estimate(motions, {}, motion); }), 0U);
}

TEST_F(HeapTest, ArticulationTakesNoMemory) {
    const auto rig = tests::HingedRig();
    const auto features = tests::HingedScene(rig, {}, 1).See(0.3, 100);
    const auto articulation = std::make_unique<ArticulationEstimator>(
        rig[Unit::kTractor], rig[Unit::kTrailer], ArticulationOptions{});
    std::optional<Articulation> estimate;
    const auto search = [&] {
        articulation->Reset();
        estimate = articulation->Step({}, features);
    };
    EXPECT_EQ(HeapCallsOf(search), 0U);
    EXPECT_TRUE(estimate);
    EXPECT_EQ(HeapCallsOf([&] { estimate = articulation->Step({}, features); }), 0U);
    EXPECT_TRUE(estimate);
}

TEST_F(HeapTest, CausalPaperWeightsTakeNoMemory) {
    const ProfileSmoothingOptions options;
    const PaperWeightsSmoother smoother(options, 3);
    OutputHistory history(options.radius_frames);
    const std::array<Eigen::Vector3d, 3> ahead{};
    EXPECT_EQ(HeapCallsOf([&] {
                  history.Move({1, 2, 3});
                  history.Push(smoother.Next({history.outputs(), ahead}));
              }),
              0U);
}

TEST_F(HeapTest, TrackingTakesNoMemory) {
    const auto tracker = std::make_unique<FeatureTracker>(320, 200, FeatureTrackerOptions{});
    GreyPyramid early(320, 200);
    GreyPyramid late(320, 200);
    tests::Texture({320, 200}, 1).copyTo(early.base());
    tests::Texture({320, 200}, 1).copyTo(late.base());
    const cv::Mat1b mask(200, 320, std::uint8_t{255});
    const auto tracks = std::make_unique<FeatureTracker::Tracks>();
    const std::uint64_t calls = HeapCallsOf([&] {
        early.Build();
        late.Build();
        tracker->Follow(early, late, mask, *tracks);
        swap(early, late);
    });
    EXPECT_FALSE(tracks->empty());
    EXPECT_EQ(calls, 0U);
}

TEST_F(HeapTest, ComposingAndRenderingTakeNoMemory) {
    const tests::Nv12Picture picture(tests::Texture({320, 200}, 2));
    PerUnit<std::optional<UnitGeometry>> rig;
    RigFrames frames;
    for (const Unit unit : kUnits) {
        rig[unit] = UnitGeometry::Plane(320, 200);
        frames[unit][0] = picture.frame();
    }
    Composition composition;
    composition.M_canvas_view[Unit::kTrailer](0, 2) = 200;  // overlaps by 120
    SemiSurroundView view(*rig[Unit::kTractor], 0.5);
    cv::Mat1b grey(view.height_px(), view.width_px());
    ComposedMap map(Projection::Plane(520, 200), rig, {});
    ExposureGains gains;
    MultibandBlend bands(map);
    PanoramaRenderer renderer;
    tests::PanoramaPicture panorama({520, 200});
    SerialRunner runner;
    EXPECT_EQ(HeapCallsOf([&] { view.Compose(frames[Unit::kTractor], grey); }), 0U);
    EXPECT_EQ(HeapCallsOf([&] {
                  const CameraGains known = gains.gains();
                  map.Build(composition, {frames, known}, runner);
                  gains.Update(map, frames);
                  renderer.SetGains(gains.gains());
                  bands.Update(map, {frames, known}, runner);
                  renderer.RenderBlended(map, frames, bands, panorama.planes(), runner);
              }),
              0U);
}

}  // namespace
}  // namespace hitchview::algo

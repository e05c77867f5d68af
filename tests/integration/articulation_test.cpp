#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "algo/unified_vertex_motion.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview {
namespace {

using algo::Unit;
using drivers::SimulatedRig;

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kWidth_px = 640;
constexpr int kHeight_px = 360;
/// Both units see a common scene with these alone, and rendering takes most of the time.
constexpr std::array kSideCameras{1, 2, 3, 7};

/// The simulated rig with its side cameras, and what is true of the hinge.
class Drive {
 public:
    explicit Drive(const drivers::SimulationOptions& options)
        : rig_(std::move(SimulatedRig::Create(options).value())) {
        for (auto& image : images_) image.resize(hal::FrameBytes(rig_->format()));
    }

    [[nodiscard]] algo::PerUnit<std::optional<algo::UnitGeometry>> Geometry() const {
        algo::PerUnit<std::optional<algo::UnitGeometry>> geometry;
        for (const Unit unit : algo::kUnits) {
            std::vector<algo::CameraGeometry> cameras;
            for (const int i : kSideCameras) {
                if (rig_->camera(i).unit == unit) cameras.push_back(rig_->camera(i).geometry);
            }
            const double centre_rad = unit == Unit::kTractor ? 0 : std::numbers::pi;
            geometry[unit] =
                algo::UnitGeometry::Ring(algo::Projection::Cylinder(2048, 360, 0.48, centre_rad),
                                         cameras, {.viewpoint_m = 1.7});
        }
        return geometry;
    }

    /// Borrowed until the next call.
    algo::RigFrames Frames(int frame) {
        algo::RigFrames frames;
        algo::PerUnit<std::size_t> count;
        for (std::size_t k = 0; k < kSideCameras.size(); ++k) {
            rig_->Render(kSideCameras[k], frame, workspace_, images_[k]);
            const Unit unit = rig_->camera(kSideCameras[k]).unit;
            frames[unit][count[unit]++] = {.width_px = kWidth_px,
                                           .height_px = kHeight_px,
                                           .luma = images_[k].data(),
                                           .luma_stride_bytes = kWidth_px,
                                           .chroma = images_[k].data() + kWidth_px * kHeight_px,
                                           .chroma_stride_bytes = kWidth_px};
        }
        return frames;
    }

    /// Of the trailer relative to the tractor, shaking included.
    [[nodiscard]] double YawAt(int frame) const {
        const Eigen::Matrix3d R_tractor_trailer =
            rig_->PoseAt(frame, Unit::kTractor).linear().transpose() *
            rig_->PoseAt(frame, Unit::kTrailer).linear();
        return std::atan2(R_tractor_trailer(1, 0), R_tractor_trailer(0, 0));
    }

 private:
    std::unique_ptr<SimulatedRig> rig_;
    drivers::Renderer::Workspace workspace_;
    std::array<std::vector<std::uint8_t>, kSideCameras.size()> images_;
};

struct Outcome {
    double rms_rad = 0;
    int known = 0;
    double largest_rad = 0;  ///< true angle that was met
};

/// Articulation from the images of frames `first` to the last one against the true one.
Outcome Follow(const drivers::SimulationOptions& options, int first) {
    Drive drive(options);
    const auto geometry = drive.Geometry();
    algo::UnifiedVertexMotion motion(geometry[Unit::kTractor]->view(), geometry, {});
    algo::SerialRunner runner;
    motion.Prime(drive.Frames(first), runner);
    motion.Reset();
    Outcome outcome;
    double squares = 0;
    for (int frame = first; frame < options.frames; ++frame) {
        const algo::Composition* composition = motion.Step(drive.Frames(frame), runner);
        const double truth_rad = drive.YawAt(frame);
        outcome.largest_rad = std::max(outcome.largest_rad, std::abs(truth_rad));
        if (!composition->articulation) continue;
        squares += std::pow(composition->articulation->angle_rad - truth_rad, 2);
        ++outcome.known;
    }
    outcome.rms_rad = std::sqrt(squares / outcome.known);
    std::printf("articulation: rms %.3f degrees over %d frames, up to %.1f degrees\n",
                outcome.rms_rad / kDegree, outcome.known, outcome.largest_rad / kDegree);
    return outcome;
}

drivers::SimulationOptions Small() {
    drivers::SimulationOptions options;
    options.width_px = kWidth_px;
    options.height_px = kHeight_px;
    return options;
}

TEST(ArticulationRunTest, TheAngleIsFollowedThroughASlalomWithShake) {
    drivers::SimulationOptions options = Small();
    options.frames = 30;
    options.speed_mps = 4;
    options.curvature_per_m = 0.12;
    options.slalom_period_s = 3;
    const Outcome outcome = Follow(options, 0);
    EXPECT_EQ(outcome.known, 30);
    EXPECT_LT(outcome.rms_rad, 0.2 * kDegree);
    EXPECT_GT(outcome.largest_rad, 8 * kDegree);
}

TEST(ArticulationRunTest, TheAngleIsFoundInATightBend) {
    drivers::SimulationOptions options = Small();
    options.frames = 90;
    options.speed_mps = 2;
    options.curvature_per_m = 0.5;
    options.profile = drivers::DriveProfile::kTurnRight;
    const Outcome outcome = Follow(options, 80);
    EXPECT_EQ(outcome.known, 10);
    EXPECT_LT(outcome.rms_rad, 0.5 * kDegree);
    EXPECT_GT(outcome.largest_rad, 60 * kDegree);
}

}  // namespace
}  // namespace hitchview

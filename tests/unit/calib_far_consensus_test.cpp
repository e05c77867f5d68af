#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "calib/far_consensus.hpp"
#include "tests/support/board_views.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Two cameras 2 m apart that look 70 degrees apart; the second stands a degree off.
class FarConsensusTest : public testing::Test {
 protected:
    FarConsensusTest() {
        for (const double yaw_rad : {0.0, 70 * std::numbers::pi / 180}) {
            cameras_.push_back({.name = "", .model = tests::FisheyeLens(), .yaw_rad = yaw_rad});
            Isometry3d T = Isometry3d::Identity();
            Eigen::Matrix3d R_level_camera;
            R_level_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
            T.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) * R_level_camera;
            T.translation() = Vector3d(yaw_rad > 0 ? -2 : 0, yaw_rad > 0 ? 0.7 : 0, 1.3);
            T_unit_camera_.push_back(T);
        }
        truth_ = T_unit_camera_;
        truth_[1].rotate(Eigen::AngleAxisd(0.017, Vector3d(1, 2, -1).normalized()));
    }

    /// Of something that both see, from 12 m to the horizon, with a noise of .3 px.
    FarMatch True() {
        for (;;) {
            const double azimuth = 0.6 + 0.4 * any_(random_);
            const double distance_m = 12 * std::exp(2.5 * (1 + any_(random_)));
            const Vector3d p_unit =
                distance_m * Vector3d(std::cos(azimuth), std::sin(azimuth), 0.3 * any_(random_));
            const auto first = See(0, p_unit);
            const auto second = See(1, p_unit);
            if (first && second) return {0, 1, *first, *second};
        }
    }
    FarMatch Wrong() {
        FarMatch match = True();
        const double y = any_(random_);
        const double x = any_(random_);
        match.second_px += 60 * Eigen::Vector2d(x, y);
        return match;
    }

    std::optional<Eigen::Vector2d> See(std::size_t camera, const Vector3d& p_unit) {
        const auto at = cameras_[camera].model.Project(truth_[camera].inverse() * p_unit);
        if (!at || at->x() < 0 || at->y() < 0 || at->x() > 1279 || at->y() > 719)
            return std::nullopt;
        const double noise_y = noise_(random_);
        const double noise_x = noise_(random_);
        return *at + 0.3 * Eigen::Vector2d(noise_x, noise_y);
    }

    std::vector<UnitCamera> cameras_;
    std::vector<Isometry3d> T_unit_camera_;  ///< as believed
    std::vector<Isometry3d> truth_;
    std::mt19937 random_{5};
    std::uniform_real_distribution<double> any_{-1, 1};
    std::normal_distribution<double> noise_{0, 1};
};

TEST_F(FarConsensusTest, KeepsWhatOneTurnExplainsAndHardlyAnythingElse) {
    std::vector<FarMatch> matches;
    for (int i = 0; i < 80; ++i) matches.push_back(i % 2 == 0 ? True() : Wrong());
    const auto kept = AgreeingMatches(matches, cameras_, T_unit_camera_);
    int right = 0;
    for (const FarMatch& match : kept) {
        for (std::size_t i = 0; i < matches.size(); i += 2)
            if (matches[i].second_px == match.second_px) ++right;
    }
    EXPECT_GE(right, 38);
    EXPECT_LE(std::ssize(kept) - right, 6);
}

TEST_F(FarConsensusTest, FindsNothingInNonsense) {
    std::vector<FarMatch> matches;
    for (int i = 0; i < 40; ++i) matches.push_back(Wrong());
    EXPECT_TRUE(AgreeingMatches(matches, cameras_, T_unit_camera_).empty());
    EXPECT_TRUE(AgreeingMatches({}, cameras_, T_unit_camera_).empty());
}

}  // namespace
}  // namespace hitchview::calib

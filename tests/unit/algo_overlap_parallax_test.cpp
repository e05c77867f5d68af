#include <gtest/gtest.h>

#include <memory>

#include "algo/feature_mask.hpp"
#include "algo/overlap_parallax.hpp"
#include "tests/support/hinged_rig.hpp"
#include "tests/support/walled_road.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using tests::kDegree;
using tests::WalledRoad;

constexpr double kScale = 0.5;

struct Stand {
    const char* name;
    bool level = true;  ///< the ground lies on the alignment surface of both units
    Isometry3d T_world_tractor = Isometry3d::Identity();
    Isometry3d T_world_trailer = Isometry3d::Identity();
};

/// Both units' analysis views of a road between walls, and what is true of it.
class Views {
 public:
    explicit Views(const Stand& stand)
        : T_world_unit_{{stand.T_world_tractor, stand.T_world_trailer}} {
        for (const Unit unit : kUnits) {
            view_[unit] = std::make_unique<SemiSurroundView>(rig_[unit], kScale);
            pyramid_[unit] =
                std::make_unique<GreyPyramid>(view_[unit]->width_px(), view_[unit]->height_px());
        }
    }

    /// `paint` gives the grey of a point of the world.
    template <typename Paint>
    void TakePictures(const Paint& paint) {
        for (const Unit unit : kUnits) {
            cv::Mat1b& picture = pyramid_[unit]->base();
            for (int y = 0; y < picture.rows; ++y) {
                for (int x = 0; x < picture.cols; ++x) {
                    const auto p_m =
                        See(unit, Vector2f(static_cast<float>(x), static_cast<float>(y)));
                    picture(y, x) = p_m ? cv::saturate_cast<std::uint8_t>(paint(*p_m)) : 220;
                }
            }
            pyramid_[unit]->Build();
        }
    }

    /// Point of the world that a pixel of the unit's analysis view shows.
    [[nodiscard]] std::optional<Vector3d> See(Unit unit, const Vector2f& pixel) const {
        const UnitGeometry& geometry = rig_[unit];
        const auto line = geometry.SightAlong(geometry.view().Ray(view_[unit]->ToView(pixel)));
        if (!line) return std::nullopt;
        return WalledRoad::Hit(T_world_unit_[unit] * line->origin_m,
                               T_world_unit_[unit].linear() * line->direction);
    }

    /// Pixel of the unit's analysis view that shows the point; empty where something hides it.
    [[nodiscard]] std::optional<Vector2f> Find(Unit unit, const Vector3d& p_world_m) const {
        const UnitGeometry& geometry = rig_[unit];
        const Vector3d p_unit_m = T_world_unit_[unit].inverse() * p_world_m;
        const auto side = geometry.SightAlong({0, p_unit_m.y(), 0});  // one camera on either side
        const Vector3d ray = geometry.RayToward(side->origin_m, p_unit_m - side->origin_m);
        const Vector2f pixel = view_[unit]->ToAnalysis(geometry.view().Pixel(ray));
        const auto seen = Allows(view_[unit]->mask(), pixel) ? See(unit, pixel) : std::nullopt;
        if (!seen || (*seen - p_world_m).norm() > 0.02) return std::nullopt;
        return pixel;
    }

    [[nodiscard]] OverlapParallax MakeParallax(Overlap overlap) const {
        return OverlapParallax(rig_, {{view_[Unit::kTractor].get(), view_[Unit::kTrailer].get()}},
                               overlap, {});
    }
    [[nodiscard]] PerUnit<MatchView> match_views() const {
        PerUnit<MatchView> views{};
        for (const Unit unit : kUnits)
            views[unit] = {pyramid_[unit].get(), &view_[unit]->mask(), {}};
        return views;
    }
    [[nodiscard]] Eigen::Matrix3d R_tractor_trailer() const {
        return T_world_unit_[Unit::kTractor].linear().transpose() *
               T_world_unit_[Unit::kTrailer].linear();
    }

 private:
    PerUnit<UnitGeometry> rig_ = tests::HingedRig();
    PerUnit<Isometry3d> T_world_unit_;
    PerUnit<std::unique_ptr<SemiSurroundView>> view_;
    PerUnit<std::unique_ptr<GreyPyramid>> pyramid_;
};

/// Of the nodes that show what the other unit sees, too.
struct Score {
    int visible = 0;
    int right = 0;  ///< within half a pixel
    int clear = 0;

    void Add(const ParallaxMatch& match, const Vector2f& truth) {
        const bool hit = (match.pair.trailer_px - truth).norm() < 0.5F;
        ++visible;
        right += hit ? 1 : 0;
        clear += match.clear ? 1 : 0;
    }
    [[nodiscard]] double RightShare() const { return right / std::max(1.0, 1.0 * visible); }
};

/// Of each kind of surface.
struct Scores {
    Score ground;
    Score wall;   ///< its part above the horizon
    Score board;  ///< likewise
    /// What stands on the ground, below the horizon: the views shear it against each other by more
    /// than a patch can follow.
    Score sheared;

    Score& Of(const Vector3d& p_m) {
        constexpr double kEye_m = 1.3;
        if (p_m.z() < WalledRoad::kGround_m + 1e-6) return ground;
        if (p_m.z() < kEye_m) return sheared;
        return std::abs(p_m.y()) > WalledRoad::kWall_m - 1e-6 ? wall : board;
    }
};

Scores ScoresOf(const Views& views, const OverlapParallax& parallax) {
    Scores scores;
    for (int row = 0; row < parallax.rows(); ++row) {
        for (int col = 0; col < parallax.cols(); ++col) {
            const auto& match = parallax.At(row, col);
            if (!match) continue;
            const auto p_m = views.See(Unit::kTractor, match->pair.tractor_px);
            const auto truth = p_m ? views.Find(Unit::kTrailer, *p_m) : std::nullopt;
            if (truth) scores.Of(*p_m).Add(*match, *truth);
        }
    }
    return scores;
}

class OverlapParallaxOfStandTest : public testing::TestWithParam<Stand> {};

TEST_P(OverlapParallaxOfStandTest, FindsWhatBothUnitsSeeToHalfAPixel) {
    Views views(GetParam());
    const WalledRoad road;
    views.TakePictures([&](const Vector3d& p_m) { return road.Grey(p_m); });
    for (const Overlap overlap : kOverlaps) {
        OverlapParallax parallax = views.MakeParallax(overlap);
        parallax.Match(views.match_views(), views.R_tractor_trailer());
        const Scores scores = ScoresOf(views, parallax);
        EXPECT_GT(scores.ground.visible, 1600 / OverlapParallax::kRowPitch_px) << ToString(overlap);
        EXPECT_GT(scores.ground.RightShare(), GetParam().level ? 0.95 : 0.8) << ToString(overlap);
        EXPECT_GT(scores.wall.visible, 4000 / OverlapParallax::kRowPitch_px) << ToString(overlap);
        EXPECT_GT(scores.wall.RightShare(), 0.92) << ToString(overlap);
        EXPECT_GT(scores.wall.clear, 0.8 * scores.wall.visible) << ToString(overlap);
        EXPECT_GT(scores.board.visible, 400) << ToString(overlap);
        EXPECT_GT(scores.board.RightShare(), 0.8) << ToString(overlap) << scores.board.RightShare();
    }
}

TEST(OverlapParallaxTest, WhatHasNoTextureHasNoWeight) {
    Views views(Stand{"straight"});
    views.TakePictures([](const Vector3d&) { return 220.0; });
    OverlapParallax parallax = views.MakeParallax(Overlap::kLeft);
    parallax.Match(views.match_views(), views.R_tractor_trailer());
    int found = 0;
    for (int row = 0; row < parallax.rows(); ++row) {
        for (int col = 0; col < parallax.cols(); ++col) {
            const auto& match = parallax.At(row, col);
            if (!match) continue;
            ++found;
            EXPECT_EQ(match->weight, 0);
        }
    }
    EXPECT_GT(found, 1000);
}

TEST(OverlapParallaxTest, ItsColumnsAreThoseThatOverlapAsTheTrailerStands) {
    Views views(Stand{"straight"});
    views.TakePictures([](const Vector3d&) { return 100.0; });
    OverlapParallax parallax = views.MakeParallax(Overlap::kLeft);
    const auto cols = [&](double yaw_rad) {
        parallax.Match(views.match_views(), tests::TrailerPose(yaw_rad, 0, 0, {0, 0, 0}).linear());
        return parallax.cols();
    };
    const double per_degree = 1024 / 360.0 / OverlapParallax::kPitch_px;
    const int straight = cols(0);
    EXPECT_NEAR(straight, 100 * per_degree, 18) << "30 to 130 degrees to the left";
    EXPECT_NEAR(cols(20 * kDegree), straight - 20 * per_degree, 8);
    EXPECT_EQ(cols(0), straight);
}

INSTANTIATE_TEST_SUITE_P(Stands, OverlapParallaxOfStandTest,
                         testing::Values(Stand{"straight"},
                                         Stand{"turned_left", true, Isometry3d::Identity(),
                                               tests::TrailerPose(20 * kDegree, 0, 0, {0, 0, 0})},
                                         Stand{"turned_right", true, Isometry3d::Identity(),
                                               tests::TrailerPose(-20 * kDegree, 0, 0, {0, 0, 0})},
                                         Stand{"tractor_pitched", false,
                                               tests::TrailerPose(0, 1.5 * kDegree, 0, {0, 0, 0})},
                                         Stand{"trailer_pitched", false, Isometry3d::Identity(),
                                               tests::TrailerPose(0, 1.5 * kDegree, 0, {0, 0, 0})}),
                         [](const auto& stand) { return stand.param.name; });

}  // namespace
}  // namespace hitchview::algo

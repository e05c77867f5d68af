#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "calib/lens_file.hpp"
#include "calib/unit_session.hpp"
#include "tests/support/board_views.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::calib {
namespace {

using testing::HasSubstr;

/// A folder with lens files and one session.
class UnitSessionTest : public testing::Test {
 protected:
    UnitSessionTest() {
        SaveLensAs("good.yaml", Verdict::kPass);
        SaveLensAs("bad.yaml", Verdict::kFail);
    }

    void SaveLensAs(const std::string& name, Verdict verdict) const {
        Intrinsics lens{.model = tests::FisheyeLens()};
        lens.verdict = verdict;
        ASSERT_EQ(SaveLens(lens, "test", folder_ / name), "");
    }

    [[nodiscard]] LoadedUnitSession Load(const std::string& cameras,
                                         const std::string& targets) const {
        return LoadUnitSession(
            folder_.Write("session.yaml", "schema: 1\nunit: trailer\nvehicle: truck\ncameras:\n" +
                                              cameras + "targets:\n" + targets));
    }

    tests::TemporaryFolder folder_;
};

constexpr auto kCamera = "  left: {lens: good.yaml, pictures: 'left/*.png', yaw_deg: 90}\n";
constexpr auto kTarget = "  gate: {board: '9x6,0.1'}\n";

TEST_F(UnitSessionTest, SaysWhatAPersonWrote) {
    const auto loaded = Load(
        "  left: {lens: good.yaml, pictures: 'left/*.png', yaw_deg: 90,\n"
        "         pose: {position_m: [1, 2, 3], rpy_deg: [0, 0, 90], sigma_m: 0.01, sigma_deg: "
        "1}}\n",
        "  gate: {board: '9x6,0.1', surveyed: [{corner: bottom_right, at_m: [4, 5, 6]}], sigma_m: "
        "0.002}\n"
        "  carried: {board: '8x6,0.1', moves: true}\n");

    ASSERT_EQ(loaded.error, "");
    const UnitSession& session = *loaded.session;
    EXPECT_EQ(session.unit, algo::Unit::kTrailer);
    EXPECT_EQ(session.vehicle, "truck");
    EXPECT_EQ(session.pictures.at(0), folder_ / "left/*.png");
    const UnitCamera& camera = session.problem.cameras.at(0);
    EXPECT_EQ(camera.name, "left");
    EXPECT_EQ(camera.model.fx_px, tests::FisheyeLens().fx_px);
    EXPECT_DOUBLE_EQ(camera.yaw_rad, std::numbers::pi / 2);
    ASSERT_TRUE(camera.pose);
    EXPECT_TRUE(camera.pose->T_unit_camera.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
    // Looks left: its optical axis is the unit's y.
    EXPECT_TRUE(camera.pose->T_unit_camera.linear().col(2).isApprox(Eigen::Vector3d::UnitY()));
    const UnitTarget& gate = session.problem.targets.at(0);
    EXPECT_EQ(gate.sigma_m, 0.002);
    // Nine by six inner corners end one square inside the outline.
    EXPECT_TRUE(gate.surveyed.at(0).p_board_m.isApprox(Eigen::Vector3d(0.9, 0.6, 0)));
    EXPECT_TRUE(session.problem.targets.at(1).moves);
}

TEST_F(UnitSessionTest, RefusesALensThatHasFailed) {
    const auto loaded = Load("  left: {lens: bad.yaml, pictures: 'a', yaw_deg: 0}\n", kTarget);
    EXPECT_THAT(loaded.error,
                HasSubstr("session.yaml:5: cameras.left.lens is bad.yaml, must be a lens whose "
                          "verdict is not fail"));
}

TEST_F(UnitSessionTest, NamesEveryMistakeWithItsLine) {
    const auto loaded =
        Load("  left: {lens: none.yaml, pictures: 'a', yaw: 3}\n",
             "  a b: {board: 9x6}\n"
             "  pole: {board: '9x6,0.1', moves: true, surveyed: [{corner: top, at_m: [1, 2, 3]}]}\n"
             "  post: {board: '8x5,0.1', surveyed: [{corner: top_left, at_m: [1, 2, 3]},\n"
             "                                      {corner: top_left, at_m: [1, 2, 3]}]}\n"
             "  rod: {board: '9x6,0.1', sigma_m: 0.01}\n");
    EXPECT_THAT(loaded.error, HasSubstr(":5: cameras.left.lens"));
    EXPECT_THAT(loaded.error, HasSubstr(":5: cameras.left.yaw_deg is missing"));
    EXPECT_THAT(loaded.error, HasSubstr(":5: cameras.left.yaw is no key"));
    EXPECT_THAT(loaded.error, HasSubstr("named with letters, digits and _ only"));
    EXPECT_THAT(loaded.error, HasSubstr("targets.a b.board is 9x6, must be a board"));
    EXPECT_THAT(loaded.error, HasSubstr("left out for a target that moves"));
    EXPECT_THAT(loaded.error, HasSubstr("corner is top, must be"));
    EXPECT_THAT(loaded.error, HasSubstr("must be given once"));
    EXPECT_THAT(loaded.error, HasSubstr("left out where no corner is surveyed"));
    EXPECT_THAT(loaded.error, HasSubstr("one that cannot be mistaken for that of pole"));
    EXPECT_FALSE(loaded.session);
}

TEST_F(UnitSessionTest, NeedsACameraAndATarget) {
    const auto loaded = LoadUnitSession(folder_.Write(
        "empty.yaml", "schema: 1\nunit: tractor\nvehicle: x\ncameras: {}\ntargets: {}\n"));
    EXPECT_THAT(loaded.error,
                HasSubstr("empty.yaml:4: cameras is a map, must be a map of at least one"));
    EXPECT_THAT(loaded.error,
                HasSubstr("empty.yaml:5: targets is a map, must be a map of at least one"));
}

}  // namespace
}  // namespace hitchview::calib

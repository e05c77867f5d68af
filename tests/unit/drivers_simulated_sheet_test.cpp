#include <gtest/gtest.h>

#include <set>

#include "drivers/simulated_rig.hpp"
#include "drivers/simulated_sheet.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 200;
constexpr std::uint8_t kBehind = 100;

/// White paper, 0.6 m by 0.4 m, with one dark square in its middle.
const SheetOptions kSquare{.paper = {{0, 0}, {0.6, 0.4}}, .dark = {{{0.2, 0.1}, {0.4, 0.3}}}};

class HeldSheetTest : public testing::Test {
 protected:
    [[nodiscard]] std::vector<std::uint8_t> Picture(int frame) const {
        std::vector<std::uint8_t> nv12(kWidth_px * kHeight_px * 3 / 2, kBehind);
        sheet_.DrawOver(2, frame, 1, nv12);
        return nv12;
    }
    /// Luma of a point of the sheet; empty outside the picture.
    [[nodiscard]] std::optional<int> Luma(int frame, const Vector2d& at_m) const {
        const auto at = lens_.Project(sheet_.PoseAt(2, frame) * Vector3d(at_m.x(), at_m.y(), 0));
        if (!at || at->x() < 1 || at->y() < 1 || at->x() > kWidth_px - 2 ||
            at->y() > kHeight_px - 2)
            return std::nullopt;
        const auto pixel = std::lround(at->y()) * kWidth_px + std::lround(at->x());
        return Picture(frame)[static_cast<std::size_t>(pixel)];
    }

    algo::CameraModel lens_ = SimulatedRigGeometry(kWidth_px, kHeight_px)[0].geometry.model;
    HeldSheet sheet_{kSquare, lens_, 7};
};

TEST_F(HeldSheetTest, PaperAndPrintLieWhereItsPlaceSays) {
    int seen = 0;
    for (int frame = 0; frame < 60; frame += HeldSheet::kHeldFrames) {
        if (const auto print = Luma(frame, {0.3, 0.2})) {
            EXPECT_LT(*print, 60);
            ++seen;
        }
        EXPECT_GT(Luma(frame, {0.1, 0.2}).value_or(255), 180);
        EXPECT_EQ(Luma(frame, {-0.1, 0.2}).value_or(kBehind), kBehind);
    }
    EXPECT_GE(seen, 15);
}

TEST_F(HeldSheetTest, ItRestsForSomeFramesAndThenIsElsewhere) {
    EXPECT_EQ(Picture(0), Picture(HeldSheet::kHeldFrames - 1));
    EXPECT_NE(Picture(0), Picture(HeldSheet::kHeldFrames));
    EXPECT_FALSE(sheet_.PoseAt(0, 0).isApprox(sheet_.PoseAt(1, 0)));
}

}  // namespace
}  // namespace hitchview::drivers

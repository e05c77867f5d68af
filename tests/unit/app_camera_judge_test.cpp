#include <gtest/gtest.h>

#include "app/camera_judge.hpp"

namespace hitchview::app {
namespace {

using hal::CameraState;

/// Of a camera that gives pictures 30 times a second.
class CameraJudgeTest : public testing::Test {
 protected:
    CameraState After(int sets, std::initializer_list<CameraState> shown) {
        CameraSigns signs;
        for (const CameraState state : shown) signs[state] = true;
        for (int set = 0; set < sets; ++set) judge_.Note(signs, true);
        return judge_.state();
    }

    CameraJudge judge_{hal::Instant{33'333'333}};
};

TEST_F(CameraJudgeTest, APictureThatIsShownAgainSaysNothingNewOfItsDetail) {
    for (const CameraState detail : {CameraState::kDirty, CameraState::kBlurred}) {
        EXPECT_EQ(After(300, {CameraState::kFrozen, detail}), CameraState::kFrozen);
        EXPECT_EQ(After(5, {}), CameraState::kGood);
    }
}

TEST_F(CameraJudgeTest, DirtThatWasThereBeforeAPictureFrozeIsThereAfterIt) {
    EXPECT_EQ(After(100, {CameraState::kDirty}), CameraState::kDirty);
    EXPECT_EQ(After(300, {CameraState::kFrozen}), CameraState::kFrozen);
    EXPECT_EQ(After(5, {}), CameraState::kDirty);
    EXPECT_EQ(After(30, {}), CameraState::kGood);
}

}  // namespace
}  // namespace hitchview::app

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/program.hpp"
#include "drivers/simulated_scenario.hpp"
#include "tests/support/temporary_folder.hpp"

// What the panorama promises for every frame, whatever the cameras see (docs/algorithm.md, section
// 13), in every simulated drive from its first to its last frame.
namespace hitchview::app {
namespace {

using nlohmann::json;

/// Most that a locked seam may move beside what truly moves, from one frame to the next.
constexpr double kMostJump_px = 8;
constexpr int kSecond = 30;  // frames
constexpr int kHold = 5;     // frames from one lock to the next

/// The state of every frame, one letter each, from "L12 C5".
std::string EachFrame(const std::string& states) {
    std::istringstream in(states);
    std::string each;
    char letter = 0;
    std::size_t frames = 0;
    while (in >> letter >> frames) each.append(frames, letter);
    return each;
}

class ScenarioSafetyTest : public testing::TestWithParam<std::string> {
 protected:
    void SetUp() override {
        ASSERT_EQ(
            RunProgram(HITCHVIEW, {"scenarios", GetParam(), "--safety-alone", "--camera-width",
                                   "320", "--workers", "1", "--json", folder_ / "figures.json"}),
            0);
        std::ifstream file(folder_ / "figures.json");
        safety_ = json::parse(file)[GetParam()]["safety"];
        for (const char* side : {"left", "right"})
            seam_[side] = EachFrame(safety_["seam"][side]["states"]);
        frames_ = drivers::FindScenario(GetParam())->options.frames;
    }

    [[nodiscard]] long Locked(const std::string& side, int from, int to) const {
        const std::string& states = seam_.at(side);
        return std::count(states.begin() + from, states.begin() + to, 'L');
    }
    /// In every frame from `from` up to before `to`.
    void ExpectLocked(const std::string& side, int from, int to) const {
        EXPECT_EQ(Locked(side, from, to), to - from) << side << ": " << seam_.at(side);
    }
    void ExpectNeverLocked(const std::string& side, int from, int to) const {
        EXPECT_EQ(Locked(side, from, to), 0) << side << ": " << seam_.at(side);
    }
    void ExpectStatesOfCoupling() const {
        constexpr int kCoupled = 75, kUncoupled = 195;
        for (const char* side : {"left", "right"}) {
            EXPECT_EQ(seam_.at(side).substr(0, kCoupled), std::string(kCoupled, 'N'));
            ExpectLocked(side, kCoupled + kSecond, kUncoupled);
            EXPECT_EQ(seam_.at(side).substr(kUncoupled + kHold),
                      std::string(static_cast<std::size_t>(frames_ - kUncoupled - kHold), 'N'));
            ExpectNeverLocked(side, kUncoupled, frames_);
        }
    }
    void ExpectStatesOfLostCameras() const {
        ExpectNeverLocked("left", 60, 120);
        ExpectLocked("left", 120 + kSecond, frames_);
        ExpectLocked("right", 240 + kSecond, frames_);
    }
    void ExpectNoDrift() const {
        for (const char* side : {"left", "right"}) {
            const json& seam = safety_["seam"][side];
            EXPECT_LE(seam["placement_error_last_second_px"].get<double>(),
                      seam["placement_error_first_second_px"].get<double>() + 1)
                << side;
        }
    }

    tests::TemporaryFolder folder_;
    json safety_;
    std::map<std::string, std::string> seam_;
    int frames_ = 0;
};

TEST_P(ScenarioSafetyTest, KeepsItsPromisesInEveryFrame) {
    EXPECT_EQ(safety_["frames"], frames_);
    EXPECT_EQ(safety_["folded_cells"], 0);
    EXPECT_LE(safety_["largest_offset_share"].get<double>(), 1) << safety_["offset_shares"];
    EXPECT_LE(safety_["largest_locked_jump_px"].get<double>(), kMostJump_px) << safety_["seam"];
    EXPECT_EQ(safety_["stale_bytes"], 0);
    EXPECT_GT(safety_["pictures_compared"], 0);
    EXPECT_EQ(safety_["frames_locked_away"], 0);
    for (const char* side : {"left", "right"}) {
        const std::string& states = seam_.at(side);
        ASSERT_EQ(states.size(), static_cast<std::size_t>(frames_));
        int last_lock = -frames_;
        for (int i = 1; i < frames_; ++i) {
            const auto at = static_cast<std::size_t>(i);
            if (states[at] != 'L' || states[at - 1] == 'L') continue;
            EXPECT_GT(i - last_lock, kHold) << side << ' ' << i;
            last_lock = i;
        }
    }
    if (GetParam() == "coupling") {
        ExpectStatesOfCoupling();
    } else if (GetParam() == "camera_lost") {
        ExpectStatesOfLostCameras();
    } else if (GetParam() == "standing_still") {
        for (const char* side : {"left", "right"}) ExpectLocked(side, 1, frames_);
        ExpectNoDrift();
    } else if (GetParam() == "truck_in_overlap") {
        ExpectLocked("right", 1, frames_);
    }
}

std::vector<std::string> Names() {
    std::vector<std::string> names;
    for (const drivers::Scenario& scenario : drivers::Scenarios())
        names.emplace_back(scenario.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(Drives, ScenarioSafetyTest, testing::ValuesIn(Names()),
                         [](const auto& drive) { return drive.param; });

}  // namespace
}  // namespace hitchview::app

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/replay_verb.hpp"
#include "tests/support/plane_rig_files.hpp"
#include "tests/support/shown_panoramas.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using algo::Unit;
using testing::HasSubstr;
using tests::KeptPanorama;
using tests::PlaneRigFiles;
using tests::RunAndKeep;

/// Root mean square second difference of where the middle of the tractor's view is shown.
double TractorJitter(const std::vector<KeptPanorama>& kept, const std::string& axis) {
    const int row = axis == "x" ? 0 : 1;
    const auto at = [&](std::size_t i) {
        return (kept[i].composition.M_canvas_view[Unit::kTractor] * Eigen::Vector3d(160, 120, 1))
            .hnormalized()[row];
    };
    double sum = 0;
    for (std::size_t i = 2; i < kept.size(); ++i)
        sum += std::pow(at(i) - 2 * at(i - 1) + at(i - 2), 2);
    return std::sqrt(sum / static_cast<double>(kept.size() - 2));
}

TEST(OfflineRunTest, EachFrameSetIsShownOnceAndInOrder) {
    const PlaneRigFiles rig(3);
    for (const auto coupling : {algo::Coupling::kCorrected, algo::Coupling::kLiteral}) {
        const auto kept = RunAndKeep(rig.Rig(), {.offline = true, .coupling = coupling});
        ASSERT_EQ(kept.size(), PlaneRigFiles::kFrames);
        for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i].sequence, i);
        EXPECT_EQ(kept.back().composition.seams[algo::Overlap::kRight], algo::SeamState::kLocked);
    }
}

TEST(OfflineRunTest, TheCouplingDecidesWhetherTheViewIsMovedAgainstItsShake) {
    const PlaneRigFiles rig(3);
    const auto corrected = RunAndKeep(rig.Rig(), {.offline = true});
    const auto literal =
        RunAndKeep(rig.Rig(), {.offline = true, .coupling = algo::Coupling::kLiteral});
    for (const char* axis : {"x", "y"}) {
        EXPECT_GT(TractorJitter(corrected, axis), 2.0) << "against a shake of 3 px";
        EXPECT_LT(TractorJitter(literal, axis), 0.2) << "it stays, and its content shakes";
    }
}

TEST(OfflineRunTest, ThePanoramaIsTheSameOnAnyNumberOfWorkers) {
    const PlaneRigFiles rig(3);
    const auto alone = RunAndKeep(rig.Rig(), {.workers = 1, .offline = true});
    const auto shared = RunAndKeep(rig.Rig(), {.workers = 3, .offline = true});
    ASSERT_EQ(alone.size(), shared.size());
    for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_TRUE(alone[i].bytes == shared[i].bytes);
}

TEST(OfflineRunTest, BothPassesTellHowFarTheyAre) {
    const PlaneRigFiles rig(1);
    std::vector<std::string> told;
    const auto listen = [&](const char* step, std::uint64_t frames) {
        told.push_back(std::string(step) + ' ' + std::to_string(frames));
    };
    RunAndKeep(rig.Rig(), {.frames = 2, .offline = true, .progress = listen});
    EXPECT_THAT(told, testing::ElementsAre("learnt 1", "learnt 2", "shown 1", "shown 2"));
}

TEST(OfflineRunTest, ARunEndsAfterTheFramesAskedFor) {
    const PlaneRigFiles rig(1);
    EXPECT_EQ(RunAndKeep(rig.Rig(), {.frames = 5, .offline = true}).size(), 5U);
}

TEST(OfflineRunTest, AReportAndVideosAreWrittenAsInAnyReplay) {
    const PlaneRigFiles rig(2);
    const std::string out = rig.folder() / "out";
    const std::atomic<bool> stop{false};
    testing::internal::CaptureStdout();
    const ReplayOptions options{.rig = rig.Rig(),
                                .run = {.out = out, .offline = true, .write_views = true}};
    EXPECT_EQ(ReplayVerb(options, stop), 0);
    testing::internal::GetCapturedStdout();
    const auto report = nlohmann::json::parse(tests::FileText(out + "/report.json"));
    EXPECT_EQ(report.at("frames"), PlaneRigFiles::kFrames);
    EXPECT_EQ(report.at("seams").at("right").at("locked_share"), 1);
    EXPECT_TRUE(std::filesystem::exists(out + "/tractor.avi"));
    EXPECT_TRUE(std::filesystem::exists(out + "/trailer.avi"));
}

std::string Refusal(const ReplayOptions& options) {
    const std::atomic<bool> stop{false};
    testing::internal::CaptureStderr();
    EXPECT_EQ(ReplayVerb(options, stop), 2);
    return testing::internal::GetCapturedStderr();
}

TEST(OfflineRunTest, OptionsThatContradictItAreRefused) {
    const PlaneRigFiles rig(0);
    EXPECT_THAT(Refusal({.rig = rig.Rig(), .run = {.offline = true, .realtime = true}}),
                HasSubstr("not with --realtime"));
    EXPECT_THAT(Refusal({.rig = rig.Rig(), .run = {.lookahead_frames = 3, .offline = true}}),
                HasSubstr("not with --lookahead"));
    EXPECT_THAT(Refusal({.rig = rig.Rig(), .coupling = "literal"}),
                HasSubstr("--coupling needs --offline"));
}

}  // namespace
}  // namespace hitchview::app

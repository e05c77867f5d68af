#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/log_rig.hpp"
#include "tests/support/logged_drive.hpp"
#include "tests/support/shown_panoramas.hpp"
#include "tests/support/simulated_rig_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using testing::HasSubstr;
using tests::KeptPanorama;
using tests::RecordedDrive;
using tests::RunAndKeep;

constexpr int kFrames = 8;
const std::atomic<bool> kGoOn{false};

void ExpectSame(const std::vector<KeptPanorama>& a, const std::vector<KeptPanorama>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].sequence, b[i].sequence);
        EXPECT_TRUE(a[i].bytes == b[i].bytes) << "panorama " << i << " differs";
    }
}

/// A small drive of the simulated tractor-trailer, the same for all tests, and its recording.
class LogReplayTest : public testing::Test {
 protected:
    static void SetUpTestSuite() {
        folder_ = new tests::TemporaryFolder;
        tests::WriteSimulatedCalibration(*folder_, 320, 180);
        drive_ = new RecordedDrive(tests::RecordDrive(RigFile()));
    }
    static void TearDownTestSuite() {
        delete drive_;
        delete folder_;
    }

    static std::string RigFile() {
        const std::string units =
            tests::SimulatedUnits([](const std::string&) { return "{simulated: true}"; });
        return folder_->Write("rig.yaml",
                              "schema: 1\n"
                              "canvas: {projection: cylinder, size_px: [1024, 180]}\n"
                              "calibration: rig.calib.yaml\n" +
                                  units + "simulation: {frames: " + std::to_string(kFrames) +
                                  ", camera_size_px: [320, 180]}\ncan:\n  source: {simulated: "
                                  "true}\n" +
                                  tests::kSimulatedHitchAngle);
    }
    static const RecordedDrive& drive() { return *drive_; }
    static const tests::TemporaryFolder& folder() { return *folder_; }

    static hal::Checked<RigConfig> Loaded(const std::string& log) {
        return LoadLogRig({.logs = {log}}, kGoOn);
    }

 private:
    static tests::TemporaryFolder* folder_;
    static RecordedDrive* drive_;
};

tests::TemporaryFolder* LogReplayTest::folder_ = nullptr;
RecordedDrive* LogReplayTest::drive_ = nullptr;

TEST_F(LogReplayTest, ThePanoramaOfARawRecordingIsThatOfTheDrive) {
    const std::string log = folder() / "raw.lcm";
    drive().Write(log);
    const auto driven = RunAndKeep(RigFile());
    ASSERT_EQ(driven.size(), kFrames);
    for (const int workers : {1, 2, 4})
        ExpectSame(driven, RunAndKeep(Loaded(log), {.workers = workers}));
    ExpectSame(driven, RunAndKeep(Loaded(log), {.realtime = true}));
}

}  // namespace
}  // namespace hitchview::app

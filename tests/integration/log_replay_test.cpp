#include "app/log_replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "app/log_recording.hpp"
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
        drive_ = new RecordedDrive(tests::RecordDrive(RigFile()));
    }
    static void TearDownTestSuite() {
        delete drive_;
        delete folder_;
    }

    static std::string RigFile() { return tests::WriteDriveRig(*folder_, kFrames); }
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

/// A board's frame sets, without what is in the pictures.
struct SetSummary {
    std::uint32_t sequence = 0;
    std::uint32_t cameras_missing = 0;

    bool operator==(const SetSummary&) const = default;
};

std::vector<SetSummary> SetsOf(const hal::Checked<RigConfig>& config) {
    std::vector<SetSummary> sets;
    EXPECT_TRUE(config) << config.error();
    if (!config) return sets;
    auto board = std::move(*Board::Open(config.value(), {.held_frames = 2}));
    while (const auto set = board->sets().WaitSet())
        sets.push_back({set.value().sequence, set.value().cameras_missing});
    return sets;
}

TEST_F(LogReplayTest, ThePanoramaOfARawRecordingIsThatOfTheDrive) {
    const std::string log = folder() / "raw.lcm";
    drive().Write(log);
    const auto driven = RunAndKeep(RigFile());
    ASSERT_EQ(driven.size(), kFrames);
    for (const int workers : {1, 2, 4})
        ExpectSame(driven, RunAndKeep(Loaded(log), {.workers = workers}));
    ExpectSame(driven, RunAndKeep(Loaded(log), {.realtime = true, .speed = 0.2}));
}

TEST_F(LogReplayTest, OfflineItIsThatOfTheDriveToo) {
    const std::string log = folder() / "raw.lcm";
    drive().Write(log);
    ExpectSame(RunAndKeep(RigFile(), {.offline = true}),
               RunAndKeep(Loaded(log), {.offline = true}));
}

TEST_F(LogReplayTest, ThePanoramaOfACompressedRecordingIsTheSameOnAnyNumberOfWorkers) {
    const std::string log = folder() / "jpeg.lcm";
    Compressed(drive()).Write(log);
    const auto alone = RunAndKeep(Loaded(log), {.workers = 1});
    ASSERT_EQ(alone.size(), kFrames);
    for (const int workers : {2, 4})
        ExpectSame(alone, RunAndKeep(Loaded(log), {.workers = workers}));
}

TEST_F(LogReplayTest, TwoSegmentsAreOneRecording) {
    const std::string log = folder() / "whole.lcm";
    drive().Write(log);
    const tests::TemporaryFolder segments;
    RecordedDrive first = drive();
    RecordedDrive second = drive();
    const auto half = static_cast<std::ptrdiff_t>(drive().pictures.size() / 2 + 3);
    first.pictures.erase(first.pictures.begin() + half, first.pictures.end());
    second.pictures.erase(second.pictures.begin(), second.pictures.begin() + half);
    first.Write(segments / "20231114T221320Z-0000.lcm");
    second.Write(segments / "20231114T221320Z-0001.lcm");
    ExpectSame(RunAndKeep(Loaded(log)), RunAndKeep(Loaded(segments.path())));
}

TEST_F(LogReplayTest, ADamagedPictureIsAMissingCameraOfItsSet) {
    const std::string log = folder() / "damaged.lcm";
    RecordedDrive drive = Compressed(this->drive());
    auto& data = drive.pictures[3 * drive.cameras.size() + 2].picture.data;
    data.resize(data.size() / 2);
    drive.Write(log);
    std::vector<SetSummary> expected;
    for (std::uint32_t i = 0; i < kFrames; ++i) expected.push_back({i, i == 3 ? 1U << 2 : 0});
    EXPECT_EQ(SetsOf(Loaded(log)), expected);
    EXPECT_EQ(RunAndKeep(Loaded(log)).size(), kFrames);
}

TEST_F(LogReplayTest, AReplayOfAPartBeginsAndEndsThere) {
    const std::string log = folder() / "part.lcm";
    drive().Write(log);
    // The rig is logged half a second before the first frame.
    const double first_s = 0.5 + 2.5 * drive().period_ms / 1e3;
    const double end_s = 0.5 + 5.5 * drive().period_ms / 1e3;
    const auto seconds = SetsOf(LoadLogRig(
        {.logs = {log}, .from = std::to_string(first_s), .to = std::to_string(end_s)}, kGoOn));
    EXPECT_EQ(seconds, (std::vector<SetSummary>{{0, 0}, {1, 0}, {2, 0}}));
    const auto ends = SetsOf(LoadLogRig({.logs = {log}, .to = "2023-11-14T22:13:20.52Z"}, kGoOn));
    EXPECT_EQ(ends, (std::vector<SetSummary>{{0, 0}}));
}

TEST_F(LogReplayTest, ARigOfItsOwnTakesTheCamerasOfALogWithoutOne) {
    const std::string log = folder() / "others.lcm";
    {
        tests::MessageLog messages(log);
        for (const tests::DriveMessage& message : drive().pictures)
            messages.Picture(message.channel, message.picture);
    }
    EXPECT_THAT(Loaded(log).error(),
                HasSubstr("others.lcm: no rig is recorded in it: say with --rig"));
    ExpectSame(RunAndKeep(RigFile()),
               RunAndKeep(LoadLogRig({.logs = {log}, .rig = RigFile()}, kGoOn)));
}

TEST_F(LogReplayTest, CamerasMayNameTheLogInTheRigFile) {
    drive().Write(folder() / "drive.lcm");
    const std::string rig = folder().Write(
        "replay.yaml",
        "schema: 1\ncanvas: {projection: cylinder, size_px: [1024, 180]}\n"
        "calibration: rig.calib.yaml\n" +
            tests::SimulatedUnits([](const std::string&) { return "{replay: drive.lcm}"; }));
    const auto driven = RunAndKeep(RigFile());
    ExpectSame(driven, RunAndKeep(rig));

    // A log for each camera is as good.
    for (const std::string& channel : drive().channels) {
        RecordedDrive alone = drive();
        std::erase_if(alone.pictures,
                      [&](const tests::DriveMessage& m) { return m.channel != channel; });
        alone.Write(folder() / (channel + ".lcm"));
    }
    const std::string logs =
        folder().Write("logs.yaml",
                       "schema: 1\ncanvas: {projection: cylinder, size_px: [1024, 180]}\n"
                       "calibration: rig.calib.yaml\n" +
                           tests::SimulatedUnits([](const std::string& name) {
                               return "{replay: " + CameraChannel(name) + ".lcm}";
                           }));
    ExpectSame(driven, RunAndKeep(logs));
}

TEST_F(LogReplayTest, TheDevicesOfARecordedLiveRigAreNotAskedFor) {
    RecordedDrive live = drive();
    live.texts.rig =
        "schema: 1\ncanvas: {projection: cylinder, size_px: [1024, 180]}\n"
        "calibration: gone.yaml\nset_tolerance_ms: 20\n" +
        tests::SimulatedUnits([](const std::string& name) {
            return "{v4l2: /dev/gone/" + name + ", format: uyvy}";
        }) +
        "can:\n  source: {socketcan: gone0}\n  hitch_angle: {dbc: gone.dbc, message: A, "
        "signal: B}\n";
    const std::string log = folder() / "live.lcm";
    live.Write(log);
    testing::internal::CaptureStderr();
    const auto loaded = Loaded(log);
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                HasSubstr("the DBC file of the rig is not"));
    ExpectSame(RunAndKeep(RigFile()), RunAndKeep(loaded));
}

TEST_F(LogReplayTest, WhatIsMissingIsSaid) {
    const std::string log = folder() / "missing.lcm";
    const auto error = [&](const RecordedDrive& drive) {
        drive.Write(log);
        return Loaded(log).error();
    };
    RecordedDrive wrong = drive();
    std::erase_if(wrong.pictures, [](const tests::DriveMessage& m) { return m.camera == 4; });
    EXPECT_THAT(error(wrong),
                HasSubstr("missing.lcm: camera left_rear: channel CAM_LEFT_REAR has no picture"));

    wrong = drive();
    for (tests::DriveMessage& message : wrong.pictures)
        if (message.camera == 1) message.picture.fourcc = BOT_CORE_IMAGE_T_PIXEL_FORMAT_RGB;
    EXPECT_THAT(error(wrong), HasSubstr("channel CAM_LEFT_FRONT has pictures of 320x180 RGB3"));

    wrong = drive();
    wrong.texts.calibration_id = "0123456789ab";
    EXPECT_THAT(error(wrong), HasSubstr("must be 0123456789ab, which the recording states"));

    wrong = drive();
    wrong.texts.rig += "wheels: 18\n";
    EXPECT_THAT(error(wrong),
                testing::ContainsRegex("missing.lcm \\(rig file\\):[0-9]+: wheels is no key"));

    wrong = drive();
    wrong.texts.calibration.clear();
    EXPECT_THAT(error(wrong), HasSubstr("the recording has no calibration"));

    drive().Write(log);
    EXPECT_THAT(LoadLogRig({.logs = {log}, .from = "soon"}, kGoOn).error(),
                HasSubstr("--from is soon, must be seconds since the start"));
    EXPECT_THAT(LoadLogRig({.logs = {log}, .from = "3", .to = "2"}, kGoOn).error(),
                HasSubstr("--to is 2, must be later than --from"));
}

TEST_F(LogReplayTest, ACameraThatBecomesAnotherOneEndsTheReplay) {
    const std::string log = folder() / "changed.lcm";
    RecordedDrive drive = this->drive();
    tests::DriveMessage other = drive.pictures[drive.pictures.size() - drive.cameras.size()];
    other.picture.height_px /= 2;
    for (int i = 0; i < LogReplay::kMostOthers; ++i) {
        other.picture.captured_ns += 33'333'333;
        drive.pictures.push_back(other);
    }
    drive.Write(log);
    testing::internal::CaptureStderr();
    const auto summary = RunRig(Loaded(log).value(), {}, kGoOn);
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                HasSubstr("camera front: the pictures of channel CAM_FRONT change"));
    ASSERT_FALSE(summary.ok());
    EXPECT_EQ(summary.error(), "a camera gives no more frames: failed");
}

TEST_F(LogReplayTest, ARecordingThatChangesItsCalibrationEnds) {
    const tests::TemporaryFolder segments;
    drive().Write(segments / "0.lcm");
    RecordedDrive other = drive();
    other.texts.calibration_id = "0123456789ab";
    other.Write(segments / "1.lcm");
    EXPECT_TRUE(RunRig(Loaded(segments.path()).value(), {}, kGoOn).ok()) << "that was damage";

    auto calibration = calib::ParseCalibration(other.texts.calibration, "").calibration.value();
    calibration.vehicle = "another";
    other.texts.calibration = calib::ToYaml(calibration);
    other.texts.calibration_id = calibration.id();
    other.Write(segments / "1.lcm");
    testing::internal::CaptureStderr();
    EXPECT_FALSE(RunRig(Loaded(segments.path()).value(), {}, kGoOn).ok());
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                HasSubstr("goes on with another calibration"));
}

TEST_F(LogReplayTest, TheHitchAngleIsDecodedAgain) {
    const auto published = [&](const hal::Checked<RigConfig>& loaded, const std::string& name) {
        RigConfig config = loaded.value();
        const std::string file = folder() / name;
        config.publish.url = "file://" + file + "?mode=w";
        EXPECT_TRUE(RunRig(config, {.publish = true}, kGoOn).ok());
        std::vector<double> angles_rad;
        LogRecording recording({file}, kGoOn);
        while (const auto event = recording.Next()) {
            const auto angle = drivers::ParseLoggedHitchAngle(event.value().data);
            if (angle) angles_rad.push_back(angle.value().angle.angle_rad);
        }
        return angles_rad;
    };
    const std::string log = folder() / "can.lcm";
    drive().Write(log);
    const auto driven = published(LoadRigConfig(RigFile()), "driven.lcm");
    const auto replayed = published(Loaded(log), "replayed.lcm");
    ASSERT_GT(driven.size(), 5U);
    EXPECT_THAT(replayed, testing::ElementsAreArray(driven));
}

TEST_F(LogReplayTest, NoDamageKeepsItFromItsEnd) {
    const std::string whole = folder() / "sound.lcm";
    Compressed(drive()).Write(whole);
    const std::string sound = tests::FileText(whole);
    const std::string log = folder() / "random.lcm";
    std::mt19937 random(7);
    int opened = 0;
    for (int i = 0; i < 100; ++i) {
        std::string bytes = sound;
        const auto places = static_cast<unsigned>(1 + random() % 20);
        for (unsigned place = 0; place < places; ++place) {
            const std::size_t at = random() % bytes.size();
            const std::size_t count = std::min<std::size_t>(random() % 2000, bytes.size() - at);
            for (std::size_t k = at; k < at + count; ++k)
                bytes[k] = static_cast<char>(random() % 3 == 0 ? 0 : random());
        }
        if (random() % 4 == 0) bytes.resize(random() % bytes.size() + 1);
        folder().Write("random.lcm", bytes);
        const auto loaded =
            i % 2 == 0 ? Loaded(log) : LoadLogRig({.logs = {log}, .rig = RigFile()}, kGoOn);
        if (!loaded) continue;
        ++opened;
        const std::size_t sets = SetsOf(loaded).size();
        EXPECT_GE(sets, 1U);
        EXPECT_LE(sets, kFrames + 2 * places);
    }
    EXPECT_GT(opened, 60);
}

}  // namespace
}  // namespace hitchview::app

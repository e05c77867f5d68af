#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>

#include "app/candump_writer.hpp"
#include "app/export_verb.hpp"
#include "app/ffmpeg_pipe.hpp"
#include "app/log_export.hpp"
#include "drivers/candump_can_bus.hpp"
#include "tests/support/log_messages.hpp"
#include "tests/support/mcap_reader.hpp"
#include "tests/support/random_can.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using testing::HasSubstr;
using tests::LoggedPicture;
using tests::MessageLog;

const std::atomic<bool> kGoOn{false};
constexpr std::int64_t kPeriod_ns = 40'000'000;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// A JPEG of one grey.
LoggedPicture Grey(int grey, std::int64_t captured_ns, std::uint32_t sequence) {
    LoggedPicture picture{
        .captured_ns = captured_ns, .sequence = sequence, .width_px = 64, .height_px = 32};
    cv::imencode(".jpg", cv::Mat(32, 64, CV_8UC3, cv::Scalar::all(grey)), picture.data);
    return picture;
}

std::vector<std::filesystem::path> FilesIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

class LogExportTest : public testing::Test {
 protected:
    tests::TemporaryFolder folder_;
    std::string file_ = folder_ / "log.lcm";
    std::filesystem::path out_ = folder_ / "out";
};

TEST_F(LogExportTest, ACandumpLogComesBackLineForLine) {
    tests::RandomCan random(1);
    std::string candump;
    CandumpLine line("can0");
    for (int i = 0; i < 300; ++i) {
        hal::CanFrame frame = random.Frame();
        frame.epoch = std::chrono::microseconds(1'700'000'000'000'000 + 1234 * i);
        candump += line.Format(frame);
    }
    const std::string input = folder_.Write("can.log", candump);
    {
        MessageLog log(file_);
        log.epoch_ns = 0;
        auto bus = drivers::CandumpCanBus::Open(input, {}, drivers::CandumpCanBus::Kinds::kAll);
        while (auto frame = (*bus)->WaitFrame(std::chrono::seconds(1))) {
            frame->received_at = frame->epoch;
            log.Can(frame.value());
        }
    }
    EXPECT_EQ(ExportVerb({.logs = {file_}, .candump = out_}, kGoOn), 0);
    EXPECT_EQ(tests::FileText(out_), candump);
}

TEST_F(LogExportTest, StatusBecomesATableWithTheHitchAngleBesideIt) {
    {
        MessageLog log(file_);
        log.epoch_ns = 0;
        log.Status(kSecond_ns, 1, 0.5);
        log.HitchAngle(kSecond_ns, 0, hal::HitchAngleQuality::kValid, 0.25);
        log.Status(2 * kSecond_ns, 2, std::nan(""));
        log.HitchAngle(2 * kSecond_ns, 1, hal::HitchAngleQuality::kStale, std::nan(""));
        log.Status(3 * kSecond_ns, 3, 0.5);
    }
    EXPECT_EQ(ExportVerb({.logs = {file_}, .csv = out_}, kGoOn), 0);
    std::istringstream lines(tests::FileText(out_));
    std::vector<std::string> read;
    for (std::string line; std::getline(lines, line);) read.push_back(line);
    ASSERT_EQ(read.size(), 4U);
    const auto cells = [](const std::string& line) { return std::ranges::count(line, ',') + 1; };
    for (const std::string& line : read) EXPECT_EQ(cells(line), cells(read[0])) << line;
    EXPECT_EQ(read[1],
              "1970-01-01T00:00:01.000000Z,1000000,1,1000000000,40.000,7.000,0x5,NO_OVERLAP,LOCKED,"
              "0,0,0,0,12.500,0,0,28.6479,0.0000,");
    EXPECT_THAT(read[2], testing::EndsWith(",0,0,,0.0000,14.3239"));
    EXPECT_THAT(read[3], testing::EndsWith(",28.6479,0.0000,"));
}

TEST_F(LogExportTest, PicturesOfEveryFormatBecomePngFilesOfTheSameColour) {
    // One colour in each format, BT.601: Y 149, U 43, V 21 is green, 150 in all of grey.
    const auto repeated = [](std::vector<std::uint8_t> unit, std::size_t times) {
        std::vector<std::uint8_t> all;
        for (; times > 0; --times) all.insert(all.end(), unit.begin(), unit.end());
        return all;
    };
    constexpr std::size_t kPixels = std::size_t{16} * 8;
    std::vector<std::uint8_t> nv12 = repeated({149}, kPixels);
    const std::vector<std::uint8_t> chroma = repeated({43, 21}, kPixels / 4);
    nv12.insert(nv12.end(), chroma.begin(), chroma.end());
    const std::vector<LoggedPicture> pictures{
        {.fourcc = BOT_CORE_IMAGE_T_PIXEL_FORMAT_UYVY,
         .data = repeated({43, 149, 21, 149}, kPixels / 2)},
        {.fourcc = BOT_CORE_IMAGE_T_PIXEL_FORMAT_YUYV,
         .data = repeated({149, 43, 149, 21}, kPixels / 2)},
        {.fourcc = BOT_CORE_IMAGE_T_PIXEL_FORMAT_NV12, .data = nv12},
        {.fourcc = BOT_CORE_IMAGE_T_PIXEL_FORMAT_UYVY,
         .data = repeated({54, 144, 34, 144}, kPixels / 2),  // the same in the limited range
         .range = "limited"},
    };
    {
        MessageLog log(file_);
        for (const LoggedPicture& picture : pictures) log.Picture("CAM_SIDE", picture);
        log.Picture("CAM_OTHER", Grey(0, 0, 0));
        log.Picture("CAM_SIDE", {.fourcc = BOT_CORE_IMAGE_T_PIXEL_FORMAT_UYVY, .data = {1, 2}});
    }
    EXPECT_EQ(ExportVerb({.logs = {file_}, .frames = out_, .camera = "side"}, kGoOn), 0);
    const auto files = FilesIn(out_);
    ASSERT_EQ(files.size(), pictures.size());
    for (const auto& file : files) {
        const cv::Mat picture = cv::imread(file.string());
        ASSERT_EQ(picture.size(), cv::Size(16, 8));
        const cv::Scalar green(0, 254, 0);
        EXPECT_LE(cv::norm(cv::mean(picture) - green, cv::NORM_INF), 4) << cv::mean(picture);
    }
}

TEST_F(LogExportTest, FrameNamesTellNumberAndTime) {
    {
        MessageLog log(file_);
        log.Picture("PANORAMA", Grey(100, 0, 0));
        log.Picture("PANORAMA", Grey(100, kPeriod_ns, 1));
    }
    EXPECT_EQ(ExportVerb({.logs = {file_}, .frames = out_}, kGoOn), 0);
    EXPECT_EQ(FilesIn(out_).back().filename(), "000001_1700000000040000.png");
}

TEST_F(LogExportTest, AVideoShowsEachPanoramaInItsTime) {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
    {
        // Dark for ten periods, five are missing, then bright.
        MessageLog log(file_);
        for (std::uint32_t i = 0; i < 10; ++i) log.Picture("PANORAMA", Grey(50, i * kPeriod_ns, i));
        for (std::uint32_t i = 15; i < 20; ++i)
            log.Picture("PANORAMA", Grey(200, i * kPeriod_ns, i));
        log.Picture("PANORAMA", {.captured_ns = 20 * kPeriod_ns, .sequence = 20});
    }
    const std::string video = folder_ / "-odd name.mp4";
    EXPECT_EQ(ExportVerb({.logs = {file_}, .mp4 = video}, kGoOn), 0);
    cv::VideoCapture capture(video);
    EXPECT_NEAR(capture.get(cv::CAP_PROP_FPS), 25, 1e-3);
    std::vector<double> greys;
    for (cv::Mat frame; capture.read(frame);) greys.push_back(cv::mean(frame)[0]);
    ASSERT_EQ(greys.size(), 20U);
    for (std::size_t i = 0; i < greys.size(); ++i)
        EXPECT_NEAR(greys[i], i < 15 ? 50 : 200, 6) << "frame " << i;
}

TEST_F(LogExportTest, AVideoShortensPausesToTwoSecondsAndFollowsAClockThatBeginsAnew) {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
    {
        MessageLog log(file_);
        for (const std::int64_t period : {0, 1, 90'000, 90'001, 0, 1})
            log.Picture("PANORAMA", Grey(50, period * kPeriod_ns, 0));
    }
    const std::string video = folder_ / "video.mp4";
    EXPECT_EQ(ExportVerb({.logs = {file_}, .mp4 = video}, kGoOn), 0);
    cv::VideoCapture capture(video);
    int frames = 0;
    for (cv::Mat frame; capture.read(frame);) ++frames;
    constexpr int kTwoSeconds = 50;
    EXPECT_EQ(frames, 6 + kTwoSeconds);
}

TEST_F(LogExportTest, WithoutFfmpegItIsSaidWhatToInstall) {
    const auto video = FfmpegPipe::Start(out_, {.size_px = {64, 32}, .program = "no-ffmpeg-here"});
    ASSERT_FALSE(video.ok());
    EXPECT_THAT(video.error(), HasSubstr("apt install ffmpeg"));
}

void WriteMixedLog(const std::string& file, int pictures) {
    MessageLog log(file);
    for (int i = 0; i < pictures; ++i)
        log.Picture("CAM_SIDE", Grey(100, i * kPeriod_ns, static_cast<std::uint32_t>(i)));
    log.Picture("PANORAMA", Grey(200, kPeriod_ns, 7));
    log.Status(kPeriod_ns, 7, std::nan(""));
    log.Event(2 * kPeriod_ns, 0, 1, "side", "gone \xFF");
    hal::CanFrame frame{.id = 0x18FEF1FE, .extended = true, .size_bytes = 2};
    frame.data = {0xAB, 0x01};
    log.Can(frame);
}

TEST_F(LogExportTest, AnMcapFileHoldsEverythingAndItsIndexesLeadToIt) {
    WriteMixedLog(file_, 3);
    EXPECT_EQ(ExportVerb({.logs = {file_}, .mcap = out_}, kGoOn), 0);
    const tests::McapReader mcap(tests::FileText(out_));
    ASSERT_EQ(mcap.messages.size(), 7U);
    EXPECT_EQ(mcap.counted_messages, 7U);
    std::map<std::string, tests::McapMessage> last_of;
    for (const auto& message : mcap.messages) last_of[message.topic] = message;

    const auto status = nlohmann::json::parse(last_of["PANORAMA_STATUS"].data);
    EXPECT_EQ(status["seam_right"], "LOCKED");
    EXPECT_FALSE(status.contains("articulation_deg"));
    EXPECT_EQ(last_of["PANORAMA_STATUS"].log_time_ns, 1'700'000'000'040'000'000U);
    EXPECT_EQ(nlohmann::json::parse(last_of["PANORAMA_EVENT"].data)["name"], "side");
    EXPECT_EQ(nlohmann::json::parse(last_of["CAN_RX"].data)["data"], "AB01");
    for (const auto& [id, schema] : mcap.schemas) {
        if (schema.encoding != "jsonschema") continue;
        EXPECT_EQ(nlohmann::json::parse(schema.definition)["title"], schema.name);
    }
}

TEST_F(LogExportTest, AnMcapPictureIsTheJpegOfTheLogWithTheDefinitionThatExplainsIt) {
    WriteMixedLog(file_, 1);
    EXPECT_EQ(ExportVerb({.logs = {file_}, .mcap = out_, .camera = "side"}, kGoOn), 0);
    const tests::McapReader mcap(tests::FileText(out_));
    const tests::McapMessage& picture = mcap.messages.front();
    ASSERT_EQ(picture.topic, "CAM_SIDE");
    const auto jpeg = Grey(100, 0, 0).data;
    const auto fields = tests::ProtobufFields(picture.data);
    EXPECT_EQ(fields[1], std::pair(2, std::string(jpeg.begin(), jpeg.end())));
    EXPECT_EQ(fields[2], std::pair(3, std::string("jpeg")));
    EXPECT_EQ(fields[3], std::pair(4, std::string("CAM_SIDE")));
    EXPECT_EQ(tests::ProtobufFields(fields[0].second)[0], std::pair(1, std::string("1700000000")));

    // FileDescriptorSet: files; in each (4) messages; in each (2) fields with name (1) and number.
    std::map<std::string, std::string> numbers;
    for (const auto& [set_field, file] : tests::ProtobufFields(mcap.schemas.at(1).definition))
        for (const auto& [file_field, message] : tests::ProtobufFields(file)) {
            if (file_field != 4) continue;
            for (const auto& [message_field, field] : tests::ProtobufFields(message))
                if (message_field == 2)
                    numbers[tests::ProtobufFields(field)[0].second] =
                        tests::ProtobufFields(field)[1].second;
        }
    const std::map<std::string, std::string> expected{{"seconds", "1"},   {"nanos", "2"},
                                                      {"timestamp", "1"}, {"data", "2"},
                                                      {"format", "3"},    {"frame_id", "4"}};
    EXPECT_EQ(numbers, expected);
    for (const auto& message : mcap.messages) EXPECT_NE(message.topic, "PANORAMA");
}

TEST_F(LogExportTest, ALongMcapFileHasSeveralChunks) {
    {
        MessageLog log(file_);
        LoggedPicture picture = Grey(100, 0, 0);
        picture.data.resize(1 << 20);
        for (int i = 0; i < 10; ++i) {
            picture.captured_ns = i * kPeriod_ns;
            log.Picture("CAM_SIDE", picture);
        }
    }
    EXPECT_EQ(ExportVerb({.logs = {file_}, .mcap = out_}, kGoOn), 0);
    const tests::McapReader mcap(tests::FileText(out_));
    EXPECT_EQ(mcap.chunks, 3U);
    EXPECT_EQ(mcap.messages.size(), 10U);
}

TEST_F(LogExportTest, ARecordingIsNotOverwritten) {
    WriteMixedLog(file_, 1);
    const std::string before = tests::FileText(file_);
    EXPECT_EQ(ExportVerb({.logs = {folder_.path()}, .csv = file_}, kGoOn), 2);
    EXPECT_EQ(tests::FileText(file_), before);
}

TEST_F(LogExportTest, NothingOfThatKindIsSaidByTheExitCode) {
    WriteMixedLog(file_, 1);
    EXPECT_EQ(ExportVerb({.logs = {file_}, .frames = out_, .camera = "absent"}, kGoOn), 1);
    EXPECT_EQ(ExportVerb({.logs = {folder_ / "absent"}, .csv = out_}, kGoOn), 2);
    EXPECT_EQ(ExportVerb({.logs = {file_}, .csv = "/nowhere/x.csv"}, kGoOn), 3);
}

}  // namespace
}  // namespace hitchview::app

#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "app/display.hpp"
#include "app/jpeg_encoder.hpp"
#include "app/jpeg_picture.hpp"
#include "app/view_verb.hpp"
#include "drivers/lcm_publisher.hpp"
#include "drivers/steady_clock.hpp"
#include "tests/support/i420_picture.hpp"

// Runs in a network namespace of its own (tests/support/lcm_namespace.sh).
namespace hitchview::app {
namespace {

using std::chrono::milliseconds;
using tests::I420Picture;

/// Publishes one picture thirty times a second until destroyed.
class Source {
 public:
    explicit Source(hal::PanoramaImage image, const std::vector<std::string>& cameras = {})
        : image_(image), publisher_(std::move(drivers::LcmPublisher::Create({}, clock_).value())) {
        for (const std::string& name : cameras)
            health_.cameras.Add({.name = std::string_view(name)});
        thread_ = std::thread([this] { Run(); });
    }
    ~Source() {
        stop_ = true;
        thread_.join();
    }
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;

 private:
    void Run() {
        for (; !stop_; ++image_.sequence) {
            image_.captured_until = clock_.Now();
            EXPECT_TRUE(publisher_->Publish(health_));
            EXPECT_TRUE(publisher_->Publish(image_));
            std::this_thread::sleep_for(milliseconds(33));
        }
    }

    drivers::SteadyClock clock_;
    hal::PanoramaImage image_;
    hal::Health health_;
    std::unique_ptr<drivers::LcmPublisher> publisher_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

TEST(LcmViewTest, TheNewestPictureIsSavedAsItWasSent) {
    const std::string path = testing::TempDir() + "newest.png";
    const auto picture = I420Picture::Waves(2048, 360, 11);
    JpegEncoder encoder(picture.format(), {});
    const auto jpeg = encoder.Encode(picture.view()).value();
    const Source source({.width_px = 2048, .height_px = 360, .jpeg = jpeg});

    EXPECT_EQ(ViewVerb({.save = path, .frames = 3}), 0);

    cv::Mat expected;
    ASSERT_TRUE(DecodeJpeg(jpeg, {2048, 360}, expected));
    const cv::Mat saved = cv::imread(path);
    std::remove(path.c_str());
    ASSERT_EQ(saved.size(), expected.size());
    EXPECT_EQ(cv::norm(saved, expected, cv::NORM_INF), 0);
}

TEST(LcmViewTest, WithoutAPictureTheVerbGivesUpAndSavesWhatItShowed) {
    const std::string path = testing::TempDir() + "none.png";
    EXPECT_EQ(ViewVerb({.save = path, .wait = milliseconds(200)}), 1);
    const cv::Mat saved = cv::imread(path);
    std::remove(path.c_str());
    ASSERT_EQ(saved.size(), cv::Size(2048, 360));
    EXPECT_EQ(cv::norm(saved, Display(milliseconds(500)).Shown({}), cv::NORM_INF), 0);
}

TEST(LcmViewTest, CamerasThatGiveNoPictureAreCalledByTheirNames) {
    const std::string path = testing::TempDir() + "degraded.png";
    const auto picture = I420Picture::Waves(2048, 360, 11);
    JpegEncoder encoder(picture.format(), {});
    const auto jpeg = encoder.Encode(picture.view()).value();
    const Source source({.width_px = 2048, .height_px = 360, .cameras_missing = 2, .jpeg = jpeg},
                        {"front", "rear"});
    // Health is sent with each picture, so it is known by the third.
    EXPECT_EQ(ViewVerb({.save = path, .frames = 4}), 0);

    Display display(milliseconds(500));
    display.SetCameraNames({"front", "rear"});
    ASSERT_TRUE(display.Update(
        {.width_px = 2048, .height_px = 360, .cameras_missing = 2, .jpeg = jpeg}, {}));
    EXPECT_EQ(display.MissingCameras(), "rear");
    const cv::Mat saved = cv::imread(path);
    std::remove(path.c_str());
    ASSERT_FALSE(saved.empty());
    EXPECT_EQ(cv::norm(saved, display.Shown({}), cv::NORM_INF), 0);
}

TEST(LcmViewTest, WrongOptionsAreWrongUse) {
    EXPECT_EQ(ViewVerb({.save = "picture.unknown"}), 2);
    EXPECT_EQ(ViewVerb({.max_age = milliseconds(1)}), 2);
    EXPECT_EQ(ViewVerb({.save = "a.png", .frames = 0}), 2);
    EXPECT_EQ(ViewVerb({.url = "udpm://1.2.3.4:5"}), 2);
    EXPECT_EQ(ViewVerb({.channel = ".*"}), 2);
}

TEST(LcmViewTest, AFileThatCannotBeWrittenIsAFailureOfTheMachine) {
    const auto picture = I420Picture::Waves(64, 32, 0);
    JpegEncoder encoder(picture.format(), {});
    const Source source(
        {.width_px = 64, .height_px = 32, .jpeg = encoder.Encode(picture.view()).value()});
    EXPECT_EQ(ViewVerb({.save = "/no/such/folder/a.png"}), 3);
}

}  // namespace
}  // namespace hitchview::app

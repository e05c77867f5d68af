#include <gtest/gtest.h>

#include "app/display.hpp"
#include "app/jpeg_encoder.hpp"
#include "app/jpeg_picture.hpp"
#include "tests/support/i420_picture.hpp"

namespace hitchview::app {
namespace {

using std::chrono::milliseconds;
using tests::I420Picture;

bool AreEqual(const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

class Sender {
 public:
    hal::PanoramaImage Send(int phase) {
        jpeg_ = encoder_.Encode(I420Picture::Waves(64, 32, phase).view()).value();
        ++sequence_;
        return Repeat();
    }
    hal::PanoramaImage Repeat() const {
        return {.sequence = sequence_,
                .captured_until = milliseconds(33 * sequence_),
                .width_px = 64,
                .height_px = 32,
                .jpeg = jpeg_};
    }

 private:
    JpegEncoder encoder_{{64, 32, hal::PixelFormat::kI420, hal::Range::kFull}, {}};
    std::span<const std::uint8_t> jpeg_;
    std::uint32_t sequence_ = 0;
};

TEST(DisplayTest, AYoungPictureIsShownAsItIs) {
    Display display(milliseconds(500));
    Sender sender;
    const hal::PanoramaImage image = sender.Send(3);
    ASSERT_TRUE(display.Update(image, milliseconds(1000)));
    cv::Mat expected;
    ASSERT_TRUE(DecodeJpeg(image.jpeg, {64, 32}, expected));
    EXPECT_TRUE(AreEqual(display.Shown(milliseconds(1500)), expected));
    EXPECT_EQ(display.Reason(milliseconds(1500)), "");
}

TEST(DisplayTest, AnOldPictureIsReplacedByLetteringOnAPlainBackground) {
    Display display(milliseconds(500));
    Sender sender;
    ASSERT_TRUE(display.Update(sender.Send(3), milliseconds(1000)));
    const cv::Mat shown = display.Shown(milliseconds(1501));

    ASSERT_EQ(shown.size(), cv::Size(64, 32));
    const cv::Vec3b background = shown.at<cv::Vec3b>(0, 0);
    const cv::Mat border_rows = shown.rowRange(0, 3);
    EXPECT_EQ(cv::norm(border_rows, cv::Mat(border_rows.size(), CV_8UC3, background), cv::NORM_INF),
              0);
    EXPECT_NE(background, display.Shown(milliseconds(1500)).at<cv::Vec3b>(0, 0));
    cv::Mat bright;
    cv::inRange(shown, cv::Scalar::all(200), cv::Scalar::all(255), bright);
    EXPECT_GT(cv::countNonZero(bright), 20) << "the words";
}

TEST(DisplayTest, TheReasonForNoPictureIsSaid) {
    Display display(milliseconds(500));
    EXPECT_EQ(display.Reason(milliseconds(0)), "no publisher");
    display.SetCameraNames({"front"});
    EXPECT_EQ(display.Reason(milliseconds(0)), "the publisher sends no pictures");
    Sender sender;
    ASSERT_TRUE(display.Update(sender.Send(0), milliseconds(1000)));
    EXPECT_EQ(display.Reason(milliseconds(3260)), "the newest picture is 2.2 s old");
    display.NoteDamaged();
    EXPECT_EQ(display.Reason(milliseconds(3260)), "what comes is damaged");
}

TEST(DisplayTest, CamerasThatGiveNoPictureAreNamedOrNumbered) {
    Display display(milliseconds(500));
    Sender sender;
    hal::PanoramaImage image = sender.Send(0);
    image.cameras_missing = 0b1010;
    ASSERT_TRUE(display.Update(image, milliseconds(0)));
    EXPECT_EQ(display.MissingCameras(), "camera 1, camera 3");
    display.SetCameraNames({"front", "left", "right"});
    EXPECT_EQ(display.MissingCameras(), "left, camera 3");
    const cv::Mat shown = display.Shown(milliseconds(0));
    cv::Mat whole;
    ASSERT_TRUE(DecodeJpeg(image.jpeg, {64, 32}, whole));
    EXPECT_FALSE(AreEqual(shown, whole));
    EXPECT_TRUE(AreEqual(shown.rowRange(0, 24), whole.rowRange(0, 24)));
}

TEST(DisplayTest, APictureThatWasLateOnItsWayIsOldWhenItComes) {
    Display display(milliseconds(100));
    Sender sender;  // a picture each 33 ms of its clock
    ASSERT_TRUE(display.Update(sender.Send(0), milliseconds(1000)));
    ASSERT_TRUE(display.Update(sender.Send(1), milliseconds(1033 + 90)));
    EXPECT_TRUE(display.IsLive(milliseconds(1033 + 95)));
    ASSERT_TRUE(display.Update(sender.Send(2), milliseconds(1066 + 120)));
    EXPECT_FALSE(display.IsLive(milliseconds(1066 + 120)));
}

TEST(PictureAgeTest, ASenderThatBeginsAnewHasAYoungPicture) {
    PictureAge age;
    EXPECT_FALSE(age.At(milliseconds(5)));
    age.Note(milliseconds(900'000), milliseconds(1000));
    EXPECT_EQ(*age.At(milliseconds(1040)), milliseconds(40));
    age.Note(milliseconds(50), milliseconds(1100));  // its clock was set back: it was restarted
    EXPECT_EQ(*age.At(milliseconds(1100)), milliseconds(0));
}

TEST(PictureAgeTest, APictureThatWasHeldBackForLongIsOld) {
    PictureAge age;
    age.Note(milliseconds(500), milliseconds(1000));
    age.Note(milliseconds(533), milliseconds(4533));  // its sender had stopped
    EXPECT_GT(*age.At(milliseconds(4533)), std::chrono::seconds(3));
    for (int i = 0; i < 60; ++i) {
        const milliseconds now(4566 + 33 * i);
        age.Note(now - milliseconds(500), now);
        ASSERT_LE(*age.At(now), milliseconds(1));
    }
}

TEST(PictureAgeTest, APauseAfterWhichEveryPictureSeemsOldWasARestart) {
    PictureAge age;
    age.Note(milliseconds(50), milliseconds(1000));
    for (int i = 0; i < 60; ++i) {
        const milliseconds now(9000 + 33 * i);  // its clock has been set back meanwhile
        age.Note(milliseconds(60 + 33 * i), now);
        if (33 * i < 1000)
            ASSERT_GT(*age.At(now), std::chrono::seconds(6));
        else
            ASSERT_EQ(*age.At(now), milliseconds(0));
    }
}

TEST(PictureAgeTest, ClocksThatDriftByAHundredPpmDoNotMakePicturesOld) {
    PictureAge age;
    hal::Instant captured{};
    for (hal::Instant now{}; now < std::chrono::minutes(10); now += milliseconds(33)) {
        captured = now - now / 10'000;
        age.Note(captured, now);
        ASSERT_LE(*age.At(now), milliseconds(1));
    }
}

TEST(DisplayTest, BeforeTheFirstPictureThereIsNoImage) {
    const Display display(milliseconds(500));
    EXPECT_FALSE(display.IsLive(milliseconds(0)));
    EXPECT_FALSE(display.Shown(milliseconds(0)).empty());
}

TEST(DisplayTest, APictureIsLiveUntilItsLimit) {
    Display display(milliseconds(500));
    Sender sender;
    ASSERT_TRUE(display.Update(sender.Send(0), milliseconds(1000)));

    EXPECT_TRUE(display.IsLive(milliseconds(1500)));
    EXPECT_FALSE(display.IsLive(milliseconds(1501)));
    EXPECT_FALSE(AreEqual(display.Shown(milliseconds(1500)), display.Shown(milliseconds(1501))));
}

TEST(DisplayTest, TheNewestPictureIsShown) {
    Display display(milliseconds(500));
    Sender sender;
    ASSERT_TRUE(display.Update(sender.Send(0), milliseconds(0)));
    const cv::Mat early = display.Shown(milliseconds(0)).clone();
    ASSERT_TRUE(display.Update(sender.Send(60), milliseconds(33)));
    EXPECT_FALSE(AreEqual(display.Shown(milliseconds(33)), early));
}

TEST(DisplayTest, TheSamePictureSentAgainDoesNotStayYoung) {
    Display display(milliseconds(500));
    Sender sender;
    ASSERT_TRUE(display.Update(sender.Send(0), milliseconds(0)));
    ASSERT_TRUE(display.Update(sender.Repeat(), milliseconds(400)));
    EXPECT_FALSE(display.IsLive(milliseconds(501)));
}

TEST(DisplayTest, APictureThatDoesNotDecodeDoesNotStayYoung) {
    Display display(milliseconds(500));
    Sender sender;
    ASSERT_TRUE(display.Update(sender.Send(0), milliseconds(0)));
    hal::PanoramaImage damaged = sender.Send(5);
    damaged.jpeg = damaged.jpeg.first(100);
    EXPECT_FALSE(display.Update(damaged, milliseconds(400)));
    EXPECT_FALSE(display.IsLive(milliseconds(501)));
}

}  // namespace
}  // namespace hitchview::app

#include <gtest/gtest.h>

#include "app/display.hpp"
#include "app/jpeg_encoder.hpp"
#include "tests/support/i420_picture.hpp"

namespace hitchview::app {
namespace {

using std::chrono::milliseconds;
using tests::I420Picture;

bool AreEqual(const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

const cv::Mat kPicture(90, 512, CV_8UC3, cv::Scalar(10, 200, 30));

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
    EXPECT_TRUE(
        AreEqual(Display::Compose(kPicture, milliseconds(500), milliseconds(500)), kPicture));
}

TEST(DisplayTest, AnOldPictureIsReplacedByLetteringOnAPlainBackground) {
    const cv::Mat shown = Display::Compose(kPicture, milliseconds(501), milliseconds(500));

    ASSERT_EQ(shown.size(), kPicture.size());
    const cv::Vec3b background = shown.at<cv::Vec3b>(0, 0);
    const cv::Mat border_rows = shown.rowRange(0, 3);
    EXPECT_EQ(cv::norm(border_rows, cv::Mat(border_rows.size(), CV_8UC3, background), cv::NORM_INF),
              0);
    EXPECT_NE(background, kPicture.at<cv::Vec3b>(0, 0));
    cv::Mat white;
    cv::inRange(shown, cv::Scalar::all(255), cv::Scalar::all(255), white);
    EXPECT_GT(cv::countNonZero(white), 100) << "the words";
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

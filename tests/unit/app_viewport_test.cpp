#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "app/jpeg_picture.hpp"
#include "app/panorama_publisher.hpp"
#include "app/viewport.hpp"
#include "drivers/steady_clock.hpp"
#include "hal/fake_publisher.hpp"
#include "tests/support/i420_picture.hpp"

namespace hitchview::app {
namespace {

using tests::I420Picture;

const algo::Projection kRing = algo::Projection::Cylinder(720, 96, 0.5);
const algo::Projection kPlane = algo::Projection::Plane(320, 96);

Viewport Made(const ViewportConfig& config, const algo::Projection& canvas) {
    const auto viewports = MakeViewports({.viewports = {config}}, canvas);
    EXPECT_TRUE(viewports) << viewports.error();
    return viewports.value().at(0);
}

TEST(ViewportTest, AnAzimuthOfARingIsTwoPixelsADegreeHere) {
    // Forward is the middle, x = 360; left of the vehicle lies left of it.
    const Viewport ahead = Made({.azimuth_deg = {{30, -30}}}, kRing);
    EXPECT_EQ(ahead.x_px, 300);
    EXPECT_EQ(ahead.width_px, 120);
    EXPECT_EQ(ahead.y_px, 0);
    EXPECT_EQ(ahead.height_px, 96);
    const Viewport left = Made({.azimuth_deg = {{120, 60}}, .rows_px = {{10, 50}}}, kRing);
    EXPECT_EQ(left.x_px, 120);
    EXPECT_EQ(left.width_px, 120);
    EXPECT_EQ(left.y_px, 10);
    EXPECT_EQ(left.height_px, 40);
}

TEST(ViewportTest, TheRearReachesAcrossTheRingsEnd) {
    const Viewport rear = Made({.azimuth_deg = {{-150, 150}}}, kRing);
    EXPECT_EQ(rear.x_px, 660);
    EXPECT_EQ(rear.width_px, 120);
    EXPECT_EQ(Made({.azimuth_deg = {{210, 150}}}, kRing).x_px, 660);
    EXPECT_EQ(Made({.azimuth_deg = {{180, -180}}}, kRing).width_px, 720);
}

TEST(ViewportTest, WhatDoesNotFitThePlaneIsNamed) {
    const auto error = [](const ViewportConfig& config) {
        const auto viewports = MakeViewports({.viewports = {config}}, kPlane);
        return viewports ? std::string("no error") : viewports.error();
    };
    EXPECT_EQ(error({.name = "a", .columns_px = {{300, 340}}}),
              "publish.viewports: a reaches beyond the canvas of 320 columns");
    EXPECT_EQ(error({.name = "a", .columns_px = {{0, 320}}, .rows_px = {{90, 110}}}),
              "publish.viewports: a reaches below the canvas of 96 rows");
    EXPECT_EQ(error({.name = "a", .columns_px = {{0, 10}}}),
              "publish.viewports: a is smaller than 16 pixels");
    EXPECT_EQ(error({.name = "a", .columns_px = {{0, 320}}}), "no error");
}

/// Sample of one plane of a packed picture.
std::uint8_t At(const hal::FrameView& view, std::size_t plane, int x, int y) {
    return view.planes[plane].data[y * view.planes[plane].stride_bytes + x];
}

void ExpectCropIsThePanoramas(const Viewport& viewport) {
    const I420Picture panorama = I420Picture::Noise(720, 96, 200, 7);
    I420Picture crop(viewport.width_px, viewport.height_px);
    CropViewport(panorama.view(), viewport, crop.bytes());
    int wrong = 0;
    for (std::size_t plane = 0; plane < 3; ++plane) {
        const int scale = plane == 0 ? 1 : 2;
        for (int y = 0; y < viewport.height_px / scale; ++y) {
            for (int x = 0; x < viewport.width_px / scale; ++x) {
                const int column = (viewport.x_px / scale + x) % (720 / scale);
                wrong += At(crop.view(), plane, x, y) !=
                         At(panorama.view(), plane, column, viewport.y_px / scale + y);
            }
        }
    }
    EXPECT_EQ(wrong, 0);
}

TEST(ViewportTest, ACropHasThePanoramasPixels) {
    ExpectCropIsThePanoramas(Made({.azimuth_deg = {{120, 60}}, .rows_px = {{10, 50}}}, kRing));
}

TEST(ViewportTest, ACropAcrossTheEndHasThePixelsOfBothSides) {
    ExpectCropIsThePanoramas(Made({.azimuth_deg = {{-150, 150}}}, kRing));
    ExpectCropIsThePanoramas(Made({.azimuth_deg = {{90, 90}}}, kRing));
}

/// Keeps what a viewport shows.
class Network final : public hal::Publisher {
 public:
    struct Sent {
        std::string channel;
        std::uint32_t sequence;
        std::uint32_t cameras_missing;
        std::vector<std::uint8_t> jpeg;
    };
    std::vector<Sent> viewports;
    int panoramas = 0;

 private:
    hal::Result<hal::Done> DoPublish(const hal::PanoramaImage& /*image*/) override {
        ++panoramas;
        return hal::Done{};
    }
    hal::Result<hal::Done> DoPublish(const hal::PanoramaStatus& /*status*/) override {
        return hal::Done{};
    }
    hal::Result<hal::Done> DoPublish(const hal::HitchAngle& /*angle*/) override {
        return hal::Done{};
    }
    hal::Result<hal::Done> DoPublish(const hal::Event& /*event*/) override { return hal::Done{}; }
    hal::Result<hal::Done> DoPublish(const hal::ViewportImage& viewport) override {
        viewports.push_back({viewport.channel,
                             viewport.image.sequence,
                             viewport.image.cameras_missing,
                             {viewport.image.jpeg.begin(), viewport.image.jpeg.end()}});
        return hal::Done{};
    }
};

TEST(ViewportTest, AViewportThatNoQualityMakesSmallEnoughIsCountedAndThePanoramasGoOn) {
    const drivers::SteadyClock clock;
    Network network;
    const I420Picture noise = I420Picture::Noise(720, 96, 255, 5);
    PanoramaPublisherOptions options;
    options.drop_when_late = false;
    options.side.viewports = {{"VIEW_REAR", 100, 16, 120, 64, 1, 100}};
    PanoramaPublisher publisher(network, clock, {}, noise.format(), options);
    for (int i = 0; i < 3; ++i)
        publisher.Append({.picture = noise.view(), .captured_until = {}, .status = {}});
    publisher.Finish();
    EXPECT_EQ(network.panoramas, 3);
    EXPECT_TRUE(network.viewports.empty());
    EXPECT_EQ(publisher.refused(), 3U);
}

TEST(ViewportTest, WhatIsSentLooksLikeItsPartOfThePanorama) {
    const drivers::SteadyClock clock;
    Network network;
    const I420Picture panorama = I420Picture::Waves(720, 96, 5);
    const Viewport rear{"VIEW_REAR", 660, 16, 120, 64, 2, 60'000};
    PanoramaPublisherOptions options;
    options.drop_when_late = false;
    options.side.viewports = {rear};
    PanoramaPublisher publisher(network, clock, {}, panorama.format(), options);
    for (std::uint32_t i = 0; i < 4; ++i) {
        PanoramaPublisher::Item item{
            .picture = panorama.view(), .captured_until = {}, .status = {}};
        item.status.cameras_missing = 4;
        item.picture.header.sequence = i;
        publisher.Append(item);
    }
    publisher.Finish();
    EXPECT_EQ(network.panoramas, 4);
    ASSERT_EQ(network.viewports.size(), 2U);
    EXPECT_EQ(network.viewports[0].channel, "VIEW_REAR");
    EXPECT_EQ(network.viewports[0].sequence, 0U);
    EXPECT_EQ(network.viewports[1].sequence, 2U);
    EXPECT_EQ(network.viewports[1].cameras_missing, 4U);

    cv::Mat decoded;
    ASSERT_TRUE(DecodeJpeg(network.viewports[1].jpeg, {120, 64}, decoded));
    I420Picture crop(120, 64);
    CropViewport(panorama.view(), rear, crop.bytes());
    JpegEncoder best(crop.format(), {.highest_quality = 95});
    cv::Mat expected;
    ASSERT_TRUE(DecodeJpeg(best.Encode(crop.view()).value(), {120, 64}, expected));
    EXPECT_GT(cv::PSNR(decoded, expected), 30);
}

}  // namespace
}  // namespace hitchview::app

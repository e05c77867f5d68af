#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <vector>

#include "tests/device/vivid.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::drivers {
namespace {

using std::chrono::milliseconds;
using tests::Vivid;
using tests::VividCamera;
using Bytes = std::vector<std::uint8_t>;

struct FormatCase {
    const char* name;
    const char* fourcc;
    bool multi_planar;
};

void PrintTo(const FormatCase& format, std::ostream* stream) {
    *stream << format.name << (format.multi_planar ? " multi" : " single");
}

/// A pattern that stands still, with nothing written over it.
void ShowPattern() {
    ASSERT_TRUE(Vivid::Set(0, "osd_text_mode", 2));
    ASSERT_TRUE(Vivid::Set(0, "test_pattern", 4));
    ASSERT_TRUE(Vivid::Set(0, "gain_automatic", 0));
}

void AppendPlane(const hal::Plane& plane, int bytes, int lines, Bytes& packed) {
    for (int y = 0; y < lines; ++y) {
        const std::uint8_t* line = plane.data + static_cast<std::ptrdiff_t>(y) * plane.stride_bytes;
        packed.insert(packed.end(), line, line + bytes);
    }
}

/// Without padding, as a file of raw frames has it.
Bytes Packed(const hal::FrameView& view) {
    const hal::FrameFormat& format = view.format;
    const bool nv12 = format.pixel_format == hal::PixelFormat::kNv12;
    const bool one_byte = nv12 || format.pixel_format == hal::PixelFormat::kGrey;
    Bytes packed;
    AppendPlane(view.planes[0], one_byte ? format.width_px : 2 * format.width_px, format.height_px,
                packed);
    if (nv12) AppendPlane(view.planes[1], format.width_px, format.height_px / 2, packed);
    return packed;
}

/// What v4l2-ctl reads of the device as it was left.
Bytes RawCapture() {
    const tests::TemporaryFolder folder;
    const std::string file = folder / "raw";
    tests::Shell("v4l2-ctl --device 0 --stream-mmap --stream-count=1 --stream-to=" + file +
                 " >/dev/null 2>&1");
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

hal::Checked<Bytes> CaptureWith(const V4l2CameraOptions& options) {
    auto camera = V4l2Camera::Open(options);
    if (!camera) return camera.error();
    for (int attempt = 0; attempt < 100; ++attempt) {
        const auto frame = (*camera)->WaitFrame(milliseconds(100));
        if (frame) return Packed(frame.value().view());
    }
    return std::string("no frame came");
}

Bytes LumaOf(const Bytes& packed, hal::PixelFormat format, std::size_t pixels) {
    Bytes luma;
    const bool interleaved = format == hal::PixelFormat::kUyvy || format == hal::PixelFormat::kYuyv;
    const std::size_t first = format == hal::PixelFormat::kUyvy ? 1 : 0;
    for (std::size_t i = 0; i < pixels; ++i)
        luma.push_back(packed[first + (interleaved ? 2 * i : i)]);
    return luma;
}

/// Of the pixels, within one grey level.
double ShareOfEqual(const Bytes& a, const Bytes& b) {
    std::size_t equal = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        equal += std::abs(a[i] - b[i]) <= 1 ? 1U : 0U;
    }
    return static_cast<double>(equal) / static_cast<double>(std::max(a.size(), b.size()));
}

class V4l2FormatTest : public testing::TestWithParam<FormatCase> {
 protected:
    void SetUp() override {
        if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
        vivid_ = std::make_unique<Vivid>(
            tests::VividOptions{.cameras = 1, .multi_planar = GetParam().multi_planar});
        ASSERT_TRUE(vivid_->loaded());
        ShowPattern();
    }

    static V4l2CameraOptions Options() {
        auto options = VividCamera(0);
        options.wish.format = GetParam().name;
        return options;
    }

    std::unique_ptr<Vivid> vivid_;
};

TEST_P(V4l2FormatTest, PixelsAreThoseThatTheDeviceMade) {
    const auto packed = CaptureWith(Options());
    ASSERT_TRUE(packed.ok()) << packed.error();
    EXPECT_EQ(packed.value(), RawCapture());
}

TEST_P(V4l2FormatTest, PaddingBetweenLinesIsSkipped) {
    const auto tight = CaptureWith(Options());
    ASSERT_TRUE(tight.ok()) << tight.error();
    auto options = Options();
    options.line_bytes = 2816;
    const auto padded = CaptureWith(options);
    ASSERT_TRUE(padded.ok()) << padded.error();
    EXPECT_EQ(padded.value(), tight.value());
}

TEST_P(V4l2FormatTest, FramesLieInDmabufs) {
    auto camera = V4l2Camera::Open(Options());
    ASSERT_TRUE(camera.ok()) << camera.error();
    EXPECT_TRUE((*camera)->facts().dmabuf);
    const auto frame = (*camera)->WaitFrame(milliseconds(1000));
    ASSERT_TRUE(frame.ok());
    for (const hal::Plane& plane : frame.value().view().planes) {
        if (plane.data == nullptr) continue;
        const V4l2Buffers::Dmabuf dmabuf = (*camera)->FindDmabuf(plane);
        std::uint8_t first = 0;
        ASSERT_GE(dmabuf.file, 0);
        void* const mapped = SystemKernel().Map(dmabuf.file, 4096, 0);
        first = static_cast<const std::uint8_t*>(mapped)[0];
        SystemKernel().Unmap(mapped, 4096);
        EXPECT_EQ(first, (plane.data - dmabuf.offset_bytes)[0]);
    }
}

INSTANTIATE_TEST_SUITE_P(SinglePlanar, V4l2FormatTest,
                         testing::Values(FormatCase{"uyvy", "UYVY", false},
                                         FormatCase{"yuyv", "YUYV", false},
                                         FormatCase{"nv12", "NV12", false},
                                         FormatCase{"grey", "GREY", false}));
INSTANTIATE_TEST_SUITE_P(MultiPlanar, V4l2FormatTest,
                         testing::Values(FormatCase{"uyvy", "UYVY", true},
                                         FormatCase{"yuyv", "YUYV", true},
                                         FormatCase{"nv12", "NV12", true},
                                         FormatCase{"nm12", "NM12", true},
                                         FormatCase{"grey", "GREY", true}));

class V4l2SettingsTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
        vivid_ = std::make_unique<Vivid>(tests::VividOptions{});
        ASSERT_TRUE(vivid_->loaded());
        ShowPattern();
    }

    std::unique_ptr<Vivid> vivid_;
};

TEST_F(V4l2SettingsTest, EveryFormatShowsTheSamePicture) {
    auto options = VividCamera(0);
    const std::size_t pixels = 1280 * 720;
    std::map<std::string, Bytes> lumas;
    for (const char* name : {"uyvy", "yuyv", "nv12", "grey"}) {
        options.wish.format = name;
        const auto packed = CaptureWith(options);
        ASSERT_TRUE(packed.ok()) << packed.error();
        const std::string key = name;
        lumas[key] = LumaOf(packed.value(), FindV4l2PixelFormat(key)->delivered, pixels);
    }
    EXPECT_EQ(lumas["yuyv"], lumas["uyvy"]);
    EXPECT_EQ(lumas["nv12"], lumas["uyvy"]);
    // The device weighs the colours of its grey otherwise: other values, the same picture.
    std::map<std::uint8_t, std::uint8_t> grey_of;
    Bytes expected;
    for (std::size_t i = 0; i < pixels; ++i) {
        expected.push_back(grey_of.try_emplace(lumas["uyvy"][i], lumas["grey"][i]).first->second);
    }
    EXPECT_GT(grey_of.size(), 4U);
    EXPECT_EQ(lumas["grey"], expected);
}

TEST_F(V4l2SettingsTest, TheBestOfferedFormatIsNv12) {
    auto camera = V4l2Camera::Open(VividCamera(0));
    ASSERT_TRUE(camera.ok()) << camera.error();
    EXPECT_EQ((*camera)->format().pixel_format, hal::PixelFormat::kNv12);
    EXPECT_EQ((*camera)->facts().granted.rate_hz, 30);
}

TEST_F(V4l2SettingsTest, TheRangeOfTheColoursIsTheDevices) {
    for (const auto& [quantization, range] :
         {std::pair{1, hal::Range::kFull}, std::pair{2, hal::Range::kLimited},
          std::pair{0, hal::Range::kLimited}}) {
        ASSERT_TRUE(Vivid::Set(0, "quantization", quantization));
        auto camera = V4l2Camera::Open(VividCamera(0));
        ASSERT_TRUE(camera.ok()) << camera.error();
        EXPECT_EQ((*camera)->format().range, range) << quantization;
    }
}

TEST_F(V4l2SettingsTest, TheDeviceTurnsThePictureOver) {
    auto options = VividCamera(0);
    options.wish.format = "grey";
    Bytes upright = CaptureWith(options).value();
    options.orientation.rotation_deg = 180;
    const auto turned = CaptureWith(options);
    ASSERT_TRUE(turned.ok()) << turned.error();
    EXPECT_NE(turned.value(), upright);
    std::ranges::reverse(upright);
    // The device mirrors pairs of pixels, so that edges move by one.
    EXPECT_GT(ShareOfEqual(turned.value(), upright), 0.98);
}

TEST_F(V4l2SettingsTest, ControlsAreSetByNameIdAndMenuEntry) {
    auto options = VividCamera(0);
    options.wish.format = "grey";
    options.controls = {{"test_pattern", "100% White"}, {"0x00980900", "255"}, {"Contrast", "0"}};
    const auto white = CaptureWith(options);
    ASSERT_TRUE(white.ok()) << white.error();
    EXPECT_TRUE(tests::Shell(
        "v4l2-ctl --device 0 --get-ctrl brightness,contrast,test_pattern | tr '\\n' ' ' | "
        "grep --quiet 'brightness: 255 contrast: 0 test_pattern: 6'"));
}

TEST_F(V4l2SettingsTest, ErrorsNameWhatIsWrongAndWhatIsAllowed) {
    auto options = VividCamera(0);
    options.controls = {{"brightness", "300"}};
    EXPECT_EQ(V4l2Camera::Open(options).error(),
              "/dev/video0: control brightness is 300, must be 0 to 255");
    options.controls = {{"test_pattern", "Tartan"}};
    EXPECT_NE(V4l2Camera::Open(options).error().find("must be one of 0 (75% Colorbar), 1 ("),
              std::string::npos);
    options.controls = {};
    options.wish.size = {1234, 720};
    const std::string error = V4l2Camera::Open(options).error();
    EXPECT_NE(error.find("/dev/video0: wanted 1234x720 at 30 Hz as best; offered: "),
              std::string::npos)
        << error;
    EXPECT_NE(error.find("UYVY 320x180 at "), std::string::npos) << error;
}

TEST_F(V4l2SettingsTest, SourceAndClockOfTheStampsAreTheDevices) {
    for (const int start_of_exposure : {0, 1}) {
        ASSERT_TRUE(Vivid::Set(0, "timestamp_source", start_of_exposure));
        auto camera = V4l2Camera::Open(VividCamera(0));
        ASSERT_TRUE(camera.ok()) << camera.error();
        EXPECT_EQ((*camera)->facts().stamps, start_of_exposure == 1
                                                 ? V4l2StampSource::kStartOfExposure
                                                 : V4l2StampSource::kEndOfFrame);
        const auto frame = (*camera)->WaitFrame(milliseconds(1000));
        ASSERT_TRUE(frame.ok());
        const hal::Instant age = std::chrono::steady_clock::now().time_since_epoch() -
                                 frame.value().view().header.captured_at;
        EXPECT_GT(age, milliseconds(0));
        EXPECT_LT(age, milliseconds(500));
    }
}

}  // namespace
}  // namespace hitchview::drivers

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "app/jpeg_picture.hpp"
#include "app/preview_reduction.hpp"
#include "app/preview_thread.hpp"

namespace hitchview::app {
namespace {

using hal::PixelFormat;
using hal::Range;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// A frame with its own memory: luma 100 in the left half and 180 in the right one, chroma 90, 200.
class TwoTone {
 public:
    TwoTone(const hal::FrameFormat& format) : format_(format), bytes_(hal::FrameBytes(format)) {
        for (int y = 0; y < format.height_px; ++y) {
            for (int x = 0; x < format.width_px; ++x) Put(x, y);
        }
    }
    [[nodiscard]] hal::FrameView view() const {
        return {format_, {}, hal::PackedPlanes(format_, bytes_.data())};
    }
    [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
    void Put(int x, int y) {
        const int width = format_.width_px;
        const std::uint8_t luma = x < width / 2 ? 100 : 180;
        const std::uint8_t chroma = x % 2 == 0 ? 90 : 200;
        const auto pixel = static_cast<std::size_t>(y * width + x);
        const auto area = static_cast<std::size_t>(width * format_.height_px);
        switch (format_.pixel_format) {
            case PixelFormat::kUyvy:
                bytes_[2 * pixel + 1] = luma;
                bytes_[2 * pixel] = chroma;
                break;
            case PixelFormat::kYuyv:
                bytes_[2 * pixel] = luma;
                bytes_[2 * pixel + 1] = chroma;
                break;
            case PixelFormat::kNv12:
                bytes_[pixel] = luma;
                bytes_[area + static_cast<std::size_t>(y / 2 * width + x)] = chroma;
                break;
            case PixelFormat::kI420:
                bytes_[pixel] = luma;
                bytes_[area + static_cast<std::size_t>(y / 2 * width / 2 + x / 2) +
                       (x % 2 == 0 ? 0 : area / 4)] = chroma;
                break;
            default:
                bytes_[pixel] = luma;
        }
    }

    hal::FrameFormat format_;
    std::vector<std::uint8_t> bytes_;
};

/// Left and right luma, u and v of a reduced picture.
std::array<int, 4> ColoursOf(const hal::FrameFormat& format) {
    std::vector<std::uint8_t> preview(hal::FrameBytes(kPreviewFormat));
    ReduceToPreview(TwoTone(format).view(), preview);
    constexpr int kLuma = kPreviewWidth_px * kPreviewHeight_px;
    const int row = 50 * kPreviewWidth_px;
    return {preview[row + 20], preview[row + 170], preview[kLuma + 2000],
            preview[kLuma + kLuma / 4 + 2000]};
}

TEST(PreviewReductionTest, EveryFormatKeepsItsColours) {
    const std::array<int, 4> expected{100, 180, 90, 200};
    for (const PixelFormat format :
         {PixelFormat::kUyvy, PixelFormat::kYuyv, PixelFormat::kNv12, PixelFormat::kI420})
        EXPECT_EQ(ColoursOf({1280, 720, format, Range::kFull}), expected);
    EXPECT_EQ(ColoursOf({1280, 720, PixelFormat::kGrey, Range::kFull}),
              (std::array<int, 4>{100, 180, 128, 128}));
}

TEST(PreviewReductionTest, TelevisionsRangeBecomesThatOfAJpeg) {
    // (100 - 16) 255 / 219 = 97.8; 128 + (90 - 128) 255 / 224 = 84.7
    EXPECT_EQ(ColoursOf({640, 360, PixelFormat::kNv12, Range::kLimited}),
              (std::array<int, 4>{98, 191, 85, 210}));
}

TEST(PreviewReductionTest, AnySizeWillDoTheSmallestToo) {
    for (const auto& [width, height] : {std::pair{1920, 1080}, {320, 180}, {192, 108}, {64, 64}}) {
        EXPECT_EQ(ColoursOf({width, height, PixelFormat::kUyvy, Range::kFull}),
                  (std::array<int, 4>{100, 180, 90, 200}))
            << width;
    }
}

TEST(PreviewReductionTest, APixelIsTheMeanOfThoseItStandsFor) {
    std::vector<std::uint8_t> bytes(384 * 216);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>(i % 384 % 2 == 0 ? 10 : 31);  // mean 20.5
    const hal::FrameFormat format{384, 216, PixelFormat::kGrey, Range::kFull};
    std::vector<std::uint8_t> preview(hal::FrameBytes(kPreviewFormat));
    ReduceToPreview({format, {}, hal::PackedPlanes(format, bytes.data())}, preview);
    EXPECT_TRUE(std::all_of(preview.begin(), preview.begin() + kPreviewWidth_px * kPreviewHeight_px,
                            [](std::uint8_t luma) { return luma == 21; }));
}

class PreviewThreadTest : public testing::Test {
 protected:
    PreviewThreadTest() {
        PreviewOptions options{.cameras = {}, .period = milliseconds(500)};
        options.cameras[algo::Unit::kTractor] = {"front"};
        options.cameras[algo::Unit::kTrailer] = {"left", "rear"};
        previews_ = std::make_unique<PreviewThread>(options);
    }

    /// A set that lacks the camera `left`.
    FrameSet Set(std::uint32_t sequence) {
        FrameSet set;
        set.sequence = sequence;
        Lend(set.leases[algo::Unit::kTractor][0], sequence);
        Lend(set.leases[algo::Unit::kTrailer][1], sequence);
        return set;
    }
    void Lend(hal::FrameLease& lease, std::uint32_t sequence) {
        const auto slot = pool_.Take();
        ASSERT_TRUE(slot);
        std::ranges::copy(TwoTone(kFormat).bytes(), slot->bytes.begin());
        lease = pool_.Lease(*slot, {sequence, seconds(sequence)});
    }
    std::span<const hal::PreviewImage> Wait() {
        while (previews_->Take().empty()) std::this_thread::yield();
        return previews_->Take();
    }

    static constexpr hal::FrameFormat kFormat{320, 180, PixelFormat::kUyvy, Range::kFull};
    hal::FramePool pool_{kFormat, 4};
    std::unique_ptr<PreviewThread> previews_;  // before the pool goes
};

TEST_F(PreviewThreadTest, EveryCameraThatGaveAFrameHasAPreview) {
    ASSERT_TRUE(previews_->IsDue(seconds(1)));
    previews_->Give(Set(7), seconds(100), seconds(1));
    const auto made = Wait();
    ASSERT_EQ(made.size(), 2U);
    EXPECT_STREQ(made[0].channel, "PREVIEW_FRONT");
    EXPECT_STREQ(made[1].channel, "PREVIEW_REAR");
    EXPECT_EQ(made[0].sequence, 7U);
    EXPECT_EQ(made[0].captured_at, seconds(107));
    cv::Mat picture;
    ASSERT_TRUE(DecodeJpeg(made[1].jpeg, {192, 108}, picture));
    EXPECT_LT(made[1].jpeg.size(), 20'000U);
}

TEST_F(PreviewThreadTest, TheFramesAreGivenBackBeforeThePreviewsAreTaken) {
    previews_->Give(Set(1), {}, seconds(1));
    Wait();
    EXPECT_EQ(pool_.free_count(), 4);
}

TEST_F(PreviewThreadTest, OneSetIsTakenInAPeriodAndNoneWhileOneIsAtWork) {
    previews_->Give(Set(1), {}, seconds(1));
    EXPECT_FALSE(previews_->IsDue(seconds(9)));
    Wait();
    EXPECT_FALSE(previews_->IsDue(seconds(9)));  // nobody has taken them
    previews_->Done();
    EXPECT_FALSE(previews_->IsDue(milliseconds(1499)));
    EXPECT_TRUE(previews_->IsDue(milliseconds(1500)));
}

TEST_F(PreviewThreadTest, TheEndGivesBackWhatIsStillHeld) {
    previews_->Give(Set(1), {}, seconds(1));
    previews_->Finish();
    EXPECT_EQ(pool_.free_count(), 4);
    previews_->Finish();
}

}  // namespace
}  // namespace hitchview::app

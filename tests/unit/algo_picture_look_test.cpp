#include "algo/picture_look.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <vector>

namespace hitchview::algo {
namespace {

/// A picture of luma alone, in any layout; what is between the samples is noise.
class LumaPicture {
 public:
    LumaPicture(int width_px, int height_px, PixelLayout layout, int padding_bytes = 0)
        : layout_(layout),
          stride_bytes_(width_px * (is_packed() ? 2 : 1) + padding_bytes),
          bytes_(static_cast<std::size_t>(stride_bytes_ * height_px)) {
        std::mt19937 random(7);
        for (auto& byte : bytes_) byte = static_cast<std::uint8_t>(random());
        frame_ = {.width_px = width_px,
                  .height_px = height_px,
                  .luma = bytes_.data(),
                  .luma_stride_bytes = stride_bytes_,
                  .chroma = bytes_.data(),
                  .chroma_stride_bytes = stride_bytes_,
                  .layout = layout};
    }

    template <typename Value>
    LumaPicture& Fill(const Value& value) {
        const int at = layout_ == PixelLayout::kUyvy ? 1 : 0;
        const int step = is_packed() ? 2 : 1;
        for (int y = 0; y < frame_.height_px; ++y)
            for (int x = 0; x < frame_.width_px; ++x)
                bytes_[static_cast<std::size_t>(y * stride_bytes_ + x * step + at)] =
                    static_cast<std::uint8_t>(value(x, y));
        return *this;
    }
    [[nodiscard]] const CameraFrame& frame() const { return frame_; }
    std::vector<std::uint8_t>& bytes() { return bytes_; }
    void SetRange(SampleRange range) { frame_.range = range; }

 private:
    [[nodiscard]] bool is_packed() const {
        return layout_ == PixelLayout::kUyvy || layout_ == PixelLayout::kYuyv;
    }

    PixelLayout layout_;
    int stride_bytes_;
    std::vector<std::uint8_t> bytes_;
    CameraFrame frame_;
};

TEST(PictureLookTest, AnEvenPictureHasItsBrightnessAndNoDetail) {
    for (const int grey : {0, 20, 21, 128, 249, 250, 255}) {
        LumaPicture picture(320, 180, PixelLayout::kNv12);
        const PictureLook look = LookAt(picture.Fill([&](int, int) { return grey; }).frame());
        EXPECT_FLOAT_EQ(look.mean, static_cast<float>(grey));
        EXPECT_EQ(look.dark_share, grey <= 20 ? 1 : 0);
        EXPECT_EQ(look.bright_share, grey >= 250 ? 1 : 0);
        for (const auto& cell : look.cells) EXPECT_EQ(cell.fine + cell.coarse, 0);
    }
}

TEST(PictureLookTest, OfARampDetailGrowsWithTheSquareOfTheDistance) {
    LumaPicture picture(200, 120, PixelLayout::kNv12);
    const PictureLook look = LookAt(picture.Fill([](int x, int) { return x; }).frame());
    for (const auto& cell : look.cells) {
        EXPECT_EQ(cell.fine, 1);
        EXPECT_EQ(cell.coarse, 16);
    }
}

TEST(PictureLookTest, OfNoiseDetailIsTwiceItsVarianceAtEveryDistance) {
    LumaPicture picture(1280, 720, PixelLayout::kNv12);
    std::mt19937 random(1);
    std::normal_distribution<double> noise(128, 8);
    const PictureLook look =
        LookAt(picture.Fill([&](int, int) { return noise(random); }).frame());
    double fine = 0;
    double coarse = 0;
    for (const auto& cell : look.cells) {
        fine += cell.fine / PictureLook::kCells;
        coarse += cell.coarse / PictureLook::kCells;
    }
    EXPECT_NEAR(fine, 128, 8);
    EXPECT_NEAR(coarse, 128, 8);
}

TEST(PictureLookTest, DetailIsFoundInItsCell) {
    LumaPicture picture(640, 480, PixelLayout::kNv12);
    // Stripes in the third column and second row of cells alone.
    const PictureLook look = LookAt(picture
                                        .Fill([](int x, int y) {
                                            const bool there = x >= 180 && x < 220 && y >= 80 && y < 160;
                                            return there && x % 2 == 0 ? 200 : 100;
                                        })
                                        .frame());
    for (int i = 0; i < static_cast<int>(PictureLook::kCells); ++i) {
        const float fine = look.cells[static_cast<std::size_t>(i)].fine;
        if (i == 1 * PictureLook::kCols + 2)
            EXPECT_GT(fine, 1000);
        else
            EXPECT_EQ(fine, 0) << i;
    }
}

TEST(PictureLookTest, EveryLayoutLooksTheSame) {
    const auto texture = [](int x, int y) { return (x * x + 7 * y * y + x * y) % 251; };
    const PictureLook look =
        LookAt(LumaPicture(320, 240, PixelLayout::kNv12).Fill(texture).frame());
    for (const PixelLayout layout : {PixelLayout::kNv12, PixelLayout::kUyvy, PixelLayout::kYuyv, PixelLayout::kGrey}) {
        const PictureLook other =
            LookAt(LumaPicture(320, 240, layout, 24).Fill(texture).frame());
        EXPECT_EQ(other.print, look.print);
        EXPECT_EQ(other.mean, look.mean);
        for (std::size_t i = 0; i < look.cells.size(); ++i)
            EXPECT_EQ(other.cells[i].fine, look.cells[i].fine);
    }
}

TEST(PictureLookTest, LimitedRangeIsReadAsGrey) {
    LumaPicture picture(64, 48, PixelLayout::kNv12);
    picture.SetRange(SampleRange::kLimited);
    EXPECT_NEAR(LookAt(picture.Fill([](int, int) { return 16; }).frame()).mean, 0, 1e-3);
    EXPECT_NEAR(LookAt(picture.Fill([](int, int) { return 235; }).frame()).mean, 255, 1e-3);
}

TEST(PictureLookTest, ThePrintOfAllTellsEveryChange) {
    std::mt19937 random(3);
    for (const PixelLayout layout : {PixelLayout::kNv12, PixelLayout::kUyvy}) {
        LumaPicture picture(100, 60, layout);
        const std::uint64_t print = PrintOf(picture.frame());
        EXPECT_EQ(PrintOf(picture.frame()), print);
        for (int i = 0; i < 200; ++i) {
            auto& byte = picture.bytes()[random() % picture.bytes().size()];
            ++byte;
            EXPECT_NE(PrintOf(picture.frame()), print);
            --byte;
        }
        EXPECT_EQ(PrintOf(picture.frame()), print);
    }
}

}  // namespace
}  // namespace hitchview::algo

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "algo/camera_patch.hpp"

namespace hitchview::algo {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// Noise in a layout of the cameras.
class NoisePicture {
 public:
    explicit NoisePicture(PixelLayout layout) : bytes_(2 * kWidth * kHeight) {
        std::mt19937 random(7);
        for (std::uint8_t& byte : bytes_) byte = static_cast<std::uint8_t>(random());
        frame_ = {kWidth, kHeight, bytes_.data(), kWidth, bytes_.data() + kWidth * kHeight,
                  kWidth, layout};
        if (!frame_.is_packed()) return;
        frame_.chroma = frame_.luma;
        frame_.luma_stride_bytes = frame_.chroma_stride_bytes = 2 * kWidth;
    }
    [[nodiscard]] const CameraFrame& frame() const { return frame_; }

 private:
    std::vector<std::uint8_t> bytes_;
    CameraFrame frame_;
};

/// Of the samples nearest to the places of an n x n square round (x, y).
double MeanOf(const SamplePlane& plane, double x, double y, int n, int step) {
    double sum = 0;
    for (int r = 0; r < n; ++r) {
        for (int c = 0; c < n; ++c) {
            const auto at = [&](double middle, int i, int size) {
                const int first = static_cast<int>(middle - 0.5 * (n - 1) * step + 0.5);
                return std::clamp(first + i * step, 0, size - 1);
            };
            sum += plane.row(at(y, r, plane.rows))[at(x, c, plane.cols) * plane.step_bytes];
        }
    }
    return sum / (n * n);
}

TEST(CameraPatchTest, ItsMeanIsThatOfItsSamplesInEveryLayoutAlsoBesideThePicture) {
    for (const PixelLayout layout : {PixelLayout::kNv12, PixelLayout::kUyvy, PixelLayout::kYuyv}) {
        const NoisePicture picture(layout);
        const CameraFrame& frame = picture.frame();
        for (const int step : {1, 2, 5}) {
            for (const float x : {0.0F, 20.25F, 40.5F, kWidth - 1.0F}) {
                for (const float y : {0.0F, 17.75F, kHeight - 1.0F}) {
                    const CameraPatch patch{&frame, x, y, step};
                    patch.Prefetch();
                    const Eigen::Array4f mean = patch.Mean(1);
                    EXPECT_NEAR(mean[0], MeanOf(frame.LumaSamples(), x, y, 4, step), 1e-3);
                    for (const int channel : {0, 1}) {
                        EXPECT_NEAR(mean[1 + channel],
                                    MeanOf(frame.ChromaSamples(channel), 0.5 * x - 0.25,
                                           frame.is_packed() ? y : 0.5 * y - 0.25, 2, step),
                                    1e-3);
                    }
                    EXPECT_EQ(mean[3], 1);
                }
            }
        }
    }
}

TEST(CameraPatchTest, AGainCountsFromBlackAndFromGrey) {
    std::vector<std::uint8_t> bytes(kWidth * kHeight, 100);
    std::vector<std::uint8_t> chroma(kWidth * kHeight / 2, 138);
    const CameraFrame frame{kWidth, kHeight, bytes.data(), kWidth, chroma.data(), kWidth};
    const CameraPatch patch{&frame, 30, 20, 3};
    EXPECT_TRUE(patch.Mean(1.5F).isApprox(Eigen::Array4f(150, 143, 143, 1)));
    EXPECT_EQ(patch.Mean(3)[0], 255) << "and brighter than white there is nothing";
}

TEST(CameraPatchTest, WithoutColourItIsGrey) {
    const std::vector<std::uint8_t> bytes(kWidth * kHeight, 100);
    CameraFrame frame{kWidth, kHeight, bytes.data(), kWidth};
    frame.layout = PixelLayout::kGrey;
    const CameraPatch patch{&frame, 30, 20, 3};
    EXPECT_TRUE(patch.Mean(1).isApprox(Eigen::Array4f(100, 128, 128, 1)));
}

}  // namespace
}  // namespace hitchview::algo

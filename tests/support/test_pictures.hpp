#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace hitchview::tests {

/// Smooth waves in three colours, another picture for each index; BGR.
inline cv::Mat ColourWaves(cv::Size size, int index) {
    cv::Mat bgr(size, CV_8UC3);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const auto wave = [&](double fx, double fy) {
                return cv::saturate_cast<uchar>(128 +
                                                100 * std::sin(fx * x + fy * y + 0.4 * index));
            };
            bgr.at<cv::Vec3b>(y, x) = {wave(0.05, 0.01), wave(0.02, -0.04), wave(-0.03, 0.03)};
        }
    }
    return bgr;
}

/// Blurred noise: many corners, none alike. Grey.
inline cv::Mat Texture(cv::Size size, std::uint64_t seed) {
    cv::Mat grey(size, CV_8U);
    cv::RNG random(seed);
    random.fill(grey, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(grey, grey, {}, 1.6);
    cv::normalize(grey, grey, 20, 235, cv::NORM_MINMAX);
    return grey;
}

}  // namespace hitchview::tests

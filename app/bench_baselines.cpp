#include "app/bench_baselines.hpp"

#include <chrono>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "app/evaluation_statistics.hpp"

namespace hitchview::app {
namespace {

template <typename Work>
double MedianMs(int times, Work&& work) {
    std::vector<double> all;
    for (int i = 0; i < times; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - start;
        all.push_back(took.count());
    }
    return Quantile(std::move(all), 0.5).value();
}

}  // namespace

double MemcpyMs(const BenchFrames& frames, std::size_t panorama_bytes) {
    std::vector<std::uint8_t> pictures(frames.BytesPerSet());
    const std::vector<std::uint8_t> panorama(panorama_bytes, 1);
    std::vector<std::uint8_t> copy(panorama_bytes);
    int set = 0;
    return MedianMs(31, [&] {
        frames.CopySet(set++ % BenchFrames::kSets, pictures);
        std::memcpy(copy.data(), panorama.data(), panorama_bytes);
        asm volatile("" : : "r"(pictures.data()), "r"(copy.data()) : "memory");
    });
}

double RemapMs(int camera_width_px, int camera_height_px, int width_px, int height_px) {
    constexpr int kCameras = 8;
    const cv::Mat3b picture(camera_height_px, camera_width_px, cv::Vec3b(10, 20, 30));
    // Like a ring of cameras: the columns run through the picture so many times, slightly tilted.
    cv::Mat2f map(height_px, width_px);
    const auto right = static_cast<float>(camera_width_px - 2);
    const auto bottom = static_cast<float>(camera_height_px - 2);
    for (int y = 0; y < height_px; ++y) {
        const float down = static_cast<float>(y) / static_cast<float>(height_px);
        for (int x = 0; x < width_px; ++x) {
            const float across =
                static_cast<float>(x * kCameras % width_px) / static_cast<float>(width_px);
            map(y, x) = {across * right, (0.9F * down + 0.1F * across) * bottom};
        }
    }
    cv::Mat whole;
    cv::Mat fraction;
    cv::convertMaps(map, cv::noArray(), whole, fraction, CV_16SC2);
    const int threads = cv::getNumThreads();
    cv::setNumThreads(1);
    cv::Mat3b out(height_px, width_px);
    const double ms =
        MedianMs(15, [&] { cv::remap(picture, out, whole, fraction, cv::INTER_LINEAR); });
    cv::setNumThreads(threads);
    return ms;
}

}  // namespace hitchview::app

#include <benchmark/benchmark.h>

#include <cstring>
#include <ctime>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "algo/grey_pyramid.hpp"
#include "algo/multiband_blend.hpp"
#include "algo/panorama_renderer.hpp"
#include "algo/semi_surround_view.hpp"
#include "algo/unified_options.hpp"
#include "drivers/simulated_rig.hpp"
#include "tests/support/camera_picture.hpp"
#include "tests/support/nv12_picture.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview {
namespace {

using algo::PixelLayout;
using algo::SampleRange;
using algo::Unit;
using tests::CameraPicture;

const cv::Size kCamera(1280, 720);
const cv::Size kPanorama(4096, 720);
constexpr double kAnalysisScale = 0.25;

/// Eight cameras round a tractor-trailer with the mounts of the simulated one, a composition as
/// while driving, and pictures of one format.
class Ring {
 public:
    Ring(PixelLayout layout, SampleRange range) {
        const auto cameras = drivers::SimulatedRigGeometry(kCamera.width, kCamera.height);
        for (const Unit unit : algo::kUnits) {
            std::vector<algo::CameraGeometry> mounted;
            for (const drivers::SimulatedCameraGeometry& camera : cameras) {
                if (camera.unit == unit) mounted.push_back(camera.geometry);
            }
            const double middle_rad = unit == Unit::kTractor ? 0 : std::numbers::pi;
            geometry_[unit] = algo::UnitGeometry::Ring(
                algo::Projection::Cylinder(kPanorama.width, kPanorama.height, 0.48, middle_rad),
                mounted, {});
            for (std::size_t i = 0; i < mounted.size(); ++i) {
                pictures_.push_back(CameraPicture::Textured(kCamera, layout, range, 7 + i));
                frames_[unit][i] = pictures_.back().frame();
                gains_[unit][i] = 0.94F + 0.03F * static_cast<float>(i);
            }
        }
        for (const Unit unit : algo::kUnits) {
            views_[unit].emplace(*geometry_[unit], kAnalysisScale);
            pyramids_[unit].emplace(views_[unit]->width_px(), views_[unit]->height_px());
        }
        composition_.M_canvas_view[Unit::kTrailer] = algo::ToPose(canvas_, {{131, 0.02, -0.01}});
        composition_.discrepancy.setConstant(1.7F);
        map_.emplace(canvas_, geometry_, algo::SeamOptionsOf(canvas_));
        const algo::RigPictures pictures{frames_, gains_};
        map_->Build(composition_, pictures, runner_);
        bands_.emplace(*map_);
        bands_->Update(*map_, pictures, runner_);
        renderer_.SetGains(gains_);
    }

    void Render(tests::PanoramaPicture& panorama) {
        renderer_.RenderBlended(*map_, frames_, *bands_, panorama.planes(), runner_);
    }
    /// Both units' views, as the estimation wants them.
    void ComposeGrey() {
        for (const Unit unit : algo::kUnits) {
            views_[unit]->Compose(frames_[unit], pyramids_[unit]->base());
            pyramids_[unit]->Build();
        }
    }
    /// Of all cameras and the panorama.
    [[nodiscard]] std::size_t bytes() const {
        std::size_t sum = static_cast<std::size_t>(kPanorama.area()) * 3 / 2;
        for (const CameraPicture& picture : pictures_) sum += picture.bytes();
        return sum;
    }

 private:
    algo::Projection canvas_ = algo::Projection::Cylinder(kPanorama.width, kPanorama.height, 0.48);
    algo::PerUnit<std::optional<algo::UnitGeometry>> geometry_;
    std::vector<CameraPicture> pictures_;
    algo::RigFrames frames_;
    algo::CameraGains gains_{};
    algo::Composition composition_;
    std::optional<algo::ComposedMap> map_;
    std::optional<algo::MultibandBlend> bands_;
    algo::PanoramaRenderer renderer_;
    algo::PerUnit<std::optional<algo::SemiSurroundView>> views_;
    algo::PerUnit<std::optional<algo::GreyPyramid>> pyramids_;
    algo::SerialRunner runner_;
};

/// One cv::remap of a colour picture to the panorama's size, on one thread, as a yardstick: all of
/// the panorama from one picture, once for each pixel, without blending.
class Remap {
 public:
    Remap() : picture_(kCamera, CV_8UC3), panorama_(kPanorama, CV_8UC3) {
        cv::setNumThreads(1);
        cv::randu(picture_, 0, 256);
        cv::Mat2f map(kPanorama);
        for (int y = 0; y < map.rows; ++y) {
            for (int x = 0; x < map.cols; ++x) {
                const double turn = 0.02 * std::sin(x * 0.004);
                map(y, x) = {static_cast<float>(x % 1270 * 0.99 + 4 + turn * y),
                             static_cast<float>(y * 0.97 + 5 + 6 * std::sin(x * 0.01))};
            }
        }
        cv::convertMaps(map, cv::Mat(), whole_, fraction_, CV_16SC2);
    }
    void Run() {
        cv::remap(picture_, panorama_, whole_, fraction_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    }

 private:
    cv::Mat picture_;
    cv::Mat panorama_;
    cv::Mat whole_;
    cv::Mat fraction_;
};

/// What this thread has used of a processor.
double ThreadTime_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds of a core for one call, the fastest of some.
template <typename Work>
double Fastest_s(Work&& work) {
    double fastest = 1e9;
    for (int i = 0; i < 15; ++i) {
        const double start_s = ThreadTime_s();
        work();
        fastest = std::min(fastest, ThreadTime_s() - start_s);
    }
    return fastest;
}

void RenderPanorama(benchmark::State& state, PixelLayout layout, SampleRange range) {
    Ring ring(layout, range);
    tests::PanoramaPicture panorama(kPanorama);
    for (auto _ : state) ring.Render(panorama);
    Remap remap;
    std::vector<std::uint8_t> from(ring.bytes() / 2, 1);
    std::vector<std::uint8_t> to(from.size());
    const double render_s = Fastest_s([&] { ring.Render(panorama); });
    state.counters["best_ms"] = 1e3 * render_s;
    state.counters["of_remap"] = render_s / Fastest_s([&] { remap.Run(); });
    state.counters["of_memcpy"] = render_s / Fastest_s([&] {
                                      std::memcpy(to.data(), from.data(), from.size());
                                      benchmark::DoNotOptimize(to.data());
                                      benchmark::ClobberMemory();
                                  });
}
BENCHMARK_CAPTURE(RenderPanorama, nv12, PixelLayout::kNv12, SampleRange::kFull)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RenderPanorama, nv12_limited, PixelLayout::kNv12, SampleRange::kLimited)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RenderPanorama, uyvy, PixelLayout::kUyvy, SampleRange::kFull)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RenderPanorama, uyvy_limited, PixelLayout::kUyvy, SampleRange::kLimited)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RenderPanorama, yuyv_limited, PixelLayout::kYuyv, SampleRange::kLimited)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RenderPanorama, grey, PixelLayout::kGrey, SampleRange::kFull)
    ->Unit(benchmark::kMillisecond);

void ComposeGreyViews(benchmark::State& state, PixelLayout layout) {
    Ring ring(layout, SampleRange::kFull);
    for (auto _ : state) ring.ComposeGrey();
    state.counters["best_ms"] = 1e3 * Fastest_s([&] { ring.ComposeGrey(); });
}
BENCHMARK_CAPTURE(ComposeGreyViews, nv12, PixelLayout::kNv12)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ComposeGreyViews, uyvy, PixelLayout::kUyvy)->Unit(benchmark::kMillisecond);

void RemapColour(benchmark::State& state) {
    Remap remap;
    for (auto _ : state) remap.Run();
}
BENCHMARK(RemapColour)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hitchview

#include <benchmark/benchmark.h>

#include <array>
#include <optional>

#include "algo/composed_map.hpp"
#include "algo/exposure_gains.hpp"
#include "algo/multiband_blend.hpp"
#include "algo/unified_options.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "app/bench_frames.hpp"
#include "app/jpeg_encoder.hpp"
#include "app/pipeline.hpp"
#include "app/simulated_geometry.hpp"
#include "app/worker_pool.hpp"
#include "drivers/simulated_scenario.hpp"
#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

constexpr int kPanoramaWidth_px = 4096;

/// Eight cameras of 1280 x 720 on a straight drive, their frames in memory, made once.
class Drive {
 public:
    static Drive& Instance() {
        static Drive drive;
        return drive;
    }

    [[nodiscard]] const RigGeometry& geometry() const { return *geometry_; }
    FrameSet Next() { return frames_->Set(next_++, hal::Instant{}); }

 private:
    Drive() {
        drivers::SimulationOptions options = drivers::FindScenario("straight")->options;
        options.width_px = 1280;
        options.height_px = 720;
        options.frames = BenchFrames::kSets;
        options.render_threads = 1;
        auto rig = drivers::SimulatedRig::Create(options);
        HV_EXPECT(rig.ok());
        auto geometry = GeometryOf(**rig, kPanoramaWidth_px);
        HV_EXPECT(geometry.ok());
        geometry_.emplace(std::move(*geometry));
        WorkerPool workers(UsableCpus());
        frames_.emplace(**rig, drivers::SimulatedRig::kCameras, hal::PixelFormat::kUyvy, "",
                        workers);
    }

    std::optional<RigGeometry> geometry_;
    std::optional<BenchFrames> frames_;
    int next_ = 0;
};

/// The stages of a pipeline, each with what those before it made of one frame set. One thread.
class Stages {
 public:
    Stages()
        : rig_(Drive::Instance().geometry()),
          motion_(rig_.canvas, rig_.units, {}),
          map_(rig_.canvas, rig_.units, algo::SeamOptionsOf(rig_.canvas)),
          bands_(map_) {
        motion_.Prime(Borrow(Drive::Instance().Next()), runner_);
        motion_.Reset();
        for (int i = 0; i < 10; ++i) Motion();
        Map();
        Gains();
        Bands();
    }

    void Motion() {
        set_ = Drive::Instance().Next();
        frames_ = Borrow(set_);
        composition_ = motion_.Step(frames_, runner_);
        HV_EXPECT(composition_ != nullptr);
    }
    void Map() { map_.Build(*composition_, {frames_, gains_.gains()}, runner_); }
    void Gains() { gains_.Update(map_, frames_); }
    void Bands() { bands_.Update(map_, {frames_, gains_.gains()}, runner_); }

 private:
    RigGeometry rig_;
    algo::SerialRunner runner_;
    algo::UnifiedVertexMotion motion_;
    algo::ComposedMap map_;
    algo::ExposureGains gains_;
    algo::MultibandBlend bands_;
    FrameSet set_;
    algo::RigFrames frames_;
    const algo::Composition* composition_ = nullptr;
};

constexpr std::array kInOrder{&Stages::Motion, &Stages::Map, &Stages::Gains, &Stages::Bands};

/// The stage with this number, of another frame set each time.
void RunStage(benchmark::State& state, std::size_t number) {
    Stages stages;
    for (auto _ : state) {
        state.PauseTiming();
        for (std::size_t i = 0; i < number; ++i) (stages.*kInOrder[i])();
        state.ResumeTiming();
        (stages.*kInOrder[number])();
    }
}
BENCHMARK_CAPTURE(RunStage, motion, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RunStage, map, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RunStage, gains, 2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RunStage, bands, 3)->Unit(benchmark::kMillisecond);

/// All stages, shared by some workers.
class PrimedPipeline {
 public:
    explicit PrimedPipeline(int count)
        : workers(count),
          motion_(Drive::Instance().geometry().canvas, Drive::Instance().geometry().units, {}),
          pipeline_(Drive::Instance().geometry(), motion_, workers) {
        pipeline_.Prime(Drive::Instance().Next());
        pipeline_.Start();
    }
    ~PrimedPipeline() { pipeline_.Start(); }  // gives the last leases back
    PrimedPipeline(const PrimedPipeline&) = delete;
    PrimedPipeline& operator=(const PrimedPipeline&) = delete;

    hal::FrameView Panorama() { return pipeline_.Process(Drive::Instance().Next())->picture; }

    WorkerPool workers;

 private:
    algo::UnifiedVertexMotion motion_;
    Pipeline pipeline_;
};

/// From a frame set to its panorama; the argument is the number of workers.
void RunPipeline(benchmark::State& state) {
    PrimedPipeline pipeline(static_cast<int>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(pipeline.Panorama());
}
BENCHMARK(RunPipeline)
    ->DenseRange(1, 4)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// The panorama's JPEG; the argument is the number of threads.
void CompressPanorama(benchmark::State& state) {
    PrimedPipeline pipeline(static_cast<int>(state.range(0)));
    const hal::FrameView panorama = pipeline.Panorama();
    JpegEncoder encoder(panorama.format, {.budget_bytes = 4'000'000});
    for (auto _ : state) benchmark::DoNotOptimize(encoder.Encode(panorama, pipeline.workers));
}
BENCHMARK(CompressPanorama)->DenseRange(1, 4)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace hitchview::app

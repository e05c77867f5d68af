#include "app/bench_run.hpp"

#include <ctime>
#include <vector>

#include "algo/unified_vertex_motion.hpp"
#include "app/bench_recording.hpp"
#include "app/evaluation_statistics.hpp"
#include "app/panorama_publisher.hpp"
#include "app/pipeline.hpp"
#include "app/worker_pool.hpp"
#include "drivers/steady_clock.hpp"

namespace hitchview::app {
namespace {

constexpr int kWarmUpFrames = 20;
/// Of a compressed panorama, so that no picture is compressed twice.
constexpr int kMaxJpegBytes = 4'000'000;

double CpuMs(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double Ms(hal::Instant duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

/// Takes panoramas as display units would, and notes when. Read it when the publisher has finished.
class Display final : public hal::Publisher {
 public:
    /// `recording`: has everything too; null: there is none.
    explicit Display(const hal::Clock& clock, hal::Publisher* recording = nullptr)
        : clock_(clock), recording_(recording) {}

    std::vector<double> latencies_ms;
    std::vector<double> intervals_ms;
    std::vector<double> bytes;

 private:
    hal::Result<hal::Done> DoPublish(const hal::PanoramaImage& image) override {
        const hal::Instant now = clock_.Now();
        latencies_ms.push_back(Ms(now - image.captured_until));
        bytes.push_back(static_cast<double>(image.jpeg.size()));
        if (newest_.count() != 0) intervals_ms.push_back(Ms(now - newest_));
        newest_ = now;
        return recording_ != nullptr ? recording_->Publish(image) : hal::Done{};
    }
    hal::Result<hal::Done> DoPublish(const hal::PanoramaStatus& /*status*/) override {
        return hal::Done{};
    }
    hal::Result<hal::Done> DoPublish(const hal::HitchAngle& /*angle*/) override {
        return hal::Done{};
    }
    hal::Result<hal::Done> DoPublish(const hal::Event& /*event*/) override { return hal::Done{}; }

    const hal::Clock& clock_;
    hal::Publisher* recording_;
    hal::Instant newest_{};
};

class BenchDrive {
 public:
    BenchDrive(const RigGeometry& geometry, BenchFrames& frames, const BenchRunOptions& options)
        : frames_(frames),
          options_(options),
          workers_(options.workers),
          motion_(geometry.canvas, geometry.units, {}),
          pipeline_(geometry, motion_, workers_) {
        pipeline_.Prime(frames_.Set(0, clock_.Now()));
        pipeline_.Start();
        for (int i = 0; i < kWarmUpFrames; ++i) pipeline_.Process(Next());
    }
    ~BenchDrive() { pipeline_.Start(); }  // gives the last leases back
    BenchDrive(const BenchDrive&) = delete;
    BenchDrive& operator=(const BenchDrive&) = delete;

    void RunUnpaced(BenchFigures& figures) {
        Display display(clock_);
        const double all_start_ms = CpuMs(CLOCK_PROCESS_CPUTIME_ID);
        const double pipeline_start_ms = PipelineCpuMs();
        {
            PanoramaPublisher publisher = OpenPublisher(display, false);
            const int tenth = options_.frames / 10;
            const double first_ms = PublishSets(publisher, tenth);
            PublishSets(publisher, options_.frames - 2 * tenth);
            figures.growth = PublishSets(publisher, tenth) / first_ms;
            publisher.Finish();
        }
        const double all_ms = CpuMs(CLOCK_PROCESS_CPUTIME_ID) - all_start_ms;
        figures.core_ms = (PipelineCpuMs() - pipeline_start_ms) / options_.frames;
        figures.jpeg_ms = all_ms / options_.frames - figures.core_ms;
        figures.jpeg_bytes = Quantile(display.bytes, 0.5).value_or(0);
        figures.interval_ms = Quantile(display.intervals_ms, 0.5).value_or(0);
        figures.times = pipeline_.times();
    }

    PacedFigures RunPaced(hal::Instant period) {
        Display display(clock_);
        return RunPaced(period, display, [](FrameSet set) { return set; });
    }

    PacedFigures RunRecorded(hal::Instant period, const std::filesystem::path& folder,
                             RecordingSummary& summary) {
        BenchRecording recording(folder, Next(), clock_);
        Display display(clock_, &recording.publisher());
        const PacedFigures figures =
            RunPaced(period, display, [&](FrameSet set) { return recording.Tap(std::move(set)); });
        summary = recording.Finish();
        return figures;
    }

 private:
    template <typename Tap>
    PacedFigures RunPaced(hal::Instant period, Display& display, Tap&& tap) {
        PanoramaPublisher publisher = OpenPublisher(display, true);
        PacedFigures figures;
        const hal::Instant start = clock_.Now();
        for (int i = 0; i < options_.frames; ++i) {
            const hal::Instant due = start + period * i;
            if (clock_.Now() > due + period) continue;
            clock_.SleepUntil(due);
            Publish(publisher, tap(frames_.Set(next_++, due)));
            const double total_ms = pipeline_.times()[static_cast<int>(Stage::kTotal)].last_ms();
            if (total_ms > Ms(period)) ++figures.deadline_misses;
        }
        publisher.Finish();
        figures.p50_ms = Quantile(display.latencies_ms, 0.5).value_or(0);
        figures.p99_ms = Quantile(display.latencies_ms, 0.99).value_or(0);
        figures.dropped = options_.frames - static_cast<int>(display.latencies_ms.size());
        return figures;
    }

    /// Of this thread and the workers.
    [[nodiscard]] double PipelineCpuMs() const {
        return CpuMs(CLOCK_THREAD_CPUTIME_ID) + Ms(workers_.cpu_time());
    }

    FrameSet Next() { return frames_.Set(next_++, clock_.Now()); }

    PanoramaPublisher OpenPublisher(hal::Publisher& display, bool drop_when_late) {
        return PanoramaPublisher(display, clock_, {}, pipeline_.format(),
                                 {.jpeg = {.budget_bytes = kMaxJpegBytes},
                                  .calibration_id = {},
                                  .drop_when_late = drop_when_late,
                                  .threads = options_.workers});
    }

    /// CPU time that passed meanwhile.
    double PublishSets(PanoramaPublisher& publisher, int count) {
        const double start_ms = CpuMs(CLOCK_PROCESS_CPUTIME_ID);
        for (int i = 0; i < count; ++i) Publish(publisher, Next());
        return CpuMs(CLOCK_PROCESS_CPUTIME_ID) - start_ms;
    }

    void Publish(PanoramaPublisher& publisher, FrameSet&& set) {
        const ShownPanorama& shown = *pipeline_.Process(std::move(set));
        publisher.Append(
            {.picture = shown.picture, .captured_until = shown.captured_until, .status = {}});
    }

    BenchFrames& frames_;
    BenchRunOptions options_;
    drivers::SteadyClock clock_;
    WorkerPool workers_;
    algo::UnifiedVertexMotion motion_;
    Pipeline pipeline_;
    int next_ = 0;
};

}  // namespace

BenchFigures RunBench(const RigGeometry& geometry, BenchFrames& frames,
                      const BenchRunOptions& options) {
    BenchFigures figures;
    BenchDrive drive(geometry, frames, options);
    drive.RunUnpaced(figures);
    if (options.period) figures.paced = drive.RunPaced(*options.period);
    if (options.period && !options.record.empty())
        figures.recorded =
            drive.RunRecorded(*options.period, options.record, figures.recording.emplace());
    return figures;
}

}  // namespace hitchview::app

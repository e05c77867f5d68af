#include "app/bench_recording.hpp"

#include <string>
#include <utility>

#include "app/log_channels.hpp"
#include "app/record_setup.hpp"
#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

constexpr int kMaxJpegBytes = 4'000'000;

}  // namespace

BenchRecording::BenchRecording(const std::filesystem::path& folder, const FrameSet& first,
                               hal::Clock& clock) {
    std::vector<RecordedCamera> cameras;
    drivers::RecordedRig rig{.period_ms = 33.333};
    for (const algo::Unit unit : algo::kUnits) {
        for (std::size_t i = 0; i < algo::kMaxCameras; ++i) {
            const hal::FrameLease& lease = first.leases[unit][i];
            if (!lease) continue;
            const std::string name = std::string(ToString(unit)) + std::to_string(i);
            cameras.push_back({name, CameraChannel(name), lease.view().format, &taps_[unit][i]});
            rig.cameras.push_back(name);
            rig.camera_channels.push_back(CameraChannel(name));
        }
    }
    auto opened = Recorder::Open({.folder = {.folder = folder}}, rig, cameras, clock, events_);
    HV_EXPECT(opened.ok());
    recorder_ = std::move(opened.value());
    auto publisher = OpenRecordingPublisher({.max_bytes = kMaxJpegBytes}, clock, *recorder_);
    HV_EXPECT(publisher.ok());
    publisher_ = std::move(publisher.value());
    recorder_->Start({});
}

FrameSet BenchRecording::Tap(FrameSet set) {
    for (const algo::Unit unit : algo::kUnits)
        for (std::size_t i = 0; i < algo::kMaxCameras; ++i)
            if (set.leases[unit][i])
                set.leases[unit][i] = taps_[unit][i].Offer(std::move(set.leases[unit][i]));
    return set;
}

RecordingSummary BenchRecording::Finish() {
    recorder_->Finish();
    return recorder_->Summarise();
}

}  // namespace hitchview::app

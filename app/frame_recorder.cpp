#include "app/frame_recorder.hpp"

#include <algorithm>
#include <utility>

#include "app/packed_frame.hpp"
#include "app/thread_schedule.hpp"
#include "drivers/lcm_record_messages.hpp"

namespace hitchview::app {

/// A camera and what became of its frames.
struct FrameRecorder::Channel {
    RecordedCamera camera;
    FrameJpeg* jpeg = nullptr;  ///< null: raw
    std::atomic<std::uint64_t> recorded{0};
    std::atomic<std::uint64_t> refused{0};  ///< by the ring
    std::uint64_t drops_told = 0;
};

/// A thread, its cameras and its memory.
struct FrameRecorder::Worker {
    std::vector<Channel*> channels;
    std::vector<std::unique_ptr<FrameJpeg>> jpegs;  ///< one for each format
    std::vector<std::uint8_t> packed;
    WorkBell bell;
    std::thread thread;

    FrameJpeg& JpegFor(const hal::FrameFormat& format, int quality) {
        for (const auto& jpeg : jpegs)
            if (jpeg->format() == format) return *jpeg;
        return *jpegs.emplace_back(std::make_unique<FrameJpeg>(format, quality));
    }
};

FrameRecorder::FrameRecorder(std::vector<RecordedCamera> cameras,
                             const FrameRecorderOptions& options, RecordIntake& intake)
    : options_(options), intake_(intake) {
    const std::size_t threads = std::min(static_cast<std::size_t>(options.threads),
                                         std::max<std::size_t>(cameras.size(), 1));
    for (std::size_t i = 0; i < threads; ++i) workers_.push_back(std::make_unique<Worker>());
    for (RecordedCamera& camera : cameras) {
        Worker& worker = *workers_[channels_.size() % threads];
        Channel& channel = *channels_.emplace_back(std::make_unique<Channel>());
        channel.camera = std::move(camera);
        worker.channels.push_back(&channel);
        if (options.raw)
            worker.packed.resize(
                std::max(worker.packed.size(), hal::FrameBytes(channel.camera.format)));
        else
            channel.jpeg = &worker.JpegFor(channel.camera.format, options.quality);
    }
    for (std::size_t i = 0; i < threads; ++i) {
        Worker& worker = *workers_[i];
        worker.thread = std::thread([this, &worker, i] { Work(worker, static_cast<int>(i) + 1); });
    }
}

FrameRecorder::~FrameRecorder() {
    Finish();
}

void FrameRecorder::Start() {
    const auto when_full =
        intake_.lossless() ? FrameTap::WhenFull::kWait : FrameTap::WhenFull::kDrop;
    for (const auto& worker : workers_)
        for (Channel* channel : worker->channels)
            channel->camera.tap->Open(when_full, options_.every, worker->bell);
}

void FrameRecorder::Finish() {
    for (const auto& channel : channels_) channel->camera.tap->Close();
    stop_ = true;
    for (const auto& worker : workers_) {
        worker->bell.Ring();
        if (worker->thread.joinable()) worker->thread.join();
    }
}

void FrameRecorder::Work(Worker& worker, int number) {
    NameThisThread("record-" + std::to_string(number));
    RunInBackground();
    while (true) {
        const std::uint32_t rings = worker.bell.rings();
        const bool stopping = stop_;
        bool worked = false;
        for (Channel* channel : worker.channels) worked |= RecordNext(worker, *channel);
        if (worked) continue;
        if (stopping) return;
        worker.bell.WaitWhile(rings);
    }
}

/// One frame of the camera, so that the others have their turn. False: it has none.
bool FrameRecorder::RecordNext(Worker& worker, Channel& channel) {
    NoteDrops(channel);
    const auto lease = channel.camera.tap->Take();
    if (!lease) return false;
    Record(worker, channel, lease->view());
    return true;
}

void FrameRecorder::Record(Worker& worker, Channel& channel, const hal::FrameView& frame) {
    const bool compressed = channel.jpeg != nullptr;
    const drivers::CameraPicture picture{
        .utime_us = intake_.UtimeOf(frame.header.captured_at),
        .format = frame.format,
        .compressed = compressed,
        .sequence = frame.header.sequence / options_.every,
        .captured_at = frame.header.captured_at + intake_.origin(),
        .data = compressed ? channel.jpeg->Compress(frame) : PackFrame(frame, worker.packed)};
    const auto place =
        intake_.Reserve(picture.utime_us, channel.camera.channel, drivers::MostBytesOf(picture));
    if (!place) {
        ++channel.refused;
        return;
    }
    intake_.Commit(*place, drivers::Encode(picture, place->data));
    ++channel.recorded;
}

void FrameRecorder::NoteDrops(Channel& channel) {
    const std::uint64_t dropped = channel.camera.tap->counts().dropped;
    for (; channel.drops_told < dropped; ++channel.drops_told)
        intake_.NoteDropped("camera frames are left out: there is no time to compress them");
}

std::vector<FrameCounts> FrameRecorder::counts() const {
    std::vector<FrameCounts> counts;
    for (const auto& channel : channels_)
        counts.push_back({channel->camera.name, channel->recorded,
                          channel->refused + channel->camera.tap->counts().dropped});
    return counts;
}

}  // namespace hitchview::app

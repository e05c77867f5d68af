#include "drivers/v4l2_camera.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

#include "drivers/frame_clock.hpp"
#include "drivers/v4l2_bandwidth.hpp"

namespace hitchview::drivers {
namespace {

using hal::Checked;
using hal::Done;
using hal::Error;
using hal::FrameLease;
using hal::Result;
using std::chrono::milliseconds;

/// Without the heap: the words are glibc's own.
const char* Words(const V4l2Failure& failure) {
    const char* words = strerrordesc_np(failure.error_number);
    return failure.error_number == 0 || words == nullptr ? "" : words;
}

void Log(const V4l2CameraOptions& options, const char* what, const V4l2Failure& failure) {
    std::fprintf(stderr, "camera %s (%s): %s: %s %s\n", options.name.c_str(), options.path.c_str(),
                 what, failure.call, Words(failure));
}

bool IsCompressed(const V4l2PixelFormat& format) {
    return format.line_bytes_per_pixel == 0;
}

hal::CameraLoss LossOf(const V4l2Failure& failure) {
    using hal::CameraLoss;
    const int number = failure.error_number;
    if (number == ENODEV || number == ENXIO || number == ENOENT) return CameraLoss::kDisconnected;
    if (number == EBUSY) return CameraLoss::kBusy;
    if (number == EACCES || number == EPERM) return CameraLoss::kForbidden;
    if (failure.error == Error::kTimeout) return CameraLoss::kSilent;
    if (failure.error == Error::kNotFound) return CameraLoss::kNoSignal;
    if (failure.error == Error::kUnsupported) return CameraLoss::kOtherFormat;
    return CameraLoss::kIoError;
}

hal::Instant PeriodOf(double rate_hz) {
    return hal::Instant(std::llround(1e9 / rate_hz));
}

}  // namespace

V4l2Camera::V4l2Camera(const V4l2CameraOptions& options, V4l2Kernel& kernel)
    : options_(options),
      period_(PeriodOf(options.wish.rate_hz)),
      negotiation_(options, kernel),
      device_(negotiation_.device()),
      buffers_(options.buffers),
      accounting_(period_) {}

V4l2Camera::~V4l2Camera() {
    Disconnect();
}

Checked<std::unique_ptr<V4l2Camera>> V4l2Camera::Open(const V4l2CameraOptions& options,
                                                      V4l2Kernel& kernel) {
    auto opened = TryOpen(options, kernel);
    if (!opened) return opened.error().words;
    return std::move(opened.value());
}

V4l2Camera::Opened V4l2Camera::TryOpen(const V4l2CameraOptions& options, V4l2Kernel& kernel) {
    HV_EXPECT(options.wish.rate_hz > 0 && options.silence_periods >= 2);
    HV_EXPECT(options.orientation.rotation_deg == 0 || options.orientation.rotation_deg == 180);
    std::unique_ptr<V4l2Camera> camera(new V4l2Camera(options, kernel));
    if (auto started = camera->Start(); !started) {
        V4l2Refusal refusal = started.error();
        refusal.words = options.path + ": " + refusal.words;
        return refusal;
    }
    return camera;
}

std::unique_ptr<V4l2Camera> V4l2Camera::Await(const V4l2CameraOptions& options,
                                              const V4l2Failure& why,
                                              std::span<const V4l2Camera* const> others,
                                              V4l2Kernel& kernel) {
    std::vector<const V4l2Negotiation*> agreed;
    for (const V4l2Camera* const other : others) agreed.push_back(&other->negotiation_);
    std::unique_ptr<V4l2Camera> camera(new V4l2Camera(options, kernel));
    camera->Settle(camera->negotiation_.Expect(agreed));
    camera->last_refusal_ = why;
    camera->loss_ = LossOf(why);
    camera->drained_ = true;  // nothing comes before it is had
    return camera;
}

hal::Result<Done, V4l2Refusal> V4l2Camera::Start() {
    const auto granted = negotiation_.Agree();
    if (!granted) return granted.error();
    Settle(granted.value());
    if (const auto streams = Stream(); !streams)
        return V4l2Refusal{.words = ToString(streams.error()), .failure = streams.error()};
    NoteFacts();
    return Done{};
}

void V4l2Camera::Settle(const V4l2Granted& granted) {
    facts_.granted = granted;
    const V4l2Layout& layout = granted.layout;
    const bool compressed = IsCompressed(negotiation_.pixel_format());
    format_ = {layout.width_px, layout.height_px, negotiation_.pixel_format().delivered,
               compressed ? hal::Range::kFull : layout.range};
    if (!compressed) return;
    pool_ = std::make_unique<hal::FramePool>(format_, options_.buffers);
    decoder_ = std::make_unique<FrameJpegDecoder>(format_);
}

void V4l2Camera::NoteFacts() {
    facts_.identity = negotiation_.identity();
    facts_.stamps = StampSourceOf(buffers_.stamp_flags());
    facts_.dmabuf = buffers_.exported();
    facts_.buffer_read_gb_per_s = ReadBandwidth(buffers_.first_mapping());
    facts_.ordinary_read_gb_per_s = OrdinaryReadBandwidth(buffers_.first_mapping().size());
}

V4l2Result<Done> V4l2Camera::Stream() {
    const auto taken = buffers_.Take(device_, facts_.granted.layout, options_.export_dmabuf);
    if (!taken) return taken.error();
    if (const auto queued = buffers_.Queue(device_); !queued) return queued.error();
    if (const auto started = StartStream(device_); !started) return started.error();
    accounting_.Restart();
    streaming_ = true;
    restarted_ = false;
    heard_at_ = Now();
    return Done{};
}

Result<FrameLease> V4l2Camera::DoWaitFrame(milliseconds timeout) {
    if (!std::exchange(drained_, true)) Drain();
    const hal::Instant end = Now() + timeout;
    for (hal::Instant now = Now(); now < end; now = Now()) {
        if (!streaming_) return Error::kDisconnected;
        if (auto answer = Step(std::chrono::ceil<milliseconds>(end - now))) {
            return std::move(*answer);
        }
    }
    return Error::kTimeout;
}

V4l2Camera::MaybeAnswer V4l2Camera::Step(milliseconds timeout) {
    // A buffer that is refused is offered again; only a device that is gone ends the stream here.
    const auto queued = buffers_.Queue(device_);
    if (!queued && queued.error().error == Error::kDisconnected) return Lose(queued.error());
    const Woken woken = Wait(timeout);
    if (!woken.error && woken.event && TakeSourceChange(device_)) return FollowSource();
    // A signal that interrupts poll looks like an error of the device: what it answers counts.
    if (woken.frame || woken.error) {
        if (auto answer = TakeFrame()) return answer;
    }
    const auto watched = Watch();
    if (!watched) return Lose(watched.error());
    return std::nullopt;
}

V4l2Camera::MaybeAnswer V4l2Camera::FollowSource() {
    Disconnect();
    const auto again = AgreeAgainAndStream();
    if (!again) return Lose(again.error());
    return std::nullopt;
}

V4l2Camera::Woken V4l2Camera::Wait(milliseconds timeout) {
    const auto events =
        static_cast<short>(negotiation_.source_may_change() ? POLLIN | POLLPRI : POLLIN);
    std::array files{pollfd{device_.file(), events, 0},
                     pollfd{buffers_.returned_event(), POLLIN, 0}};
    const milliseconds patience =
        std::chrono::ceil<milliseconds>(options_.silence_periods * period_);
    device_.kernel().Poll(files, std::min(timeout, patience));
    if (files[1].revents != 0) buffers_.NoteWoken();
    const int told = files[0].revents;
    return {(told & POLLIN) != 0, (told & POLLPRI) != 0,
            (told & (POLLERR | POLLHUP | POLLNVAL)) != 0};
}

void V4l2Camera::Drain() {
    while (Wait(milliseconds(0)).frame && buffers_.Dequeue(device_)) {
    }
    // It has been filling buffers, or had none left: how long nobody asked says nothing about it.
    heard_at_ = Now();
}

V4l2Camera::MaybeAnswer V4l2Camera::TakeFrame() {
    const auto filled = buffers_.Dequeue(device_);
    if (!filled && filled.error().error == Error::kTimeout) return std::nullopt;
    if (!filled) return Lose(filled.error());
    heard_at_ = Now();
    restarted_ = false;
    return Lend(filled.value());
}

V4l2Camera::MaybeAnswer V4l2Camera::Lend(const V4l2Buffers::Filled& filled) {
    // A driver may tell the end of a frame that is still to come; a stamp further ahead is not of
    // this clock, whatever the driver says, and none at all is of no clock.
    const bool damaged_by_driver = (filled.flags & V4L2_BUF_FLAG_ERROR) != 0;
    const bool has_stamp = filled.stamp <= heard_at_ + period_ &&
                           (filled.stamp > hal::Instant{} || damaged_by_driver);
    const V4l2StampSource source =
        has_stamp ? StampSourceOf(filled.flags) : V4l2StampSource::kDequeue;
    const hal::Instant stamp = source == V4l2StampSource::kDequeue ? heard_at_ : filled.stamp;
    const auto maybe_planes = PlanesOf(facts_.granted.layout, filled.payload);
    const bool damaged = damaged_by_driver || (decoder_ == nullptr && !maybe_planes);
    auto header = accounting_.Accept(filled.sequence, stamp, damaged);
    if (!header) return header.error();
    header->captured_at = ExposureStart(stamp, source, facts_.granted.maybe_exposure, period_);
    if (decoder_ != nullptr) return Decode(filled, header.value());
    accounting_.NoteDelivered();
    return buffers_.Lend(filled, {format_, header.value(), *maybe_planes});
}

V4l2Camera::MaybeAnswer V4l2Camera::Decode(const V4l2Buffers::Filled& filled,
                                           const hal::FrameHeader& header) {
    const auto maybe_slot = pool_->Take();
    if (!maybe_slot) {
        accounting_.NoteLost();
        return std::nullopt;
    }
    if (const auto decoded = decoder_->Decode(filled.payload[0], maybe_slot->bytes); !decoded) {
        pool_->Return(*maybe_slot);
        accounting_.NoteCorrupted();
        return decoded.error();
    }
    accounting_.NoteDelivered();
    return pool_->Lease(*maybe_slot, header);
}

V4l2Result<Done> V4l2Camera::Watch() {
    // Without a buffer the device has nothing to say anything with.
    if (buffers_.all_lent()) heard_at_ = Now();
    if (Now() - heard_at_ <= options_.silence_periods * period_) return Done{};
    if (restarted_) return V4l2Failure{Error::kTimeout, "it is silent", 0};
    restarted_ = true;
    heard_at_ = Now();
    if (const auto stopped = StopStream(device_); !stopped) return stopped;
    buffers_.NoteStopped();
    accounting_.Restart();
    if (const auto queued = buffers_.Queue(device_); !queued) return queued;
    return StartStream(device_);
}

Error V4l2Camera::Lose(const V4l2Failure& failure) {
    Log(options_, "lost", failure);
    last_refusal_ = failure;
    loss_ = LossOf(failure);
    Disconnect();
    return Error::kDisconnected;
}

void V4l2Camera::Disconnect() {
    const bool stopped = streaming_ && StopStream(device_);
    streaming_ = false;
    buffers_.Drop(device_.kernel());
    if (stopped) buffers_.Free(device_);
    device_.Close();
}

Result<Done> V4l2Camera::DoReopen() {
    if (streaming_) return Done{};
    const auto back = AgreeAgainAndStream();
    if (!back) return NoteRefused(back.error());
    std::fprintf(stderr, "camera %s (%s): back\n", options_.name.c_str(), options_.path.c_str());
    return Done{};
}

V4l2Result<Done> V4l2Camera::AgreeAgainAndStream() {
    const auto granted = negotiation_.AgreeAgain();
    if (granted) facts_.granted = granted.value();
    const auto streams = granted ? Stream() : V4l2Result<Done>(granted.error());
    if (streams) accounting_.NoteReopened();
    if (!streams) Disconnect();
    return streams;
}

Error V4l2Camera::NoteRefused(const V4l2Failure& failure) {
    const bool news =
        failure.call != last_refusal_.call || failure.error_number != last_refusal_.error_number;
    if (news) Log(options_, "not back", failure);
    last_refusal_ = failure;
    return failure.error == Error::kNotFound || failure.error == Error::kUnsupported
               ? failure.error
               : Error::kFailed;
}

hal::PoolLevel V4l2Camera::DoPool() const {
    return pool_ != nullptr ? pool_->level() : buffers_.level();
}

}  // namespace hitchview::drivers

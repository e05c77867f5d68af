#include "drivers/libcamera_driver.hpp"

#include <libcamera/control_ids.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "drivers/frame_clock.hpp"
#include "drivers/libcamera_controls.hpp"

namespace hitchview::drivers {
namespace {

using hal::Checked;
using hal::Done;
using hal::Error;
using hal::FrameLease;
using hal::Result;
using std::chrono::milliseconds;

void Log(const LibcameraOptions& options, const char* what, const char* why) {
    std::fprintf(stderr, "camera %s (%s): %s%s\n", options.name.c_str(), options.id.c_str(), what,
                 why);
}

std::string Words(const char* what, int refused) {
    return std::string(what) + ": " + std::strerror(-refused);
}

}  // namespace

Checked<std::unique_ptr<hal::Camera>> OpenLibcamera(const LibcameraOptions& options) {
    return LibcameraDriver::Open(options);
}

LibcameraDriver::LibcameraDriver(const LibcameraOptions& options)
    : options_(options), period_(std::llround(1e9 / options.rate_hz)), accounting_(period_) {}

LibcameraDriver::~LibcameraDriver() {
    Disconnect();
}

Checked<std::unique_ptr<hal::Camera>> LibcameraDriver::Open(const LibcameraOptions& options) {
    HV_EXPECT(options.rate_hz > 0 && options.silence_periods >= 2);
    HV_EXPECT(options.buffers >= 2 && options.buffers <= LibcameraMailbox::kSlots / 2);
    HV_EXPECT(options.rotation_deg == 0 || options.rotation_deg == 180);
    auto session = LibcameraSession::Join();
    if (!session) return session.error();
    std::unique_ptr<LibcameraDriver> driver(new LibcameraDriver(options));
    driver->session_ = std::move(session.value());
    if (const auto connected = driver->Connect(); !connected)
        return options.id + ": " + connected.error().words;
    return std::unique_ptr<hal::Camera>(std::move(driver));
}

LibcameraDriver::Outcome LibcameraDriver::Connect() {
    LibcameraGranted granted;
    Outcome outcome = Acquire();
    if (outcome) outcome = Configure(granted);
    if (outcome) outcome = Settle(granted);
    if (outcome) outcome = Start();
    if (!outcome) Disconnect();
    return outcome;
}

LibcameraDriver::Outcome LibcameraDriver::Acquire() {
    auto camera = session_->Find(options_.id);
    if (camera == nullptr)
        return Failure{Error::kNotFound, "no such camera; " + session_->CamerasText()};
    if (const int refused = camera->acquire(); refused != 0)
        return Failure{Error::kFailed, Words("cannot be acquired", refused)};
    camera_ = std::move(camera);
    return Done{};
}

LibcameraDriver::Outcome LibcameraDriver::Configure(LibcameraGranted& granted) {
    auto agreed = AgreeWithLibcamera(*camera_, options_);
    if (!agreed) return Failure{Error::kUnsupported, agreed.error()};
    granted = std::move(agreed.value());
    auto controls = PlanLibcameraControls(camera_->controls(), options_.controls);
    if (!controls) return Failure{Error::kUnsupported, controls.error()};
    controls_ = controls.value();
    const auto rate = PlanLibcameraRate(camera_->controls(), options_.rate_hz, controls_);
    if (!rate) return Failure{Error::kUnsupported, rate.error()};
    if (const int refused = camera_->configure(granted.configuration.get()); refused != 0)
        return Failure{Error::kFailed, Words("cannot be configured", refused)};
    const auto taken = buffers_.Take(camera_, granted.stream().stream());
    return taken ? Outcome(Done{}) : Failure{Error::kFailed, taken.error()};
}

LibcameraDriver::Outcome LibcameraDriver::Settle(const LibcameraGranted& granted) {
    const bool first = layout_.pixel_format == nullptr;
    if (!first && (layout_ != granted.layout || format_ != granted.format()))
        return Failure{Error::kUnsupported, "it no longer gives the same format"};
    layout_ = granted.layout;
    format_ = granted.format();
    const bool few = buffers_.count() < options_.buffers;
    const bool copies = few || layout_.pixel_format->packed != LibcameraPixelFormat::Packed::kLent;
    if (!first && copies != (pool_ != nullptr))
        return Failure{Error::kUnsupported, "it no longer gives as many buffers"};
    if (!first || !copies) return Done{};
    pool_ = std::make_unique<hal::FramePool>(format_, options_.buffers);
    if (layout_.pixel_format->packed == LibcameraPixelFormat::Packed::kLent)
        Log(options_, "frames are copied, ", "as its pipeline has fewer buffers than are held");
    return Done{};
}

LibcameraDriver::Outcome LibcameraDriver::Start() {
    camera_->requestCompleted.connect(this, &LibcameraDriver::NoteCompleted);
    camera_->disconnected.connect(this, &LibcameraDriver::NoteGone);
    if (const int refused = camera_->start(&controls_); refused != 0)
        return Failure{Error::kFailed, Words("does not start", refused)};
    running_ = true;
    accounting_.Restart();
    heard_at_ = Now();
    // Some pipelines take controls at the start, others with a request only.
    if (const int refused = buffers_.Queue(*camera_, &controls_); refused != 0)
        return Failure{Error::kFailed, Words("takes no request", refused)};
    return Done{};
}

void LibcameraDriver::Disconnect() {
    if (camera_ == nullptr) return;
    // All requests are completed or cancelled when stop returns; a camera that is gone has stopped.
    if (running_) camera_->stop();
    running_ = false;
    camera_->requestCompleted.disconnect(this);
    camera_->disconnected.disconnect(this);
    buffers_.Drop();
    mailbox_.ForgetStream();
    camera_->release();
    camera_.reset();
}

void LibcameraDriver::NoteCompleted(libcamera::Request* request) {
    if (request->status() != libcamera::Request::RequestComplete) return;
    mailbox_.NoteFilled(static_cast<int>(request->cookie()));
}

Result<FrameLease> LibcameraDriver::DoWaitFrame(milliseconds timeout) {
    if (!std::exchange(drained_, true)) Drain();
    const hal::Instant end = Now() + timeout;
    for (hal::Instant now = Now(); now < end; now = Now()) {
        if (!running_) return Error::kDisconnected;
        if (auto answer = Step(end - now)) return std::move(*answer);
    }
    return Error::kTimeout;
}

LibcameraDriver::MaybeAnswer LibcameraDriver::Step(std::chrono::nanoseconds timeout) {
    const int refused = buffers_.Queue(*camera_);
    if (refused == -ENODEV) return Lose(hal::CameraLoss::kDisconnected);
    const auto patience = options_.silence_periods * period_;
    const LibcameraMailbox::News news = mailbox_.Take(std::min(timeout, patience));
    buffers_.Collect(news.returned);
    if (news.filled) return TakeFrame(*news.filled);
    if (news.gone) return Lose(hal::CameraLoss::kDisconnected);
    if (IsSilent()) return Lose(hal::CameraLoss::kSilent);
    return std::nullopt;
}

bool LibcameraDriver::IsSilent() {
    // Without a buffer the camera has nothing to say anything with.
    if (buffers_.all_lent()) heard_at_ = Now();
    return Now() - heard_at_ > options_.silence_periods * period_;
}

void LibcameraDriver::Drain() {
    if (!running_) return;
    while (const auto filled = mailbox_.Take({}).filled) buffers_.NoteFilled(*filled);
    heard_at_ = Now();
}

LibcameraDriver::MaybeAnswer LibcameraDriver::TakeFrame(int slot) {
    buffers_.NoteFilled(slot);
    heard_at_ = Now();
    const libcamera::FrameMetadata& metadata = buffers_.buffer(slot).metadata();
    const auto maybe_planes = WholePlanes(slot);
    const bool damaged = !maybe_planes || metadata.status != libcamera::FrameMetadata::FrameSuccess;
    const auto header = accounting_.Accept(metadata.sequence, StampOf(slot), damaged);
    if (!header) return header.error();
    if (pool_ != nullptr) return Copy(*maybe_planes, header.value());
    accounting_.NoteDelivered();
    return buffers_.Lend(slot, {format_, header.value(), *maybe_planes});
}

LibcameraDriver::MaybeAnswer LibcameraDriver::Copy(const std::array<hal::Plane, 3>& planes,
                                                   const hal::FrameHeader& header) {
    const auto maybe_slot = pool_->Take();
    if (!maybe_slot) {
        accounting_.NoteLost();
        return std::nullopt;
    }
    FillPacked(layout_, planes, maybe_slot->bytes);
    accounting_.NoteDelivered();
    return pool_->Lease(*maybe_slot, header);
}

hal::Instant LibcameraDriver::StampOf(int slot) {
    const auto maybe_stamp =
        buffers_.request(slot).metadata().get(libcamera::controls::SensorTimestamp);
    const hal::Instant stamp(
        maybe_stamp ? *maybe_stamp
                    : static_cast<std::int64_t>(buffers_.buffer(slot).metadata().timestamp));
    return stamp.count() == 0 ? heard_at_ : stamp_clock_.ToMonotonic(stamp, BootClocks::Now());
}

std::optional<std::array<hal::Plane, 3>> LibcameraDriver::WholePlanes(int slot) {
    std::size_t bytes = 0;
    for (const auto& plane : buffers_.buffer(slot).metadata().planes()) bytes += plane.bytesused;
    if (bytes < LeastBytes(layout_)) return std::nullopt;
    return PlanesOf(layout_, buffers_.memory(slot));
}

Error LibcameraDriver::Lose(hal::CameraLoss why) {
    Log(options_, "lost: ", hal::ToString(why));
    loss_ = why;
    last_refusal_.clear();
    Disconnect();
    return Error::kDisconnected;
}

Result<Done> LibcameraDriver::DoReopen() {
    if (running_) return Done{};
    buffers_.Collect(mailbox_.Take({}).returned);
    const Outcome back = Connect();
    if (back) {
        accounting_.NoteReopened();
        Log(options_, "back", "");
        return Done{};
    }
    const Failure& failure = back.error();
    if (failure.words != last_refusal_) Log(options_, "not back: ", failure.words.c_str());
    last_refusal_ = failure.words;
    return failure.error;
}

hal::PoolLevel LibcameraDriver::DoPool() const {
    return pool_ != nullptr ? pool_->level() : buffers_.level();
}

}  // namespace hitchview::drivers

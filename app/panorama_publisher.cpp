#include "app/panorama_publisher.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "app/playback_speed.hpp"
#include "app/thread_schedule.hpp"

namespace hitchview::app {
namespace {

void CopyPacked(const hal::FrameView& picture, std::span<std::uint8_t> to) {
    std::memcpy(to.data(), picture.planes[0].data, to.size());
}

}  // namespace

PanoramaPublisher::PanoramaPublisher(hal::Publisher& publisher, const hal::Clock& clock,
                                     const SentBeside& beside, const hal::FrameFormat& format,
                                     const PanoramaPublisherOptions& options)
    : publisher_(publisher),
      clock_(clock),
      beside_(beside),
      options_(options),
      pool_(format, options.drop_when_late ? kBuffersInTime : int{kBuffers}),
      encoder_(format, options.jpeg),
      helpers_(std::min(options.threads, int{JpegEncoder::kSlices}), {}, "publish"),
      side_(publisher, options.side, counts_) {
    while (auto slot = pool_.Take()) free_.Append(*slot);
    thread_ = std::thread([this] { Work(); });
}

PanoramaPublisher::~PanoramaPublisher() {
    Finish();
}

void PanoramaPublisher::Finish() {
    filled_.Close();
    if (thread_.joinable()) thread_.join();
}

bool PanoramaPublisher::Append(const Item& item) {
    using std::chrono::milliseconds;
    auto slot = options_.drop_when_late ? free_.TakeFor(milliseconds(0)) : free_.Take();
    if (!slot) {
        dropped_.fetch_add(1, std::memory_order_relaxed);
        return false;
    }
    CopyPacked(item.picture, slot->bytes);
    Filled filled{*slot, item};
    filled.item.picture.planes = hal::PackedPlanes(item.picture.format, slot->bytes.data());
    filled_.Append(filled);
    return true;
}

hal::PoolLevel PanoramaPublisher::pool() const {
    const int slots = pool_.level().slots;
    return {slots, std::min(slots, free_.low_water())};
}

void PanoramaPublisher::Work() {
    NameThisThread("publish");
    constexpr std::chrono::milliseconds kBeat{10};
    while (!filled_.finished()) {
        if (auto filled = filled_.TakeFor(kBeat)) {
            Send(*filled);
            free_.Append(filled->slot);
        }
        SendHitchAngles();
        SendHealth();
        SendEvents();
        side_.SendPending();
    }
    // What came while the last one was sent.
    SendHitchAngles();
    SendEvents();
    if (beside_.watchdog != nullptr) beside_.watchdog->Stop();
}

void PanoramaPublisher::Send(Filled& filled) {
    const auto jpeg = Compress(filled.item.picture);
    if (!jpeg) {
        counts_.Count(jpeg.error());
        return;
    }
    const hal::PanoramaImage image = ImageOf(filled.item, jpeg.value());
    SendImage(filled.item, image);
    side_.SendViewports(filled.item.picture, image, helpers_);
}

void PanoramaPublisher::SendImage(const Item& item, const hal::PanoramaImage& image) {
    const StageTimer timer(times_.send);
    const auto outcome = publisher_.Publish(image);
    counts_.Count(outcome);
    if (outcome) Feed();
    SendStatus(item);
}

void PanoramaPublisher::Feed() {
    if (beside_.watchdog == nullptr) return;
    if (!std::exchange(ready_, true)) beside_.watchdog->Ready();
    beside_.watchdog->Feed();
}

hal::Result<std::span<const std::uint8_t>> PanoramaPublisher::Compress(
    const hal::FrameView& picture) {
    const StageTimer timer(times_.jpeg);
    const auto jpeg = encoder_.Encode(picture, helpers_);
    if (jpeg) newest_bytes_ = static_cast<int>(jpeg.value().size());
    newest_quality_ = encoder_.newest_quality();
    return jpeg;
}

hal::PanoramaImage PanoramaPublisher::ImageOf(const Item& item,
                                              std::span<const std::uint8_t> jpeg) const {
    const hal::FrameView& picture = item.picture;
    return {.sequence = picture.header.sequence,
            .captured_from = picture.header.captured_at,
            .captured_until = item.captured_until,
            .width_px = picture.format.width_px,
            .height_px = picture.format.height_px,
            .cameras_missing = item.status.cameras_missing,
            .calibration_id = options_.calibration_id,
            .jpeg = jpeg};
}

void PanoramaPublisher::SendStatus(const Item& item) {
    hal::PanoramaStatus status = item.status;
    status.published_at = clock_.Now();
    status.dropped += dropped();
    // A recording that is not paced was never captured at a moment of this clock.
    if (options_.drop_when_late)
        times_.latency.Add(status.published_at - item.picture.header.captured_at);
    counts_.Count(publisher_.Publish(status));
}

void PanoramaPublisher::SendHitchAngles() {
    if (beside_.telemetry == nullptr) return;
    while (auto angle = beside_.telemetry->Take()) {
        if (!options_.live_telemetry)
            angle->received_at = hal::Instant(start_ns_.load(std::memory_order_acquire)) +
                                 AtSpeed(angle->received_at, options_.speed);
        counts_.Count(publisher_.Publish(*angle));
    }
}

void PanoramaPublisher::SendEvents() {
    if (beside_.events == nullptr) return;
    while (const auto event = beside_.events->Take()) counts_.Count(publisher_.Publish(*event));
}

void PanoramaPublisher::SendHealth() {
    if (beside_.watch == nullptr) return;
    const hal::Instant now = clock_.Now();
    beside_.watch->Update(now, dropped());
    auto health = beside_.watch->MaybeHealth(now);
    if (!health) return;
    Complete(*health);
    counts_.Count(publisher_.Publish(*health));
    if (beside_.watchdog != nullptr) beside_.watchdog->Show(*health);
}

void PanoramaPublisher::Complete(hal::Health& health) const {
    health.image_bytes = newest_bytes_;
    health.image_budget_bytes = options_.jpeg.budget_bytes;
    health.image_quality = newest_quality_;
    health.stages.Add(StageHealthOf("jpeg", times_.jpeg));
    health.stages.Add(StageHealthOf("send", times_.send));
    health.stages.Add(StageHealthOf("latency", times_.latency));
}

}  // namespace hitchview::app

#include "app/record_intake.hpp"

#include <algorithm>
#include <array>

#include "drivers/lcm_record_messages.hpp"

namespace hitchview::app {

RecordIntake::RecordIntake(const RecordIntakeOptions& options, const hal::Clock& clock,
                           EventQueue& events)
    : options_(options), clock_(clock), events_(events), ring_(options.memory_bytes) {}

void RecordIntake::Start(hal::Instant origin) {
    origin_ns_ = origin.count();
    started_ = true;
}

std::int64_t RecordIntake::UtimeOf(hal::Instant at) const {
    return clock_.EpochMicroseconds(at + origin());
}

std::optional<RecordRing::Place> RecordIntake::Reserve(std::int64_t utime_us,
                                                       std::string_view channel,
                                                       std::size_t bytes) {
    if (!started_) return std::nullopt;
    PutClock(utime_us);
    auto place = ring_.Reserve(utime_us, channel, bytes);
    if (!place && started_) NoteDropped("messages are left out: the disk is too slow");
    return place;
}

void RecordIntake::Put(const drivers::LcmMessage& message) {
    PutBytes(message.utime_us, message.channel, message.bytes);
}

void RecordIntake::Put(const hal::CanFrame& frame, hal::Instant origin) {
    hal::CanFrame on_clock = frame;
    on_clock.received_at += origin;
    const std::int64_t utime_us = clock_.EpochMicroseconds(on_clock.received_at);
    std::array<std::uint8_t, drivers::kMostCanFrameBytes> bytes{};
    const std::size_t used = drivers::Encode(on_clock, utime_us, options_.can_bus.c_str(), bytes);
    PutBytes(utime_us, "CAN_RX", std::span(bytes).first(used));
}

void RecordIntake::PutBytes(std::int64_t utime_us, std::string_view channel,
                            std::span<const std::uint8_t> bytes) {
    const auto place = Reserve(utime_us, channel, bytes.size());
    if (!place) return;
    std::ranges::copy(bytes, place->data.begin());
    Commit(*place, bytes.size());
}

/// Of recordings and simulations the message's own time: they may run faster or slower than time.
void RecordIntake::PutClock(std::int64_t utime_us) {
    constexpr std::int64_t kPeriod_us = 1'000'000;
    std::int64_t next = next_clock_us_;
    // The wall clock may be set back.
    const bool due = utime_us >= next || utime_us < next - 2 * kPeriod_us;
    if (!due || !next_clock_us_.compare_exchange_strong(next, utime_us + kPeriod_us)) return;
    const hal::Instant now = clock_.Now();
    const std::int64_t now_us = clock_.EpochMicroseconds(now);
    const std::int64_t clock_us = options_.live ? now_us : utime_us;
    const hal::Instant ahead = std::chrono::microseconds(clock_us - now_us);
    std::array<std::uint8_t, drivers::kClockBytes> bytes{};
    const std::size_t used = drivers::EncodeClock(clock_us, now + ahead, bytes);
    const auto place = ring_.Reserve(clock_us, "CLOCK", used);
    if (!place) return;
    std::ranges::copy(bytes, place->data.begin());
    Commit(*place, used);
}

hal::Instant RecordIntake::Now() const {
    const hal::Instant now = clock_.Now();
    const std::int64_t newest_us = ring_.newest_utime_us();
    if (options_.live || newest_us == 0) return now;
    return now + std::chrono::microseconds(newest_us - clock_.EpochMicroseconds(now));
}

void RecordIntake::NoteDropped(std::string_view why) {
    ++dropped_;
    if (in_episode_.exchange(true)) return;
    events_.Put(
        {.code = hal::EventCode::kRecordingDropped, .when = Now(), .subject = {}, .text = why});
}

}  // namespace hitchview::app

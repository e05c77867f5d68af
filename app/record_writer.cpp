#include "app/record_writer.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

namespace hitchview::app {
namespace {

constexpr std::int64_t kMegabyte = 1'000'000;
/// Kept free beyond the floor before recording goes on, so that it does not stop at once again.
constexpr std::uint64_t kRoomToBegin = 4 * kMegabyte;

/// Not strerror(): that may take memory.
const char* Reason(int error) {
    const char* const text = strerrordesc_np(error);
    return text != nullptr ? text : "unknown error";
}

}  // namespace

RecordWriter::RecordWriter(RecordFolder folder, const drivers::RecordedRig& rig,
                           const Options& options, hal::Clock& clock)
    : folder_(std::move(folder)),
      rig_(rig),
      options_(options),
      clock_(clock),
      free_bytes_(folder_.FreeBytes()) {}

RecordWriter::Outcome RecordWriter::Append(const RecordedEvent& event) {
    if (log_.is_open() && IsDue(event.utime_us)) Close();
    if (!log_.is_open()) {
        if (const Outcome opened = OpenSegment(event.utime_us); !opened) return opened;
    }
    if (!Write(event.utime_us, event.channel, event.data)) return Fail();
    return hal::Done{};
}

/// The wall clock, and with it the times of events, may step.
std::int64_t RecordWriter::SegmentTime_us(std::int64_t utime_us) const {
    return options_.live ? clock_.Now().count() / 1000 : utime_us;
}

bool RecordWriter::IsDue(std::int64_t utime_us) const {
    const std::uint64_t limit = folder_.SegmentLimit();
    return SegmentTime_us(utime_us) - begun_us_ >= options_.segment.count() ||
           (limit > 0 && log_.bytes() >= limit);
}

RecordWriter::Outcome RecordWriter::OpenSegment(std::int64_t utime_us) {
    folder_.MakeRoom();
    if (const Outcome space = CheckSpace(); !space) return space;
    if (!log_.Open(folder_.NextSegment())) return Fail();
    begun_us_ = SegmentTime_us(utime_us);
    if (!Write(utime_us, "RIG", rig_.At(utime_us))) return Fail();
    ++files_;
    folder_.Sync();
    return hal::Done{};
}

hal::Result<hal::Done> RecordWriter::Write(std::int64_t utime_us, std::string_view channel,
                                           std::span<const std::uint8_t> data) {
    const std::uint64_t before = log_.bytes();
    const auto written = log_.Append(utime_us, channel, data);
    if (!written) return written;
    bytes_ += log_.bytes() - before;
    ++events_;
    return written;
}

RecordWriter::Outcome RecordWriter::Fail() {
    const int error = errno;
    Close();
    return hal::EventText("cannot be written: ").Append(Reason(error));
}

RecordWriter::Outcome RecordWriter::Beat() {
    constexpr hal::Instant kPeriod = std::chrono::seconds(1);
    const hal::Instant now = clock_.Now();
    if (!log_.is_open() || now < next_beat_) return hal::Done{};
    next_beat_ = now + kPeriod;
    if (!log_.Sync()) return Fail();
    const Outcome space = CheckSpace();
    if (!space) Close();
    return space;
}

RecordWriter::Outcome RecordWriter::CheckSpace() {
    const std::int64_t free = folder_.FreeBytes();
    free_bytes_ = free;
    if (folder_.HasSpace()) return hal::Done{};
    return hal::EventText("only ")
        .AppendNumber(free / kMegabyte)
        .Append(" MB free, must stay ")
        .AppendNumber(static_cast<std::int64_t>(folder_.min_free_bytes()) / kMegabyte)
        .Append(" MB");
}

bool RecordWriter::CanBegin() {
    folder_.MakeRoom();
    free_bytes_ = folder_.FreeBytes();
    return folder_.HasSpace(kRoomToBegin);
}

void RecordWriter::Close() {
    if (!log_.is_open()) return;
    const std::uint64_t bytes = log_.bytes();
    // What the disk refuses now, the next segment will tell of.
    [[maybe_unused]] const auto synced = log_.Sync();
    log_.Close();
    if (bytes == 0)
        folder_.RemoveNewest();
    else
        folder_.NoteSegment(bytes);
}

}  // namespace hitchview::app

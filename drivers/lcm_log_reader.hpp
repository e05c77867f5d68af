#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "drivers/lcm_log_format.hpp"
#include "drivers/lcm_log_window.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

struct LcmLogReaderOptions {
    std::int32_t max_data_bytes = 64 << 20;  ///< a message that claims more is damage. [1, 2^31)
};

/// What a reader had to leave out.
struct LcmLogDamage {
    std::uint64_t skipped_bytes = 0;  ///< in no event, in all places
    std::uint64_t places = 0;
    std::uint64_t torn_bytes = 0;   ///< of the skipped ones, those at the end of the file
    std::uint64_t lost_events = 0;  ///< at least so many, by the numbers of those around them
};

/// Events of an LCM log file in the order of the file; trusts nothing in it.
///
/// An event is taken for one if its header is sound (sync word, channel of 1 to 63 printable
/// characters, length within file and limit) and what stands where it ends shows it to end there:
/// the end of the file; what is left of a next header (its sync word, its number, or its time with
/// sound lengths); or damage behind which the numbers go on after a gap. Where the next number is
/// not there, no later event may lie inside. From damage it goes on at the next sync word that
/// begins an event. So no event is lost whose own bytes are whole, and none is made up; the format
/// has no checksum, so a changed byte of a message, its time or its number goes unnoticed.
///
/// liblcm's lcm_eventlog_read_next_event takes memory for any length that a header names, and stops
/// for good at the first header that it cannot read. Memory here: one megabyte, for a larger event
/// its size, and a length is believed only after what follows the event confirmed it.
/// Thread: one.
class LcmLogReader {
 public:
    /// The error names the file and says why.
    static hal::Checked<std::unique_ptr<LcmLogReader>> Open(
        const std::filesystem::path& file, const LcmLogReaderOptions& options = {});
    /// The same of a file's content, which is borrowed.
    explicit LcmLogReader(std::span<const std::uint8_t> log,
                          const LcmLogReaderOptions& options = {});

    /// Borrowed until the next call. kEndOfStream: no further event. kFailed: the system refused to
    /// read, or the file became shorter.
    hal::Result<LcmLogEvent> Next();

    /// The next event will be the first with a time of `utime_us` or later. Found by bisection: the
    /// times in the file may be out of order by up to a second. kEndOfStream: all are earlier.
    hal::Result<hal::Done> SeekToTime(std::int64_t utime_us);

    /// Since it was opened; what was sought over is not counted.
    [[nodiscard]] const LcmLogDamage& damage() const { return damage_; }
    [[nodiscard]] std::uint64_t size_bytes() const { return window_->size_bytes(); }
    /// Behind the event that was read last.
    [[nodiscard]] std::uint64_t position_bytes() const { return position_; }

 private:
    struct Place {
        std::uint64_t at;
        LcmLogHeader header;
    };
    enum class Evidence { kNone, kSome, kFull };

    LcmLogReader(std::unique_ptr<LcmLogWindow> window, const LcmLogReaderOptions& options)
        : window_(std::move(window)), options_(options) {}

    std::optional<Place> Find(std::uint64_t from);
    std::optional<LcmLogHeader> HeaderAt(std::uint64_t at);
    bool HasChannel(std::uint64_t at, std::int32_t channel_bytes);
    bool IsEvent(const Place& place);
    Evidence EvidenceOfEnd(const LcmLogHeader& header, std::uint64_t end);
    /// The first sound header that begins in [from, until).
    std::optional<Place> FindHeader(std::uint64_t from, std::uint64_t until);
    /// Whether the header behind event `number` was destroyed: the numbers go on after a gap, or
    /// there are zeros up to the end of the file, as a power cut leaves them.
    bool IsLossAt(std::uint64_t end, std::int64_t number);
    bool IsZeroFrom(std::uint64_t end);
    bool HoldsLaterEvent(const Place& place, std::uint64_t end);
    std::uint64_t StartBefore(std::int64_t utime_us);
    void CountSkipped(const std::optional<Place>& next);

    std::unique_ptr<LcmLogWindow> window_;
    LcmLogReaderOptions options_;
    std::uint64_t position_ = 0;
    std::optional<std::int64_t> last_number_;
    LcmLogDamage damage_;
};

}  // namespace hitchview::drivers

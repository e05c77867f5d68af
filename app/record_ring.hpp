#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace hitchview::app {

/// An event of a recording, borrowed from the ring.
struct RecordedEvent {
    std::int64_t utime_us = 0;  ///< since the epoch
    std::string_view channel{};
    std::span<const std::uint8_t> data{};
};

/// Encoded events from many threads to the one that writes them, in the order in which their places
/// were taken, in memory taken at construction. Locks are held for a few instructions only: events
/// are filled in outside. Takes no memory afterwards.
class RecordRing {
 public:
    enum class WhenFull {
        kRefuse,      ///< the new event
        kWait,        ///< until there is room
        kDropOldest,  ///< as many as it takes
    };

    explicit RecordRing(std::size_t bytes);
    RecordRing(const RecordRing&) = delete;
    RecordRing& operator=(const RecordRing&) = delete;

    /// Memory for an event that is not there yet: to be filled, then committed.
    struct Place {
        std::span<std::uint8_t> data{};
        std::size_t offset = 0;
    };
    /// Room for `bytes`. Empty: it is full, was closed, or the event is larger than half the ring.
    /// `channel`: at most 63 characters. Any thread.
    std::optional<Place> Reserve(std::int64_t utime_us, std::string_view channel,
                                 std::size_t bytes);
    /// The first `bytes` of the place are the event; 0: there is none after all. Any thread.
    void Commit(const Place& place, std::size_t bytes);

    void SetWhenFull(WhenFull mode);
    /// Nothing more is accepted, and nobody waits; what is in may be taken.
    void Close();

    /// The oldest event, until Pop. Empty: none came in time, or it is not committed yet. Thread:
    /// the consumer's, as the rest below.
    std::optional<RecordedEvent> Front(std::chrono::milliseconds timeout);
    void Pop();
    /// Throws away what is older than that, up to the first event that is not.
    void DropBefore(std::int64_t utime_us);
    /// Closed, and all was taken.
    [[nodiscard]] bool finished() const;
    /// Time of the event whose place was taken last; 0 before the first. Any thread.
    [[nodiscard]] std::int64_t newest_utime_us() const;
    /// Bytes in use, and of all. Any thread.
    [[nodiscard]] std::size_t used_bytes() const;
    [[nodiscard]] std::size_t capacity_bytes() const { return memory_.size(); }
    /// Most bytes that were ever in use. Any thread.
    [[nodiscard]] std::size_t most_used_bytes() const;

 private:
    struct Header;

    [[nodiscard]] Header& At(std::size_t offset);
    [[nodiscard]] bool MakeRoom(std::size_t bytes, std::unique_lock<std::mutex>& lock);
    [[nodiscard]] bool HasRoom(std::size_t bytes) const;
    bool DropFirst();
    void Advance();
    void SkipFillers();
    std::size_t Append(std::size_t bytes);

    std::vector<std::uint8_t> memory_;
    mutable std::mutex mutex_;
    std::condition_variable committed_;
    std::condition_variable freed_;
    WhenFull when_full_ = WhenFull::kRefuse;
    bool closed_ = false;
    bool reading_ = false;     // the consumer has the first event
    std::uint64_t begin_ = 0;  // of what is in use, counted on for ever; modulo the size: an offset
    std::uint64_t end_ = 0;
    std::size_t most_used_ = 0;
    std::int64_t newest_utime_us_ = 0;
};

}  // namespace hitchview::app

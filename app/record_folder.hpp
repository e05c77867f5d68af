#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace hitchview::app {

/// `yyyymmddThhmmssZ-NNNN.lcm`: what record names its files.
bool IsSegmentName(std::string_view name);

/// The folder of the recordings: names of new segments, room for them, and space left. Files that
/// are no segments are never touched. Thread: one. Takes no memory after Open.
class RecordFolder {
 public:
    struct Options {
        std::filesystem::path folder{};
        std::uint64_t quota_bytes = 0;     ///< of all segments in the folder; 0: none
        std::uint64_t min_free_bytes = 0;  ///< of the file system that recordings leave
    };
    /// Makes the folder. The error says why it cannot be written.
    static hal::Checked<RecordFolder> Open(const Options& options);

    /// A recording begins: its segments are named after this moment.
    void Begin(std::int64_t utime_us);
    /// Path of the next segment, which does not exist yet. Valid until the next call.
    const char* NextSegment();
    /// Name of the newest, in the folder.
    [[nodiscard]] std::string_view newest_name() const;
    /// The newest segment is complete.
    void NoteSegment(std::uint64_t bytes);
    /// The newest segment holds nothing: it goes.
    void RemoveNewest();

    /// Deletes the oldest segments until a new one of SegmentLimit fits the quota.
    void MakeRoom();
    /// Bytes at which a segment ends, so that the quota holds; 0: no limit.
    [[nodiscard]] std::uint64_t SegmentLimit() const { return options_.quota_bytes / kShares; }
    /// Of the file system; -1 if it does not say.
    [[nodiscard]] std::int64_t FreeBytes() const;
    [[nodiscard]] bool HasSpace(std::uint64_t more_bytes = 0) const;
    [[nodiscard]] std::uint64_t min_free_bytes() const { return options_.min_free_bytes; }
    /// The names of the segments are on the disk.
    void Sync() const;

 private:
    static constexpr std::uint64_t kShares = 4;
    using Name = std::array<char, 32>;
    struct Segment {
        Name name{};
        std::uint64_t bytes = 0;
    };

    explicit RecordFolder(const Options& options) : options_(options) {}
    void Adopt();
    const char* PathOf(const Name& name);
    void RemoveOldest();

    Options options_;
    std::vector<Segment> segments_;  ///< oldest first, from first_ on; only with a quota
    std::size_t first_ = 0;
    std::uint64_t total_bytes_ = 0;
    std::array<char, 20> stamp_{};
    int number_ = 0;
    std::int64_t begun_us_ = 0;
    Name newest_{};
    std::array<char, 4096> path_{};
};

}  // namespace hitchview::app

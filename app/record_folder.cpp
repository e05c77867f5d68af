#include "app/record_folder.hpp"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>

namespace hitchview::app {
namespace {

constexpr std::size_t kMostSegments = 20'000;
constexpr int kLastNumber = 9999;  // so that the order of names is that of time

bool IsDigits(std::string_view text) {
    return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

bool IsSegmentName(std::string_view name) {
    constexpr std::string_view kPattern = "########T######Z-####.lcm";
    if (name.size() != kPattern.size()) return false;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool fits = kPattern[i] == '#' ? IsDigits(name.substr(i, 1)) : name[i] == kPattern[i];
        if (!fits) return false;
    }
    return true;
}

hal::Checked<RecordFolder> RecordFolder::Open(const Options& options) {
    const std::string name = options.folder.string();
    std::error_code refused;
    std::filesystem::create_directories(options.folder, refused);
    if (refused) return name + ": cannot be made: " + refused.message();
    if (access(name.c_str(), W_OK | X_OK) != 0)
        return name + ": cannot be written: " + std::strerror(errno);
    if (name.size() + sizeof(Name) >= sizeof path_) return name + ": the path is too long";
    RecordFolder folder(options);
    if (options.quota_bytes > 0) folder.Adopt();
    return folder;
}

/// Segments of earlier recordings count, and are the first to go.
void RecordFolder::Adopt() {
    segments_.reserve(kMostSegments);
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(options_.folder, ignored)) {
        const std::string name = entry.path().filename().string();
        const bool regular =
            entry.symlink_status(ignored).type() == std::filesystem::file_type::regular;
        if (!regular || !IsSegmentName(name) || segments_.size() == kMostSegments) continue;
        Segment& segment = segments_.emplace_back();
        std::ranges::copy(name, segment.name.begin());
        segment.bytes = entry.file_size(ignored);
        total_bytes_ += segment.bytes;
    }
    std::ranges::sort(segments_, {}, &Segment::name);
}

void RecordFolder::Begin(std::int64_t utime_us) {
    using std::chrono::floor;
    begun_us_ = utime_us;
    number_ = 0;
    const std::chrono::sys_time<std::chrono::microseconds> at{std::chrono::microseconds(utime_us)};
    const auto day = floor<std::chrono::days>(at);
    const std::chrono::year_month_day date{day};
    const std::chrono::hh_mm_ss time{floor<std::chrono::seconds>(at - day)};
    std::snprintf(stamp_.data(), stamp_.size(), "%04d%02u%02uT%02d%02d%02dZ",
                  static_cast<int>(date.year()) % 10'000, static_cast<unsigned>(date.month()),
                  static_cast<unsigned>(date.day()), static_cast<int>(time.hours().count()),
                  static_cast<int>(time.minutes().count()),
                  static_cast<int>(time.seconds().count()));
}

const char* RecordFolder::NextSegment() {
    constexpr std::int64_t kSecond_us = 1'000'000;
    const char* path = nullptr;
    do {
        if (++number_ > kLastNumber) {
            Begin(begun_us_ + kSecond_us);
            number_ = 1;
        }
        std::snprintf(newest_.data(), newest_.size(), "%s-%04d.lcm", stamp_.data(),
                      number_ % (kLastNumber + 1));
        path = PathOf(newest_);
    } while (access(path, F_OK) == 0);
    return path;
}

std::string_view RecordFolder::newest_name() const {
    return newest_.data();
}

const char* RecordFolder::PathOf(const Name& name) {
    std::snprintf(path_.data(), path_.size(), "%s/%s", options_.folder.c_str(), name.data());
    return path_.data();
}

void RecordFolder::NoteSegment(std::uint64_t bytes) {
    if (options_.quota_bytes == 0) return;
    if (segments_.size() == kMostSegments) {
        if (first_ == 0) RemoveOldest();
        segments_.erase(segments_.begin(), segments_.begin() + static_cast<std::ptrdiff_t>(first_));
        first_ = 0;
    }
    segments_.push_back({newest_, bytes});
    total_bytes_ += bytes;
}

void RecordFolder::RemoveNewest() {
    unlink(PathOf(newest_));
}

void RecordFolder::MakeRoom() {
    if (options_.quota_bytes == 0) return;
    while (first_ < segments_.size() && total_bytes_ > options_.quota_bytes - SegmentLimit())
        RemoveOldest();
}

/// One that somebody else has removed is gone as well.
void RecordFolder::RemoveOldest() {
    const Segment& oldest = segments_[first_++];
    unlink(PathOf(oldest.name));
    total_bytes_ -= std::min(total_bytes_, oldest.bytes);
}

std::int64_t RecordFolder::FreeBytes() const {
    struct statvfs system {};
    if (statvfs(options_.folder.c_str(), &system) != 0) return -1;
    return static_cast<std::int64_t>(system.f_bavail) * static_cast<std::int64_t>(system.f_frsize);
}

bool RecordFolder::HasSpace(std::uint64_t more_bytes) const {
    const std::int64_t free = FreeBytes();
    return free >= 0 && static_cast<std::uint64_t>(free) >= options_.min_free_bytes + more_bytes;
}

void RecordFolder::Sync() const {
    const int folder = open(options_.folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    fsync(folder);
    close(folder);
}

}  // namespace hitchview::app

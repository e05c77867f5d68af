#include "app/log_recording.hpp"

#include <algorithm>

namespace hitchview::app {
namespace {

namespace fs = std::filesystem;
using drivers::LcmLogDamage;

std::vector<fs::path> LogsIn(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code failed;
    for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed))
        if (it->path().extension() == ".lcm") files.push_back(it->path());
    std::ranges::sort(files);
    return files;
}

LcmLogDamage Sum(const LcmLogDamage& a, const LcmLogDamage& b) {
    return {.skipped_bytes = a.skipped_bytes + b.skipped_bytes,
            .places = a.places + b.places,
            .torn_bytes = a.torn_bytes + b.torn_bytes,
            .lost_events = a.lost_events + b.lost_events};
}

}  // namespace

hal::Checked<std::vector<fs::path>> LogFiles(const std::vector<fs::path>& logs) {
    std::vector<fs::path> files;
    std::error_code failed;
    for (const fs::path& log : logs) {
        if (!fs::is_directory(log, failed)) {
            if (!fs::exists(log, failed)) return log.string() + ": no such file or folder";
            files.push_back(log);
            continue;
        }
        const std::vector<fs::path> found = LogsIn(log);
        if (found.empty()) return log.string() + ": holds no *.lcm";
        files.insert(files.end(), found.begin(), found.end());
    }
    return files;
}

LogRecording::LogRecording(std::vector<fs::path> files, const std::atomic<bool>& stop)
    : files_(std::move(files)), stop_(stop) {
    std::error_code failed;
    for (const fs::path& file : files_) {
        const std::uintmax_t bytes = fs::file_size(file, failed);
        if (!failed) size_bytes_ += bytes;
    }
}

hal::Result<drivers::LcmLogEvent> LogRecording::Next() {
    while (!stop_ && (reader_ != nullptr || OpenNext())) {
        auto event = reader_->Next();
        if (event) return event;
        if (event.error() != hal::Error::kEndOfStream) {
            failure_ = files_[next_file_ - 1].string() + ": cannot be read to its end";
            return event.error();
        }
        CloseSegment();
    }
    if (stop_) failure_ = "stopped";
    return failure_.empty() ? hal::Error::kEndOfStream : hal::Error::kFailed;
}

void LogRecording::Rewind() {
    reader_.reset();
    next_file_ = 0;
    closed_bytes_ = 0;
    closed_damage_ = {};
    failure_.clear();
}

void LogRecording::SeekToTime(std::int64_t utime_us) {
    Rewind();
    while (OpenNext() && !reader_->SeekToTime(utime_us).ok()) CloseSegment();
}

LcmLogDamage LogRecording::damage() const {
    return reader_ == nullptr ? closed_damage_ : Sum(closed_damage_, reader_->damage());
}

std::uint64_t LogRecording::position_bytes() const {
    return closed_bytes_ + (reader_ == nullptr ? 0 : reader_->position_bytes());
}

bool LogRecording::OpenNext() {
    if (next_file_ == files_.size()) return false;
    auto reader = drivers::LcmLogReader::Open(files_[next_file_]);
    if (reader) {
        reader_ = std::move(*reader);
        ++next_file_;
    } else {
        failure_ = reader.error();
    }
    return reader_ != nullptr;
}

void LogRecording::CloseSegment() {
    closed_damage_ = damage();
    closed_bytes_ = position_bytes();
    reader_.reset();
}

}  // namespace hitchview::app

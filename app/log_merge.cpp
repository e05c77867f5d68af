#include "app/log_merge.hpp"

namespace hitchview::app {

LogMerge::LogMerge(const std::vector<std::vector<std::filesystem::path>>& recordings,
                   const std::atomic<bool>& stop) {
    for (const auto& files : recordings)
        sources_.push_back({std::make_unique<LogRecording>(files, stop)});
}

void LogMerge::SeekToTime(std::int64_t utime_us) {
    for (Source& source : sources_) {
        source.recording->SeekToTime(utime_us);
        source.head = hal::Error::kTimeout;
    }
}

hal::Result<LogMerge::Event> LogMerge::Next() {
    Source* first = nullptr;
    for (Source& source : sources_) {
        if (!source.head && source.head.error() == hal::Error::kTimeout)
            source.head = source.recording->Next();
        if (!source.head && source.head.error() != hal::Error::kEndOfStream) {
            failure_ = source.recording->failure();
            return source.head.error();
        }
        if (!source.head) continue;
        if (first == nullptr || source.head.value().utime_us < first->head.value().utime_us)
            first = &source;
    }
    if (first == nullptr) return hal::Error::kEndOfStream;
    const Event event{.recording = static_cast<std::size_t>(first - sources_.data()),
                      .file = first->recording->file(),
                      .event = first->head.value()};
    first->head = hal::Error::kTimeout;
    return event;
}

}  // namespace hitchview::app

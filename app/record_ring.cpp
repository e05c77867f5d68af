#include "app/record_ring.hpp"

#include <algorithm>
#include <array>
#include <new>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

/// Every event starts at a multiple: what is left at the end always has room for a header.
constexpr std::size_t kAlignment = 128;
constexpr std::size_t kLongestChannel = 63;

std::size_t RoundUp(std::size_t bytes) {
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

}  // namespace

/// Stands before each event and before what is left free at the end of the memory.
struct RecordRing::Header {
    enum class State : std::uint8_t { kReserved, kCommitted, kFiller };

    std::uint64_t bytes = 0;  ///< with the header and up to the next one
    std::int64_t utime_us = 0;
    std::uint64_t data_bytes = 0;
    State state = State::kReserved;
    std::uint8_t channel_bytes = 0;
    std::array<char, kLongestChannel> channel{};

    [[nodiscard]] std::uint8_t* data() { return reinterpret_cast<std::uint8_t*>(this + 1); }
};

RecordRing::RecordRing(std::size_t bytes) : memory_(RoundUp(bytes)) {
    static_assert(sizeof(Header) <= kAlignment);
    HV_EXPECT(memory_.size() >= 8 * kAlignment);
}

RecordRing::Header& RecordRing::At(std::size_t offset) {
    return *reinterpret_cast<Header*>(memory_.data() + offset);
}

std::optional<RecordRing::Place> RecordRing::Reserve(std::int64_t utime_us,
                                                     std::string_view channel, std::size_t bytes) {
    HV_EXPECT(channel.size() <= kLongestChannel);
    const std::size_t all = RoundUp(sizeof(Header) + bytes);
    std::unique_lock lock(mutex_);
    if (all > memory_.size() / 2 || !MakeRoom(all, lock)) return std::nullopt;
    const std::size_t offset = Append(all);
    Header& header = *new (memory_.data() + offset) Header;
    header.bytes = all;
    header.utime_us = utime_us;
    header.data_bytes = bytes;
    header.channel_bytes = static_cast<std::uint8_t>(channel.size());
    std::ranges::copy(channel, header.channel.begin());
    newest_utime_us_ = utime_us;
    most_used_ = std::max(most_used_, static_cast<std::size_t>(end_ - begin_));
    return Place{.data = {header.data(), bytes}, .offset = offset};
}

/// Where the next `bytes` are, in one piece; what is left at the end of the memory is passed over.
std::size_t RecordRing::Append(std::size_t bytes) {
    std::size_t offset = end_ % memory_.size();
    const std::size_t left = memory_.size() - offset;
    if (left < bytes) {
        Header& filler = *new (memory_.data() + offset) Header;
        filler.bytes = left;
        filler.state = Header::State::kFiller;
        end_ += left;
        offset = 0;
    }
    end_ += bytes;
    return offset;
}

bool RecordRing::HasRoom(std::size_t bytes) const {
    const std::size_t left = memory_.size() - end_ % memory_.size();
    const std::size_t needed = left < bytes ? left + bytes : bytes;
    return end_ - begin_ + needed <= memory_.size();
}

bool RecordRing::MakeRoom(std::size_t bytes, std::unique_lock<std::mutex>& lock) {
    while (!closed_ && !HasRoom(bytes)) {
        if (when_full_ == WhenFull::kRefuse) return false;
        if (when_full_ == WhenFull::kWait) {
            freed_.wait(lock);
        } else if (!DropFirst()) {
            return false;
        }
    }
    return !closed_;
}

void RecordRing::Commit(const Place& place, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    Header& header = At(place.offset);
    HV_EXPECT(bytes <= header.data_bytes && header.state == Header::State::kReserved);
    header.data_bytes = bytes;
    header.state = bytes == 0 ? Header::State::kFiller : Header::State::kCommitted;
    committed_.notify_one();
}

void RecordRing::SetWhenFull(WhenFull mode) {
    const std::lock_guard lock(mutex_);
    when_full_ = mode;
    freed_.notify_all();
}

void RecordRing::Close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    freed_.notify_all();
    committed_.notify_all();
}

std::optional<RecordedEvent> RecordRing::Front(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    const auto is_there = [this] {
        SkipFillers();
        return begin_ != end_ && At(begin_ % memory_.size()).state == Header::State::kCommitted;
    };
    committed_.wait_for(lock, timeout, [&] { return is_there() || (closed_ && begin_ == end_); });
    if (!is_there()) return std::nullopt;
    reading_ = true;
    Header& header = At(begin_ % memory_.size());
    return RecordedEvent{.utime_us = header.utime_us,
                         .channel = {header.channel.data(), header.channel_bytes},
                         .data = {header.data(), header.data_bytes}};
}

void RecordRing::Pop() {
    const std::lock_guard lock(mutex_);
    HV_EXPECT(reading_);
    reading_ = false;
    Advance();
}

void RecordRing::DropBefore(std::int64_t utime_us) {
    const std::lock_guard lock(mutex_);
    SkipFillers();
    while (begin_ != end_ && At(begin_ % memory_.size()).utime_us < utime_us && DropFirst())
        SkipFillers();
}

/// False where the first event is being filled in or written.
bool RecordRing::DropFirst() {
    SkipFillers();
    if (reading_ || begin_ == end_) return false;
    if (At(begin_ % memory_.size()).state == Header::State::kReserved) return false;
    Advance();
    return true;
}

void RecordRing::Advance() {
    begin_ += At(begin_ % memory_.size()).bytes;
    freed_.notify_all();
}

void RecordRing::SkipFillers() {
    while (begin_ != end_ && At(begin_ % memory_.size()).state == Header::State::kFiller) Advance();
}

bool RecordRing::finished() const {
    const std::lock_guard lock(mutex_);
    return closed_ && begin_ == end_;
}

std::int64_t RecordRing::newest_utime_us() const {
    const std::lock_guard lock(mutex_);
    return newest_utime_us_;
}

std::size_t RecordRing::used_bytes() const {
    const std::lock_guard lock(mutex_);
    return end_ - begin_;
}

std::size_t RecordRing::most_used_bytes() const {
    const std::lock_guard lock(mutex_);
    return most_used_;
}

}  // namespace hitchview::app

#pragma once

#include <cstdint>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "drivers/lcm_log_format.hpp"

namespace hitchview::tests {

using LogBytes = std::vector<std::uint8_t>;

/// An event with memory of its own.
struct OwnedEvent {
    std::int64_t utime_us = 0;
    std::string channel;
    LogBytes data;
    std::uint64_t position_bytes = 0;

    explicit OwnedEvent(const drivers::LcmLogEvent& event)
        : utime_us(event.utime_us),
          channel(event.channel),
          data(event.data.begin(), event.data.end()),
          position_bytes(event.position_bytes) {}
    OwnedEvent(std::int64_t at_us, std::string on, LogBytes what)
        : utime_us(at_us), channel(std::move(on)), data(std::move(what)) {}

    [[nodiscard]] std::uint64_t EndBytes() const {
        return position_bytes + drivers::kLcmLogHeaderBytes + channel.size() + data.size();
    }
    bool operator==(const OwnedEvent&) const = default;
};

/// A log and what is in it: messages of 0 to a few thousand bytes, some of the same size, some with
/// sync words in them, a few milliseconds apart.
struct RandomLog {
    std::vector<OwnedEvent> events;
    LogBytes bytes;

    RandomLog(unsigned seed, int count) : random_(seed) {
        std::int64_t utime_us = 1'700'000'000'000'000;
        for (int i = 0; i < count; ++i) {
            utime_us += Up(20'000);
            Append(utime_us, "CAM_" + std::to_string(Up(7)), Data());
        }
    }

    void Append(std::int64_t utime_us, const std::string& channel, const LogBytes& data) {
        const drivers::LcmLogHeader header{static_cast<std::int64_t>(events.size()), utime_us,
                                           static_cast<std::int32_t>(channel.size()),
                                           static_cast<std::int32_t>(data.size())};
        events.emplace_back(utime_us, channel, data);
        events.back().position_bytes = bytes.size();
        std::ranges::copy(drivers::EncodeLcmLogHeader(header), std::back_inserter(bytes));
        std::ranges::copy(channel, std::back_inserter(bytes));
        std::ranges::copy(data, std::back_inserter(bytes));
    }

    int Up(int largest) { return std::uniform_int_distribution<int>(0, largest)(random_); }

 private:
    LogBytes Data() {
        // So that a damaged length may end at a later event by chance: 28 + 5 + 223 bytes are 256.
        LogBytes data(Up(2) == 0 ? 223U : static_cast<std::size_t>(Up(3000)));
        for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(Up(255));
        if (Up(3) == 0 && data.size() > 8)
            std::ranges::copy(drivers::kLcmLogSync, data.begin() + Up(4));
        return data;
    }

    std::mt19937 random_;
};

inline void WriteBytes(const std::string& file, std::span<const std::uint8_t> bytes) {
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

}  // namespace hitchview::tests

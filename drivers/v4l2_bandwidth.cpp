#include "drivers/v4l2_bandwidth.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <vector>

namespace hitchview::drivers {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds up whole words, so that nothing is left out and nothing but reading takes time.
std::uint64_t Sum(std::span<const std::uint8_t> memory) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i + sizeof sum <= memory.size(); i += sizeof sum) {
        std::uint64_t word = 0;
        std::memcpy(&word, memory.data() + i, sizeof word);
        sum += word;
    }
    return sum;
}

double SecondsToRead(std::span<const std::uint8_t> memory) {
    const Clock::time_point start = Clock::now();
    volatile std::uint64_t sum = Sum(memory);
    static_cast<void>(sum);
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

double ReadBandwidth(std::span<const std::uint8_t> memory) {
    if (memory.empty()) return 0;
    const double seconds = std::min(SecondsToRead(memory), SecondsToRead(memory));
    return static_cast<double>(memory.size()) / std::max(seconds, 1e-9) / 1e9;
}

double OrdinaryReadBandwidth(std::size_t bytes) {
    const std::vector<std::uint8_t> memory(bytes, 1);
    return ReadBandwidth(memory);
}

}  // namespace hitchview::drivers

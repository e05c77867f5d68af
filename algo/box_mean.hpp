#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hitchview::algo {

/// Means of boxes of samples, a row of boxes at a time. Memory is taken at construction; not
/// thread-safe.
class BoxMean {
 public:
    /// Samples of a channel in a box: 1, 2, 4 or 8 each way. Channels, 1 or 2, lie between each
    /// other.
    struct Box {
        int across;
        int down;
        int channels = 1;
    };
    /// The topmost rows of samples.
    struct Rows {
        const std::uint8_t* first;
        std::ptrdiff_t stride_bytes;
        int step_bytes;  ///< 1: samples lie beside each other; 2: at every second byte
    };

    /// No row has more samples, all channels counted.
    explicit BoxMean(int max_samples)
        : sums_(static_cast<std::size_t>(max_samples)), pairs_(sums_.size()) {}

    /// Rounded means of `count` boxes beside each other, channels between each other.
    void Take(const Rows& rows, const Box& box, int count, std::uint8_t* means);

 private:
    std::vector<std::uint16_t> sums_;  // of columns
    std::vector<std::uint16_t> pairs_;
};

}  // namespace hitchview::algo

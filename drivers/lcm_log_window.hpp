#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace hitchview::drivers {

/// A file of which a piece is in memory: reading along it costs one call of the system for each
/// megabyte, and what was read is lent without a copy. Or bytes that are all in memory. Thread:
/// one.
class LcmLogWindow {
 public:
    static constexpr std::size_t kBytes = std::size_t{1} << 20;

    /// The error names the file and says why.
    static hal::Checked<std::unique_ptr<LcmLogWindow>> Open(const std::string& file);
    /// Borrows the bytes. Takes no memory for them.
    explicit LcmLogWindow(std::span<const std::uint8_t> bytes);
    ~LcmLogWindow();
    LcmLogWindow(const LcmLogWindow&) = delete;
    LcmLogWindow& operator=(const LcmLogWindow&) = delete;

    /// When it was opened.
    [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
    /// Whether the system ever refused to read.
    [[nodiscard]] bool failed() const { return failed_; }

    /// The `count` bytes at `offset`, valid until the next call; empty if the file ends before them
    /// or cannot be read. Takes memory only for a count above kBytes.
    std::span<const std::uint8_t> Lend(std::uint64_t offset, std::size_t count);

    /// Copies the bytes at `offset` and leaves the piece in memory where it is: a look ahead.
    bool Copy(std::uint64_t offset, std::span<std::uint8_t> bytes);

    /// Where `pattern` (up to 64 bytes) begins first in [from, until).
    std::optional<std::uint64_t> Find(std::span<const std::uint8_t> pattern, std::uint64_t from,
                                      std::uint64_t until);

 private:
    LcmLogWindow(int descriptor, std::uint64_t size_bytes);
    [[nodiscard]] bool Holds(std::uint64_t offset, std::size_t count) const;
    [[nodiscard]] std::span<const std::uint8_t> Held(std::uint64_t offset, std::size_t count) const;
    bool Read(std::uint64_t offset, std::span<std::uint8_t> bytes);

    int descriptor_;  ///< -1: all bytes are held
    std::uint64_t size_bytes_;
    std::vector<std::uint8_t> memory_{};
    std::uint64_t start_ = 0;               ///< of the piece that is held
    std::span<const std::uint8_t> held_{};  ///< the piece
    bool failed_ = false;
};

}  // namespace hitchview::drivers

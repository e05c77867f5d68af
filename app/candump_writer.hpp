#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>

#include "hal/can_bus.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// One line of a log as `candump -L` of can-utils writes it, byte for byte, with its newline:
/// `(seconds.micros) interface id#data`; FD frames have `##` and one digit of flags, remote frames
/// `#R` and the size if it is not 0, error frames 8 digits with 20000000 set. Thread: any, one per
/// object. Takes no memory after construction.
class CandumpLine {
 public:
    /// `interface`: 1 to 15 characters.
    explicit CandumpLine(std::string_view interface);

    /// The time is `frame.epoch` (known); nanoseconds are cut off, as candump does. The text is
    /// valid until the next call.
    std::string_view Format(const hal::CanFrame& frame);

 private:
    // Time, interface, id, flags, 64 bytes in hex.
    static constexpr std::size_t kLongest = 256;

    void Append(std::string_view text);
    void AppendHex(std::uint64_t number, int digits);
    void AppendDecimal(std::int64_t number, int digits);
    void AppendTime(std::chrono::nanoseconds epoch);
    void AppendId(const hal::CanFrame& frame);
    void AppendData(const hal::CanFrame& frame);

    std::string interface_;
    std::array<char, kLongest> text_{};
    std::size_t length_ = 0;
};

/// Writes such a log to a file; `canplayer`, `log2asc`, SavvyCAN and CandumpCanBus read it.
class CandumpWriter {
 public:
    /// Replaces the file. The error names it and says why.
    static hal::Checked<std::unique_ptr<CandumpWriter>> Open(const std::filesystem::path& file,
                                                             std::string_view interface);

    void Append(const hal::CanFrame& frame);
    /// Once, after the last frame: whether all of it is in the file.
    hal::Checked<hal::Done> Finish();

 private:
    CandumpWriter(const std::filesystem::path& file, std::string_view interface)
        : file_(file.string()), out_(file, std::ios::binary), line_(interface) {}

    std::string file_;
    std::ofstream out_;
    CandumpLine line_;
};

}  // namespace hitchview::app

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

/// Descriptions of CAN messages (DBC files), as far as it takes to decode a signal.
namespace hitchview::app {

/// What a raw value of a signal means (VAL_).
struct DbcValueText {
    std::int64_t raw = 0;
    std::string text;
};

/// A signal as the file says, not yet checked for making sense: value = factor * raw + offset.
struct DbcSignal {
    std::string name;
    int line = 0;  ///< in the file
    int start_bit = 0;
    int length_bits = 0;
    bool motorola = false;
    bool is_signed = false;
    double factor = 1;
    double offset = 0;
    double min = 0;  ///< min = max: the file does not tell the range
    double max = 0;
    std::string unit;
    bool is_multiplexor = false;                 ///< M
    std::optional<std::int64_t> multiplexed_by;  ///< m<k>: only in frames whose multiplexor is k
    bool extended_multiplexing = false;          ///< SG_MUL_VAL_ says more than m<k>
    bool is_float = false;                       ///< SIG_VALTYPE_: IEEE 754
    std::vector<DbcValueText> texts;
};

struct DbcMessage {
    std::uint32_t id = 0;  ///< 11 or 29 bits
    bool extended = false;
    std::string name;
    int size_bytes = 0;
    std::vector<DbcSignal> signals;
    std::optional<std::chrono::milliseconds> cycle_time;  ///< GenMsgCycleTime; more than 0

    [[nodiscard]] const DbcSignal* FindMultiplexor() const;
};

struct DbcFile {
    static constexpr std::size_t kMaxBytes = std::size_t{16} << 20;
    static constexpr std::size_t kMaxMessages = 20'000;
    static constexpr std::size_t kMaxSignals = 200'000;
    static constexpr std::size_t kMaxTexts = 500'000;

    std::vector<DbcMessage> messages;  ///< in the order of the file; names and ids are unique
};

/// Understands BO_, SG_, VAL_, SIG_VALTYPE_, SG_MUL_VAL_ and the attribute GenMsgCycleTime (BA_,
/// BA_DEF_DEF_). Of the rest it skips: statements whose keyword ends with an underscore up to their
/// semicolon, all other lines whole. What is said of messages and signals that are not there is
/// skipped too, and so is the message of signals without a message (id 3221225472).
///
/// The error reads `file:line: what is wrong`. `file` is for that only. Any bytes will do.
hal::Checked<DbcFile> ParseDbc(std::string_view text, const std::string& file);

/// At most DbcFile::kMaxBytes.
hal::Checked<DbcFile> LoadDbc(const std::filesystem::path& file);

}  // namespace hitchview::app

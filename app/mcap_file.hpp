#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/mcap_bytes.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// A file in the format MCAP (mcap.dev/spec), version 0: chunks of messages without compression,
/// an index of each chunk, and a summary, so that a player may jump. Check sums are left at 0,
/// which the format reads as not given. Thread: one.
class McapFile {
 public:
    using Id = std::uint16_t;

    /// Replaces the file. The error names it and says why.
    static hal::Checked<std::unique_ptr<McapFile>> Create(const std::string& file);

    /// At most 65,535 of each.
    Id AddSchema(std::string_view name, std::string_view encoding,
                 std::span<const std::uint8_t> definition);
    Id AddChannel(Id schema, std::string_view topic, std::string_view message_encoding);

    /// `log_time_ns`: since the epoch. kFailed: the system refused; errno says why.
    hal::Result<hal::Done> Append(Id channel, std::uint32_t sequence, std::uint64_t log_time_ns,
                                  std::span<const std::uint8_t> message);
    /// Writes the last chunk and the summary. Nothing may follow.
    hal::Result<hal::Done> Finish();

 private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    struct TimeSpan {
        std::uint64_t first_ns = 0;
        std::uint64_t last_ns = 0;
        bool any = false;

        void Add(std::uint64_t time_ns);
    };

    explicit McapFile(std::FILE* file) : file_(file) {}
    bool Write(std::span<const std::uint8_t> bytes);
    bool EndChunk();
    bool WriteIndexes(std::uint64_t chunk_start, std::uint64_t chunk_bytes);
    [[nodiscard]] McapBytes Statistics() const;
    [[nodiscard]] McapBytes Summary(std::uint64_t start) const;

    std::unique_ptr<std::FILE, Close> file_;
    std::uint64_t position_ = 0;  ///< bytes written
    std::uint16_t schemas_ = 0;
    std::uint16_t channels_ = 0;
    std::uint32_t chunks_ = 0;
    std::uint64_t messages_ = 0;
    TimeSpan time_;
    McapBytes schema_records_;  ///< all, for the summary
    McapBytes channel_records_;
    McapBytes chunk_indexes_;
    std::map<Id, std::uint64_t> messages_of_;  ///< of each channel

    McapBytes chunk_;  ///< records of the open chunk
    TimeSpan chunk_time_;
    std::map<Id, McapBytes> index_of_;  ///< its messages: time and place, by channel
};

}  // namespace hitchview::app

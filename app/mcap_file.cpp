#include "app/mcap_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace hitchview::app {
namespace {

using hal::Done;
using hal::Error;
using hal::Result;

constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::size_t kChunkBytes = std::size_t{4} << 20;
constexpr std::uint32_t kNoChecksum = 0;

enum Opcode : std::uint8_t {
    kHeader = 0x01,
    kFooter = 0x02,
    kSchema = 0x03,
    kChannel = 0x04,
    kMessage = 0x05,
    kChunk = 0x06,
    kMessageIndex = 0x07,
    kChunkIndex = 0x08,
    kStatistics = 0x0B,
    kSummaryOffset = 0x0E,
    kDataEnd = 0x0F,
};

}  // namespace

hal::Checked<std::unique_ptr<McapFile>> McapFile::Create(const std::string& file) {
    std::FILE* const opened = std::fopen(file.c_str(), "wb");
    if (opened == nullptr) return file + ": cannot be written: " + std::strerror(errno);
    std::unique_ptr<McapFile> mcap(new McapFile(opened));
    McapBytes start;
    start.Raw(kMagic).Record(kHeader, McapBytes().Text("").Text("hitchview"));
    if (!mcap->Write(start.bytes())) return file + ": cannot be written: " + std::strerror(errno);
    return mcap;
}

McapFile::Id McapFile::AddSchema(std::string_view name, std::string_view encoding,
                                 std::span<const std::uint8_t> definition) {
    HV_EXPECT(schemas_ < 0xFFFF);
    ++schemas_;  // 0 means none
    McapBytes content;
    content.U16(schemas_).Text(name).Text(encoding).Sized(definition);
    schema_records_.Record(kSchema, content);
    chunk_.Record(kSchema, content);
    return schemas_;
}

McapFile::Id McapFile::AddChannel(Id schema, std::string_view topic,
                                  std::string_view message_encoding) {
    HV_EXPECT(channels_ < 0xFFFF);
    ++channels_;
    McapBytes content;
    content.U16(channels_).U16(schema).Text(topic).Text(message_encoding).Sized({});
    channel_records_.Record(kChannel, content);
    chunk_.Record(kChannel, content);
    return channels_;
}

Result<Done> McapFile::Append(Id channel, std::uint32_t sequence, std::uint64_t log_time_ns,
                              std::span<const std::uint8_t> message) {
    index_of_[channel].U64(log_time_ns).U64(chunk_.size());
    McapBytes content;
    content.U16(channel).U32(sequence).U64(log_time_ns).U64(log_time_ns).Raw(message);
    chunk_.Record(kMessage, content);
    chunk_time_.Add(log_time_ns);
    time_.Add(log_time_ns);
    ++messages_;
    ++messages_of_[channel];
    if (chunk_.size() >= kChunkBytes && !EndChunk()) return Error::kFailed;
    return Done{};
}

Result<Done> McapFile::Finish() {
    if (chunk_.size() > 0 && !EndChunk()) return Error::kFailed;
    McapBytes end;
    end.Record(kDataEnd, McapBytes().U32(kNoChecksum));
    end.Raw(Summary(position_ + end.size()).bytes()).Raw(kMagic);
    if (!Write(end.bytes()) || std::fflush(file_.get()) != 0) return Error::kFailed;
    return Done{};
}

void McapFile::TimeSpan::Add(std::uint64_t time_ns) {
    first_ns = any ? std::min(first_ns, time_ns) : time_ns;
    last_ns = any ? std::max(last_ns, time_ns) : time_ns;
    any = true;
}

bool McapFile::Write(std::span<const std::uint8_t> bytes) {
    position_ += bytes.size();
    return std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size();
}

bool McapFile::EndChunk() {
    McapBytes head;
    head.U64(chunk_time_.first_ns).U64(chunk_time_.last_ns);
    head.U64(chunk_.size()).U32(kNoChecksum).Text("").U64(chunk_.size());
    McapBytes record;
    record.U8(kChunk).U64(head.size() + chunk_.size()).Raw(head.bytes());
    const std::uint64_t start = position_;
    const bool written = Write(record.bytes()) && Write(chunk_.bytes()) &&
                         WriteIndexes(start, record.size() + chunk_.size());
    ++chunks_;
    chunk_.Clear();
    chunk_time_ = {};
    index_of_.clear();
    return written;
}

/// Behind the chunk an index for each channel in it; where they are goes into the chunk's own entry
/// in the summary.
bool McapFile::WriteIndexes(std::uint64_t chunk_start, std::uint64_t chunk_bytes) {
    McapBytes indexes;
    McapBytes places;
    for (const auto& [channel, entries] : index_of_) {
        places.U16(channel).U64(position_ + indexes.size());
        indexes.Record(kMessageIndex, McapBytes().U16(channel).Sized(entries.bytes()));
    }
    McapBytes entry;
    entry.U64(chunk_time_.first_ns).U64(chunk_time_.last_ns).U64(chunk_start).U64(chunk_bytes);
    entry.Sized(places.bytes()).U64(indexes.size()).Text("").U64(chunk_.size()).U64(chunk_.size());
    chunk_indexes_.Record(kChunkIndex, entry);
    return Write(indexes.bytes());
}

McapBytes McapFile::Statistics() const {
    McapBytes counts;
    for (const auto& [channel, count] : messages_of_) counts.U16(channel).U64(count);
    McapBytes content;
    content.U64(messages_).U16(schemas_).U32(channels_).U32(0).U32(0).U32(chunks_);
    content.U64(time_.first_ns).U64(time_.last_ns).Sized(counts.bytes());
    McapBytes record;
    return record.Record(kStatistics, content);
}

/// With the footer that says where it begins. `start`: its place in the file.
McapBytes McapFile::Summary(std::uint64_t start) const {
    McapBytes summary;
    McapBytes offsets;
    const auto add = [&](Opcode opcode, const McapBytes& group) {
        if (group.size() == 0) return;
        offsets.Record(kSummaryOffset,
                       McapBytes().U8(opcode).U64(start + summary.size()).U64(group.size()));
        summary.Raw(group.bytes());
    };
    add(kSchema, schema_records_);
    add(kChannel, channel_records_);
    add(kStatistics, Statistics());
    add(kChunkIndex, chunk_indexes_);
    const std::uint64_t offsets_start = start + summary.size();
    summary.Raw(offsets.bytes());
    return summary.Record(kFooter, McapBytes().U64(start).U64(offsets_start).U32(kNoChecksum));
}

}  // namespace hitchview::app

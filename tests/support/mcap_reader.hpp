#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hal/expect.hpp"

namespace hitchview::tests {

/// Little-endian values off the front of bytes; stops the test where there are too few.
class LittleEndian {
 public:
    explicit LittleEndian(std::string bytes) : bytes_(std::move(bytes)) {}

    std::uint64_t Number(std::size_t count) {
        const std::string taken = Bytes(count);
        std::uint64_t value = 0;
        for (std::size_t i = count; i-- > 0;)
            value = value << 8 | static_cast<std::uint8_t>(taken[i]);
        return value;
    }
    std::string Bytes(std::size_t count) {
        HV_EXPECT(bytes_.size() - at_ >= count);
        at_ += count;
        return bytes_.substr(at_ - count, count);
    }
    std::string Sized() { return Bytes(Number(4)); }
    [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
    [[nodiscard]] std::size_t at() const { return at_; }

 private:
    std::string bytes_;
    std::size_t at_ = 0;
};

struct McapRecord {
    int opcode = 0;
    std::string content;
    std::size_t at = 0;  ///< in what it was read from
};

inline std::vector<McapRecord> McapRecords(const std::string& bytes) {
    std::vector<McapRecord> records;
    LittleEndian in(bytes);
    while (!in.at_end()) {
        const std::size_t at = in.at();
        const auto opcode = static_cast<int>(in.Number(1));
        records.push_back({opcode, in.Bytes(in.Number(8)), at});
    }
    return records;
}

struct McapMessage {
    std::string topic;
    std::uint32_t sequence = 0;
    std::uint64_t log_time_ns = 0;
    std::string data;
};

/// An MCAP file as a player reads it: from the footer to the summary, from there to each chunk and
/// its indexes. Written after the specification alone; every place that is named is looked at.
class McapReader {
 public:
    struct Schema {
        std::string name;
        std::string encoding;
        std::string definition;
    };
    struct Channel {
        std::uint64_t schema = 0;
        std::string topic;
        std::string encoding;
    };

    explicit McapReader(std::string file) : file_(std::move(file)) {
        const std::string magic("\x89MCAP0\r\n", 8);
        constexpr std::size_t kFooterBytes = 9 + 20;
        HV_EXPECT(file_.starts_with(magic) && file_.ends_with(magic));
        const std::size_t footer = file_.size() - 8 - kFooterBytes;
        const McapRecord record = RecordAt(footer);
        HV_EXPECT(record.opcode == 0x02);
        LittleEndian in(record.content);
        const std::size_t summary = in.Number(8);
        const std::size_t offsets = in.Number(8);
        HV_EXPECT(McapRecords(file_.substr(8, summary - 8)).back().opcode == 0x0F);
        for (const McapRecord& each : McapRecords(file_.substr(summary, offsets - summary)))
            ReadSummary(each);
        for (const McapRecord& each : McapRecords(file_.substr(offsets, footer - offsets)))
            CheckOffset(each);
    }

    std::map<std::uint64_t, Schema> schemas;
    std::map<std::uint64_t, Channel> channels;
    std::vector<McapMessage> messages;  ///< found through the indexes, by chunk and channel
    std::uint64_t counted_messages = 0;
    std::size_t chunks = 0;

 private:
    [[nodiscard]] McapRecord RecordAt(std::size_t at) const {
        LittleEndian in(file_.substr(at));
        const auto opcode = static_cast<int>(in.Number(1));
        return {opcode, in.Bytes(in.Number(8)), at};
    }

    void ReadSummary(const McapRecord& record) {
        LittleEndian in(record.content);
        if (record.opcode == 0x03) {
            const std::uint64_t id = in.Number(2);
            const std::string name = in.Sized();
            const std::string encoding = in.Sized();
            schemas[id] = {name, encoding, in.Sized()};
        } else if (record.opcode == 0x04) {
            const std::uint64_t id = in.Number(2);
            const std::uint64_t schema = in.Number(2);
            const std::string topic = in.Sized();
            channels[id] = {schema, topic, in.Sized()};
        } else if (record.opcode == 0x0B) {
            counted_messages = in.Number(8);
        } else if (record.opcode == 0x08) {
            ReadChunk(in);
        }
    }

    void ReadChunk(LittleEndian& index) {
        ++chunks;
        const std::uint64_t first_ns = index.Number(8);
        const std::uint64_t last_ns = index.Number(8);
        const std::size_t start = index.Number(8);
        const std::size_t bytes = index.Number(8);
        LittleEndian places(index.Sized());
        const McapRecord chunk = RecordAt(start);
        HV_EXPECT(chunk.opcode == 0x06 && chunk.content.size() + 9 == bytes);
        LittleEndian in(chunk.content);
        HV_EXPECT(in.Number(8) == first_ns && in.Number(8) == last_ns);
        const std::size_t records_bytes = in.Number(8);
        HV_EXPECT(in.Number(4) == 0 && in.Sized().empty() && in.Number(8) == records_bytes);
        const std::string records = in.Bytes(records_bytes);
        HV_EXPECT(in.at_end());
        while (!places.at_end()) {
            const std::uint64_t channel = places.Number(2);
            ReadMessages(channel, RecordAt(places.Number(8)), records);
        }
        for (const McapMessage& message : messages)
            HV_EXPECT(message.log_time_ns <= last_ns || chunks > 1);
    }

    void ReadMessages(std::uint64_t channel, const McapRecord& index, const std::string& records) {
        HV_EXPECT(index.opcode == 0x07);
        LittleEndian in(index.content);
        HV_EXPECT(in.Number(2) == channel);
        LittleEndian entries(in.Sized());
        while (!entries.at_end()) {
            const std::uint64_t time_ns = entries.Number(8);
            LittleEndian record(records.substr(entries.Number(8)));
            HV_EXPECT(record.Number(1) == 0x05);
            LittleEndian message(record.Bytes(record.Number(8)));
            HV_EXPECT(message.Number(2) == channel);
            McapMessage read{.topic = channels.at(channel).topic, .data = {}};
            read.sequence = static_cast<std::uint32_t>(message.Number(4));
            read.log_time_ns = message.Number(8);
            HV_EXPECT(read.log_time_ns == time_ns && message.Number(8) == time_ns);
            while (!message.at_end()) read.data += message.Bytes(1);
            messages.push_back(read);
        }
    }

    void CheckOffset(const McapRecord& record) const {
        HV_EXPECT(record.opcode == 0x0E);
        LittleEndian in(record.content);
        const auto opcode = static_cast<int>(in.Number(1));
        const std::size_t start = in.Number(8);
        for (const McapRecord& each : McapRecords(file_.substr(start, in.Number(8))))
            HV_EXPECT(each.opcode == opcode);
    }

    std::string file_;
};

/// Fields of a Protocol Buffers message: number and value, a number's as decimal text.
inline std::vector<std::pair<int, std::string>> ProtobufFields(const std::string& bytes) {
    LittleEndian in(bytes);
    const auto varint = [&in] {
        std::uint64_t value = 0;
        for (int shift = 0;; shift += 7) {
            const std::uint64_t byte = in.Number(1);
            value |= (byte & 0x7F) << shift;
            if (byte < 0x80) return value;
        }
    };
    std::vector<std::pair<int, std::string>> fields;
    while (!in.at_end()) {
        const std::uint64_t tag = varint();
        HV_EXPECT((tag & 7) == 0 || (tag & 7) == 2);
        const std::uint64_t value = varint();
        fields.emplace_back(static_cast<int>(tag >> 3),
                            (tag & 7) == 0 ? std::to_string(value) : in.Bytes(value));
    }
    return fields;
}

}  // namespace hitchview::tests

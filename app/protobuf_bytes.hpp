#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace hitchview::app {

/// A message in the wire format of Protocol Buffers, field after field.
class ProtobufBytes {
 public:
    ProtobufBytes& Integer(int field, std::uint64_t value) {
        constexpr int kVarint = 0;
        return Varint(Tag(field, kVarint)).Varint(value);
    }
    ProtobufBytes& Bytes(int field, std::span<const std::uint8_t> value) {
        constexpr int kLengthDelimited = 2;
        Varint(Tag(field, kLengthDelimited)).Varint(value.size());
        bytes_.insert(bytes_.end(), value.begin(), value.end());
        return *this;
    }
    ProtobufBytes& Text(int field, std::string_view value) {
        return Bytes(field, {reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
    }
    ProtobufBytes& Message(int field, const ProtobufBytes& value) {
        return Bytes(field, value.bytes_);
    }

    [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
    static std::uint64_t Tag(int field, int wire_type) {
        return static_cast<std::uint64_t>(field) << 3 | static_cast<std::uint64_t>(wire_type);
    }
    ProtobufBytes& Varint(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7)
            bytes_.push_back(static_cast<std::uint8_t>(value | 0x80));
        bytes_.push_back(static_cast<std::uint8_t>(value));
        return *this;
    }

    std::vector<std::uint8_t> bytes_;
};

}  // namespace hitchview::app

#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace hitchview::app {

/// Bytes of MCAP records: little-endian numbers, texts and lists with their length in front.
class McapBytes {
 public:
    McapBytes& U8(std::uint8_t value) { return Number(value, 1); }
    McapBytes& U16(std::uint16_t value) { return Number(value, 2); }
    McapBytes& U32(std::uint32_t value) { return Number(value, 4); }
    McapBytes& U64(std::uint64_t value) { return Number(value, 8); }

    McapBytes& Raw(std::span<const std::uint8_t> bytes) {
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        return *this;
    }
    McapBytes& Text(std::string_view text) {
        U32(static_cast<std::uint32_t>(text.size()));
        bytes_.insert(bytes_.end(), text.begin(), text.end());
        return *this;
    }
    /// Bytes, or a list of which these are the entries.
    McapBytes& Sized(std::span<const std::uint8_t> bytes) {
        return U32(static_cast<std::uint32_t>(bytes.size())).Raw(bytes);
    }
    McapBytes& Record(std::uint8_t opcode, const McapBytes& content) {
        return U8(opcode).U64(content.bytes_.size()).Raw(content.bytes_);
    }

    [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }
    void Clear() { bytes_.clear(); }

 private:
    McapBytes& Number(std::uint64_t value, int count) {
        for (int i = 0; i < count; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> 8 * i));
        return *this;
    }

    std::vector<std::uint8_t> bytes_;
};

}  // namespace hitchview::app

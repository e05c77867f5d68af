#include "tests/support/image_message.hpp"

namespace hitchview::tests {
namespace {

using Bytes = std::vector<std::uint8_t>;

void Append(Bytes& bytes, std::uint64_t value, int count) {
    for (int i = count - 1; i >= 0; --i) {
        bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
}

void AppendInt32(Bytes& bytes, std::int64_t value) {
    Append(bytes, static_cast<std::uint64_t>(value), 4);
}

void AppendString(Bytes& bytes, const std::string& text) {
    AppendInt32(bytes, static_cast<std::int64_t>(text.size()) + 1);
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.push_back(0);
}

}  // namespace

std::vector<std::uint8_t> ImageMessage::Encode() const {
    Bytes bytes;
    Append(bytes, fingerprint, 8);
    Append(bytes, 123456789, 8);  // utime
    for (const std::int32_t value : {width_px, height_px, 0, pixel_format}) {
        AppendInt32(bytes, value);
    }
    AppendInt32(bytes, static_cast<std::int64_t>(data.size()));
    bytes.insert(bytes.end(), data.begin(), data.end());
    AppendInt32(bytes, static_cast<std::int64_t>(properties.size()));
    for (const auto& [key, value] : properties) {
        AppendString(bytes, key);
        AppendInt32(bytes, static_cast<std::int64_t>(value.size()));
        bytes.insert(bytes.end(), value.begin(), value.end());
    }
    return bytes;
}

void PutInt32(Bytes& bytes, std::size_t at, std::int32_t value) {
    for (std::size_t i = 0; i < 4; ++i) {
        bytes.at(at + i) = static_cast<std::uint8_t>(value >> (24 - 8 * i));
    }
}

}  // namespace hitchview::tests

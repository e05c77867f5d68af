#include "drivers/lcm_log_writer.hpp"

#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <string>

#include "drivers/lcm_log_format.hpp"
#include "hal/expect.hpp"

namespace hitchview::drivers {
namespace {

using hal::Done;
using hal::Error;
using hal::Result;

using Pieces = std::array<iovec, 3>;

// The system's type has no const; writing only reads.
iovec Piece(const void* data, std::size_t bytes) {
    return {const_cast<void*>(data), bytes};
}

std::size_t Total(const Pieces& pieces) {
    std::size_t bytes = 0;
    for (const iovec& piece : pieces) bytes += piece.iov_len;
    return bytes;
}

void DropFirst(std::size_t bytes, Pieces& pieces) {
    for (iovec& piece : pieces) {
        const std::size_t dropped = std::min(bytes, piece.iov_len);
        piece =
            Piece(static_cast<std::uint8_t*>(piece.iov_base) + dropped, piece.iov_len - dropped);
        bytes -= dropped;
    }
}

bool WriteAll(int descriptor, std::uint64_t offset, Pieces pieces) {
    while (Total(pieces) > 0) {
        const ssize_t written =
            pwritev(descriptor, pieces.data(), pieces.size(), static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        offset += static_cast<std::uint64_t>(written);
        DropFirst(static_cast<std::size_t>(written), pieces);
    }
    return true;
}

/// Keeps errno of the refusal that makes it necessary.
void CutBack(int descriptor, std::uint64_t bytes) {
    const int refusal = errno;
    // If even this is refused, a reader finds a torn end.
    [[maybe_unused]] const int cut = ftruncate(descriptor, static_cast<off_t>(bytes));
    errno = refusal;
}

}  // namespace

hal::Checked<std::unique_ptr<LcmLogWriter>> LcmLogWriter::Create(
    const std::filesystem::path& file) {
    auto writer = std::make_unique<LcmLogWriter>();
    if (!writer->Open(file.c_str()))
        return file.string() + ": cannot be written: " + std::strerror(errno);
    return writer;
}

LcmLogWriter::~LcmLogWriter() {
    Close();
}

Result<Done> LcmLogWriter::Open(const char* file) {
    constexpr mode_t kReadableByAll = 0644;
    Close();
    descriptor_ = open(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kReadableByAll);
    if (descriptor_ < 0) return Error::kFailed;
    return Done{};
}

void LcmLogWriter::Close() {
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
    bytes_ = 0;
    events_ = 0;
}

Result<Done> LcmLogWriter::Append(std::int64_t utime_us, std::string_view channel,
                                  std::span<const std::uint8_t> data) {
    HV_EXPECT(!channel.empty() && channel.size() <= kLcmLongestChannel);
    if (data.size() > std::numeric_limits<std::int32_t>::max()) return Error::kTooLarge;
    const LcmLogHeader header{.number = events_,
                              .utime_us = utime_us,
                              .channel_bytes = static_cast<std::int32_t>(channel.size()),
                              .data_bytes = static_cast<std::int32_t>(data.size())};
    const LcmLogHeaderBytes head = EncodeLcmLogHeader(header);
    const Pieces pieces{Piece(head.data(), head.size()), Piece(channel.data(), channel.size()),
                        Piece(data.data(), data.size())};
    if (!WriteAll(descriptor_, bytes_, pieces)) {
        CutBack(descriptor_, bytes_);
        return Error::kFailed;
    }
    bytes_ += header.EventBytes();
    ++events_;
    return Done{};
}

Result<Done> LcmLogWriter::Sync() {
    if (fdatasync(descriptor_) == 0) return Done{};
    return Error::kFailed;
}

}  // namespace hitchview::drivers

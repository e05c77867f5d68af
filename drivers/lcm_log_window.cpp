#include "drivers/lcm_log_window.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace hitchview::drivers {

hal::Checked<std::unique_ptr<LcmLogWindow>> LcmLogWindow::Open(const std::string& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return file + ": cannot be read: " + std::strerror(errno);
    struct stat status {};
    const bool known = fstat(descriptor, &status) == 0;
    if (known && S_ISREG(status.st_mode)) {
        const auto size_bytes = static_cast<std::uint64_t>(status.st_size);
        return std::unique_ptr<LcmLogWindow>(new LcmLogWindow(descriptor, size_bytes));
    }
    close(descriptor);
    return file + ": is not a file";
}

LcmLogWindow::LcmLogWindow(int descriptor, std::uint64_t size_bytes)
    : descriptor_(descriptor), size_bytes_(size_bytes), memory_(kBytes) {}

LcmLogWindow::LcmLogWindow(std::span<const std::uint8_t> bytes)
    : descriptor_(-1), size_bytes_(bytes.size()), held_(bytes) {}

LcmLogWindow::~LcmLogWindow() {
    if (descriptor_ >= 0) close(descriptor_);
}

std::span<const std::uint8_t> LcmLogWindow::Lend(std::uint64_t offset, std::size_t count) {
    if (Holds(offset, count)) return Held(offset, count);
    if (offset > size_bytes_ || count > size_bytes_ - offset) return {};
    if (memory_.size() < count) memory_.resize(count);
    const std::uint64_t wanted = std::max(count, kBytes);
    const auto piece =
        std::span(memory_).first(static_cast<std::size_t>(std::min(wanted, size_bytes_ - offset)));
    start_ = offset;
    held_ = {};
    if (!Read(offset, piece)) return {};
    held_ = piece;
    return Held(offset, count);
}

bool LcmLogWindow::Copy(std::uint64_t offset, std::span<std::uint8_t> bytes) {
    if (offset > size_bytes_ || bytes.size() > size_bytes_ - offset) return false;
    if (!Holds(offset, bytes.size())) return Read(offset, bytes);
    std::ranges::copy(Held(offset, bytes.size()), bytes.begin());
    return true;
}

std::optional<std::uint64_t> LcmLogWindow::Find(std::span<const std::uint8_t> pattern,
                                                std::uint64_t from, std::uint64_t until) {
    until = std::min(until, size_bytes_);
    while (from < until && size_bytes_ - from >= pattern.size()) {
        // The last one may begin just before `until` and reach past it.
        const std::uint64_t wanted = std::min(until + pattern.size() - 1, size_bytes_) - from;
        const auto piece =
            Lend(from, static_cast<std::size_t>(std::min<std::uint64_t>(kBytes, wanted)));
        if (piece.size() < pattern.size()) return std::nullopt;
        const void* const place =
            memmem(piece.data(), piece.size(), pattern.data(), pattern.size());
        if (place != nullptr)
            return from + (static_cast<const std::uint8_t*>(place) - piece.data());
        from += piece.size() - pattern.size() + 1;
    }
    return std::nullopt;
}

bool LcmLogWindow::Holds(std::uint64_t offset, std::size_t count) const {
    return offset >= start_ && offset - start_ <= held_.size() &&
           count <= held_.size() - (offset - start_);
}

std::span<const std::uint8_t> LcmLogWindow::Held(std::uint64_t offset, std::size_t count) const {
    return held_.subspan(static_cast<std::size_t>(offset - start_), count);
}

bool LcmLogWindow::Read(std::uint64_t offset, std::span<std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t got =
            pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) continue;
        // None: the file has become shorter since it was opened.
        failed_ = failed_ || got <= 0;
        if (got <= 0) return false;
        offset += static_cast<std::uint64_t>(got);
        bytes = bytes.subspan(static_cast<std::size_t>(got));
    }
    return true;
}

}  // namespace hitchview::drivers

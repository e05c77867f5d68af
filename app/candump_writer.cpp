#include "app/candump_writer.hpp"

#include <cerrno>
#include <cstring>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

using hal::CanFrame;
using hal::CanFrameKind;

constexpr std::uint32_t kErrorFlag = 0x20000000;
constexpr std::int64_t kMicrosecondsPerSecond = 1'000'000;

}  // namespace

CandumpLine::CandumpLine(std::string_view interface) : interface_(interface) {
    HV_EXPECT(!interface.empty() && interface.size() < 16);
}

std::string_view CandumpLine::Format(const CanFrame& frame) {
    length_ = 0;
    AppendTime(frame.epoch);
    Append(interface_);
    Append(" ");
    AppendId(frame);
    AppendData(frame);
    Append("\n");
    return {text_.data(), length_};
}

void CandumpLine::Append(std::string_view text) {
    length_ += text.copy(text_.data() + length_, text_.size() - length_);
}

void CandumpLine::AppendHex(std::uint64_t number, int digits) {
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4)
        text_[length_++] = "0123456789ABCDEF"[number >> shift & 15];
}

void CandumpLine::AppendDecimal(std::int64_t number, int digits) {
    length_ += static_cast<std::size_t>(digits);
    for (std::size_t i = 1; i <= static_cast<std::size_t>(digits); ++i, number /= 10)
        text_[length_ - i] = static_cast<char>('0' + number % 10);
}

void CandumpLine::AppendTime(std::chrono::nanoseconds epoch) {
    const std::int64_t epoch_us = epoch.count() / 1000;
    HV_EXPECT(epoch_us >= 0 && epoch_us / kMicrosecondsPerSecond < 10'000'000'000);
    Append("(");
    AppendDecimal(epoch_us / kMicrosecondsPerSecond, 10);
    Append(".");
    AppendDecimal(epoch_us % kMicrosecondsPerSecond, 6);
    Append(") ");
}

void CandumpLine::AppendId(const CanFrame& frame) {
    const bool error = frame.kind == CanFrameKind::kError;
    AppendHex(error ? frame.id | kErrorFlag : frame.id, error || frame.extended ? 8 : 3);
    Append("#");
}

void CandumpLine::AppendData(const CanFrame& frame) {
    if (frame.kind == CanFrameKind::kRemote) {
        Append("R");
        if (frame.size_bytes > 0) AppendHex(frame.size_bytes, 1);
        return;
    }
    if (frame.fd) {
        Append("#");
        AppendHex(frame.fd_flags, 1);
    }
    for (std::size_t i = 0; i < frame.size_bytes; ++i) AppendHex(frame.data[i], 2);
}

hal::Checked<std::unique_ptr<CandumpWriter>> CandumpWriter::Open(const std::filesystem::path& file,
                                                                 std::string_view interface) {
    std::unique_ptr<CandumpWriter> self(new CandumpWriter(file, interface));
    if (self->out_) return self;
    return file.string() + ": cannot be written: " + std::strerror(errno);
}

void CandumpWriter::Append(const CanFrame& frame) {
    const std::string_view line = line_.Format(frame);
    out_.write(line.data(), static_cast<std::streamsize>(line.size()));
}

hal::Checked<hal::Done> CandumpWriter::Finish() {
    out_.close();
    if (out_) return hal::Done{};
    return file_ + ": cannot be written: " + std::strerror(errno);
}

}  // namespace hitchview::app

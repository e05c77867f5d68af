#include "app/avi_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

constexpr std::size_t kMostSegments = 256;
constexpr std::uint32_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kHasIndexFlag = 0x10;
constexpr std::uint32_t kKeyFrameFlag = 0x10;
constexpr std::uint8_t kIndexOfIndexes = 0;
constexpr std::uint8_t kIndexOfChunks = 1;

// Little-endian RIFF content; Begin and End nest, End fills in the size.
class RiffBytes {
 public:
    std::vector<std::uint8_t> bytes;

    RiffBytes& Tag(std::string_view four) {
        bytes.insert(bytes.end(), four.begin(), four.end());
        return *this;
    }
    RiffBytes& Number(std::uint64_t value, int size_bytes) {
        for (int i = 0; i < size_bytes; ++i, value >>= 8) {
            bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
        }
        return *this;
    }
    RiffBytes& U16(std::uint64_t value) { return Number(value, 2); }
    RiffBytes& U32(std::uint64_t value) { return Number(value, 4); }
    RiffBytes& Zeros(std::size_t count) {
        bytes.insert(bytes.end(), count, 0);
        return *this;
    }
    RiffBytes& Begin(std::string_view four) {
        Tag(four).U32(0);
        open_.push_back(bytes.size());
        return *this;
    }
    RiffBytes& End() {
        const std::size_t start = open_.back();
        open_.pop_back();
        const std::size_t size = bytes.size() - start;
        for (std::size_t i = 0; i < 4; ++i) {
            bytes[start - 4 + i] = static_cast<std::uint8_t>(size >> (8 * i) & 0xFF);
        }
        return *this;
    }

 private:
    std::vector<std::size_t> open_;
};

// Frames per second as rate / scale.
constexpr std::uint32_t kScale = 1000;
std::uint32_t Rate(double rate_hz) {
    return static_cast<std::uint32_t>(std::lround(rate_hz * kScale));
}

void AppendStreamHeader(const AviFormat& format, std::uint32_t frames, std::uint32_t largest_bytes,
                        RiffBytes& riff) {
    riff.Begin("strh").Tag("vids").Tag("MJPG").Zeros(12);
    riff.U32(kScale).U32(Rate(format.rate_hz)).U32(0).U32(frames).U32(largest_bytes);
    riff.U32(0xFFFFFFFF).U32(0);  // quality: unstated; sample size: varies
    riff.U16(0).U16(0).U16(format.width_px).U16(format.height_px).End();
    riff.Begin("strf").U32(40).U32(format.width_px).U32(format.height_px).U16(1).U16(24);
    riff.Tag("MJPG").U32(3ULL * format.width_px * format.height_px).Zeros(16).End();
}

}  // namespace

hal::Checked<std::unique_ptr<AviFile>> AviFile::Create(const std::string& path,
                                                       const AviFormat& format) {
    HV_EXPECT(format.width_px > 0 && format.height_px > 0 && format.rate_hz > 0);
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) return path + ": " + std::strerror(errno);
    std::unique_ptr<AviFile> avi(new AviFile(file, format));
    if (!avi->BeginSegment()) return path + ": " + std::strerror(errno);
    return avi;
}

AviFile::AviFile(std::FILE* file, const AviFormat& format) : file_(file), format_(format) {}

hal::Result<hal::Done> AviFile::Append(std::span<const std::uint8_t> jpeg) {
    if (position_ - movi_ + jpeg.size() > format_.segment_bytes && !pictures_.empty()) {
        // One entry stays free for the segment that Finish closes.
        if (segments_.size() + 1 == kMostSegments) return hal::Error::kTooLarge;
        if (!EndSegment() || !BeginSegment()) return hal::Error::kFailed;
    }
    const auto size = static_cast<std::uint32_t>(jpeg.size());
    const auto offset = static_cast<std::uint32_t>(position_ - movi_);
    RiffBytes head;
    head.Tag("00dc").U32(size);
    constexpr std::uint8_t kPadding = 0;
    const bool written =
        Write(head.bytes) && Write(jpeg) && (size % 2 == 0 || Write({&kPadding, 1}));
    if (!written) return hal::Error::kFailed;
    pictures_.push_back({offset, size});
    largest_bytes_ = std::max(largest_bytes_, size);
    return hal::Done{};
}

hal::Result<hal::Done> AviFile::Finish() {
    if (!EndSegment()) return hal::Error::kFailed;
    // The sizes in the first segment's own head are patched already; keep them.
    std::vector<std::uint8_t> header = Header();
    constexpr std::size_t kRiffHead = 8;
    const std::size_t middle = header.size() - 12 - kRiffHead;
    const bool written = std::fseek(file_.get(), kRiffHead, SEEK_SET) == 0 &&
                         Write(std::span(header).subspan(kRiffHead, middle)) &&
                         std::fflush(file_.get()) == 0;
    return written ? hal::Result<hal::Done>(hal::Done{}) : hal::Error::kFailed;
}

std::uint32_t AviFile::frames() const {
    auto frames = static_cast<std::uint32_t>(pictures_.size());
    for (const Segment& segment : segments_) frames += segment.frames;
    return frames;
}

std::vector<std::uint8_t> AviFile::Header() const {
    RiffBytes riff;
    const std::uint32_t first_frames = segments_.empty() ? 0 : segments_.front().frames;
    riff.Tag("RIFF").U32(0).Tag("AVI ").Begin("LIST").Tag("hdrl");
    riff.Begin("avih").U32(std::lround(1e6 / format_.rate_hz)).U32(0).U32(0).U32(kHasIndexFlag);
    riff.U32(first_frames).U32(0).U32(1).U32(largest_bytes_);
    riff.U32(format_.width_px).U32(format_.height_px).Zeros(16).End();
    riff.Begin("LIST").Tag("strl");
    AppendStreamHeader(format_, frames(), largest_bytes_, riff);
    riff.Begin("indx").U16(4).Number(0, 1).Number(kIndexOfIndexes, 1);
    riff.U32(segments_.size()).Tag("00dc").Zeros(12);
    for (const Segment& segment : segments_) {
        riff.Number(segment.index_offset_bytes, 8).U32(segment.index_bytes).U32(segment.frames);
    }
    riff.Zeros((kMostSegments - segments_.size()) * 16).End().End();
    riff.Begin("LIST").Tag("odml").Begin("dmlh").U32(frames()).End().End().End();
    riff.Tag("LIST").U32(0).Tag("movi");
    return std::move(riff.bytes);
}

std::vector<std::uint8_t> AviFile::SegmentIndex() const {
    RiffBytes riff;
    riff.Begin("ix00").U16(2).Number(0, 1).Number(kIndexOfChunks, 1);
    riff.U32(pictures_.size()).Tag("00dc").Number(movi_, 8).U32(0);
    for (const Picture& picture : pictures_) {
        riff.U32(picture.offset_bytes + kChunkHeaderBytes).U32(picture.size_bytes);
    }
    return std::move(riff.End().bytes);
}

std::vector<std::uint8_t> AviFile::LegacyIndex() const {
    RiffBytes riff;
    riff.Begin("idx1");
    for (const Picture& picture : pictures_) {
        riff.Tag("00dc").U32(kKeyFrameFlag).U32(picture.offset_bytes).U32(picture.size_bytes);
    }
    return std::move(riff.End().bytes);
}

bool AviFile::Write(std::span<const std::uint8_t> bytes) {
    position_ += bytes.size();
    return std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size();
}

bool AviFile::PatchSize(std::uint64_t position, std::uint64_t size_bytes) {
    RiffBytes size;
    size.U32(size_bytes);
    return std::fseek(file_.get(), static_cast<long>(position), SEEK_SET) == 0 &&
           std::fwrite(size.bytes.data(), 1, 4, file_.get()) == 4 &&
           std::fseek(file_.get(), 0, SEEK_END) == 0;
}

bool AviFile::BeginSegment() {
    pictures_.clear();
    RiffBytes next;
    next.Tag("RIFF").U32(0).Tag("AVIX").Tag("LIST").U32(0).Tag("movi");
    const bool written = Write(segments_.empty() ? Header() : next.bytes);
    movi_ = position_ - 4;
    return written;
}

bool AviFile::EndSegment() {
    const std::vector<std::uint8_t> index = SegmentIndex();
    const std::uint64_t index_offset = position_;
    if (!Write(index) || !PatchSize(movi_ - 4, position_ - movi_)) return false;
    const bool first = segments_.empty();
    if (first && !Write(LegacyIndex())) return false;
    const std::uint64_t riff = first ? 0 : movi_ - 20;
    segments_.push_back({index_offset, static_cast<std::uint32_t>(index.size()),
                         static_cast<std::uint32_t>(pictures_.size())});
    pictures_.clear();
    return PatchSize(riff + 4, position_ - riff - 8);
}

}  // namespace hitchview::app

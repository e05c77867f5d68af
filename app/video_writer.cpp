#include "app/video_writer.hpp"

#include <turbojpeg.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "app/thread_schedule.hpp"

namespace hitchview::app {
namespace {

void CopyPlane(const hal::Plane& plane, int width_px, int height_px, std::uint8_t* target) {
    for (int y = 0; y < height_px; ++y) {
        const std::uint8_t* const row = plane.data + std::ptrdiff_t{y} * plane.stride_bytes;
        target = std::copy_n(row, width_px, target);
    }
}

void CopyFrame(const hal::FrameView& frame, std::span<std::uint8_t> target) {
    const hal::FrameFormat& format = frame.format;
    const auto planes = hal::PackedPlanes(format, target.data());
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const int divisor = i == 0 ? 1 : 2;
        CopyPlane(frame.planes[i], format.width_px / divisor, format.height_px / divisor,
                  target.data() + (planes[i].data - target.data()));
    }
}

}  // namespace

void VideoWriter::DestroyJpeg::operator()(void* handle) const {
    tjDestroy(handle);
}

hal::Checked<std::unique_ptr<VideoWriter>> VideoWriter::Open(const std::string& path,
                                                             const hal::FrameFormat& format,
                                                             const VideoWriterOptions& options) {
    HV_EXPECT(format.pixel_format == hal::PixelFormat::kI420);
    HV_EXPECT(format.range == hal::Range::kFull);
    auto file = AviFile::Create(
        path,
        {.width_px = format.width_px, .height_px = format.height_px, .rate_hz = options.rate_hz});
    if (!file) return file.error();
    std::unique_ptr<VideoWriter> writer(new VideoWriter(path, format, options));
    writer->file_ = std::move(*file);
    writer->thread_ = std::thread(&VideoWriter::WriteAll, writer.get());
    return writer;
}

VideoWriter::VideoWriter(const std::string& path, const hal::FrameFormat& format,
                         const VideoWriterOptions& options)
    : path_(path),
      options_(options),
      pool_(format, options.queued_frames),
      compressor_(tjInitCompress()),
      jpeg_(tjBufSize(format.width_px, format.height_px, TJSAMP_420)) {
    HV_EXPECT(compressor_ != nullptr);
    while (const auto maybe_slot = pool_.Take()) free_.Append(*maybe_slot);
}

VideoWriter::~VideoWriter() {
    if (thread_.joinable()) (void)Finish();
}

hal::Result<hal::Done> VideoWriter::Append(const hal::FrameView& frame) {
    HV_EXPECT(thread_.joinable() && frame.format == pool_.format());
    if (refused_.load(std::memory_order_relaxed)) return hal::Error::kFailed;
    const hal::FramePool::Slot slot = *free_.Take();
    CopyFrame(frame, slot.bytes);
    filled_.Append(slot);
    return hal::Done{};
}

hal::Checked<hal::Done> VideoWriter::Finish() {
    HV_EXPECT(thread_.joinable());
    filled_.Close();
    thread_.join();
    if (!refused_ && !file_->Finish()) Refuse(std::strerror(errno));
    file_.reset();
    if (refused_) return refusal_;
    return hal::Done{};
}

// A refused frame's slot still goes round, so that Append never waits for ever.
void VideoWriter::WriteAll() {
    NameThisThread("out-" + options_.name);
    while (const auto maybe_slot = filled_.Take()) {
        if (!refused_) WriteOne(*maybe_slot);
        free_.Append(*maybe_slot);
    }
}

void VideoWriter::WriteOne(const hal::FramePool::Slot& slot) {
    const hal::FrameFormat& format = pool_.format();
    std::array<const unsigned char*, 3> planes{};
    std::array<int, 3> strides{};
    std::ranges::transform(hal::PackedPlanes(format, slot.bytes.data()), planes.begin(),
                           &hal::Plane::data);
    std::ranges::transform(hal::PackedPlanes(format, slot.bytes.data()), strides.begin(),
                           &hal::Plane::stride_bytes);
    unsigned char* jpeg = jpeg_.data();
    unsigned long jpeg_bytes = jpeg_.size();
    if (tjCompressFromYUVPlanes(compressor_.get(), planes.data(), format.width_px, strides.data(),
                                format.height_px, TJSAMP_420, &jpeg, &jpeg_bytes, options_.quality,
                                TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT) != 0) {
        return Refuse(tjGetErrorStr2(compressor_.get()));
    }
    const auto written = file_->Append(std::span(jpeg, jpeg_bytes));
    if (written) return;
    Refuse(written.error() == hal::Error::kTooLarge ? "too long" : std::strerror(errno));
}

void VideoWriter::Refuse(const std::string& reason) {
    refusal_ = path_ + ": " + reason;
    refused_ = true;
}

}  // namespace hitchview::app

#include "drivers/frame_jpeg_decoder.hpp"

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "drivers/frame_jpeg_memory.hpp"
#include "hal/expect.hpp"

// After jpeglib.h, which it needs.
#include <jerror.h>

namespace hitchview::drivers {
namespace {

constexpr int kBlock = 8;
constexpr int kMostLines = 2 * kBlock;  // of one component in a row of MCUs

/// What a camera's picture may warn of and still be whole.
bool IsHarmless(int warning) {
    return warning == JWRN_EXTRANEOUS_DATA || warning == JWRN_JFIF_MAJOR ||
           warning == JWRN_ADOBE_XFORM;
}

/// One component of a row of MCUs, as decoded.
struct Component {
    std::vector<std::uint8_t> samples;
    std::array<JSAMPROW, kMostLines> lines{};

    void TakeMemory(int width_samples) {
        samples.resize(static_cast<std::size_t>(width_samples) * kMostLines);
        for (int i = 0; i < kMostLines; ++i) {
            lines[static_cast<std::size_t>(i)] =
                samples.data() + static_cast<std::ptrdiff_t>(width_samples) * i;
        }
    }
};

struct Steps {
    int x;
    int y;
};

/// Means of `steps.x` by `steps.y` samples, rounded, into every other byte.
void AverageLine(const JSAMPROW* lines, Steps steps, int samples, std::uint8_t* to) {
    const JSAMPROW above = lines[0];
    const JSAMPROW below = lines[steps.y - 1];
    for (int x = 0; x < samples; ++x) {
        const int left = x * steps.x;
        const int right = left + steps.x - 1;
        to[2 * x] = static_cast<std::uint8_t>(
            (above[left] + above[right] + below[left] + below[right] + 2) / 4);
    }
}

}  // namespace

struct FrameJpegDecoder::Library {
    explicit Library(const hal::FrameFormat& frame_format);
    ~Library();

    [[noreturn]] static void Leave(j_common_ptr common);
    static void NoteWarning(j_common_ptr common, int level);
    void DecodePicture(std::span<const std::uint8_t> jpeg, std::uint8_t* nv12);
    void Begin(std::span<const std::uint8_t> jpeg);
    void RefuseOthers();
    void StoreLuma(int first_line, std::uint8_t* nv12);
    void StoreChroma(int component, int first_line, std::uint8_t* nv12);

    hal::FrameFormat format;
    jpeg_decompress_struct decompressor{};
    jpeg_error_mgr errors{};
    std::jmp_buf way_out{};
    bool damaged = false;
    std::array<Component, 3> components;
    std::unique_ptr<FrameJpegMemory> memory;
};

FrameJpegDecoder::Library::Library(const hal::FrameFormat& frame_format) : format(frame_format) {
    decompressor.err = jpeg_std_error(&errors);
    errors.error_exit = Leave;
    errors.emit_message = NoteWarning;
    jpeg_create_decompress(&decompressor);
    decompressor.client_data = this;
    memory = std::make_unique<FrameJpegMemory>(decompressor);
    const int width = (format.width_px + kMostLines - 1) / kMostLines * kMostLines;
    for (Component& component : components) component.TakeMemory(width);
}

FrameJpegDecoder::Library::~Library() {
    memory.reset();
    jpeg_destroy_decompress(&decompressor);
}

void FrameJpegDecoder::Library::Leave(j_common_ptr common) {
    std::longjmp(static_cast<Library*>(common->client_data)->way_out, 1);
}

void FrameJpegDecoder::Library::NoteWarning(j_common_ptr common, int level) {
    if (level >= 0 || IsHarmless(common->err->msg_code)) return;
    static_cast<Library*>(common->client_data)->damaged = true;
}

void FrameJpegDecoder::Library::DecodePicture(std::span<const std::uint8_t> jpeg,
                                              std::uint8_t* nv12) {
    Begin(jpeg);
    std::array<JSAMPARRAY, 3> planes{components[0].lines.data(), components[1].lines.data(),
                                     components[2].lines.data()};
    const int lines = decompressor.max_v_samp_factor * kBlock;
    for (int line = 0; line < format.height_px; line += lines) {
        jpeg_read_raw_data(&decompressor, planes.data(), static_cast<JDIMENSION>(lines));
        StoreLuma(line, nv12);
        StoreChroma(1, line, nv12);
        StoreChroma(2, line, nv12);
    }
    jpeg_finish_decompress(&decompressor);
}

void FrameJpegDecoder::Library::Begin(std::span<const std::uint8_t> jpeg) {
    memory->Forget();
    jpeg_mem_src(&decompressor, jpeg.data(), static_cast<unsigned long>(jpeg.size()));
    jpeg_read_header(&decompressor, TRUE);
    RefuseOthers();
    decompressor.out_color_space = decompressor.jpeg_color_space;
    decompressor.raw_data_out = TRUE;
    jpeg_start_decompress(&decompressor);
}

void FrameJpegDecoder::Library::RefuseOthers() {
    const jpeg_decompress_struct& d = decompressor;
    bool taken = static_cast<int>(d.image_width) == format.width_px &&
                 static_cast<int>(d.image_height) == format.height_px &&
                 jpeg_has_multiple_scans(&decompressor) == FALSE;
    const bool grey = d.jpeg_color_space == JCS_GRAYSCALE && d.num_components == 1;
    const bool colour = d.jpeg_color_space == JCS_YCbCr && d.num_components == 3;
    taken = taken && (grey || colour) && d.max_h_samp_factor <= 2 && d.max_v_samp_factor <= 2;
    for (int i = 0; taken && i < d.num_components; ++i) {
        const jpeg_component_info& info = d.comp_info[i];
        taken = i == 0 ? info.h_samp_factor == d.max_h_samp_factor &&
                             info.v_samp_factor == d.max_v_samp_factor
                       : info.h_samp_factor == 1 && info.v_samp_factor == 1;
    }
    if (!taken) Leave(reinterpret_cast<j_common_ptr>(&decompressor));
}

void FrameJpegDecoder::Library::StoreLuma(int first_line, std::uint8_t* nv12) {
    const int lines =
        std::min(decompressor.max_v_samp_factor * kBlock, format.height_px - first_line);
    for (int i = 0; i < lines; ++i) {
        std::memcpy(nv12 + static_cast<std::ptrdiff_t>(first_line + i) * format.width_px,
                    components[0].lines[static_cast<std::size_t>(i)],
                    static_cast<std::size_t>(format.width_px));
    }
}

void FrameJpegDecoder::Library::StoreChroma(int component, int first_line, std::uint8_t* nv12) {
    const int width = format.width_px / 2;
    const std::ptrdiff_t luma = static_cast<std::ptrdiff_t>(format.width_px) * format.height_px;
    std::uint8_t* const plane = nv12 + luma + (component - 1);
    const Steps steps{2 / decompressor.max_h_samp_factor, 2 / decompressor.max_v_samp_factor};
    const int lines =
        std::min(decompressor.max_v_samp_factor * kBlock, format.height_px - first_line) / 2;
    Component& decoded = components[static_cast<std::size_t>(component)];
    for (int i = 0; i < lines; ++i) {
        std::uint8_t* const to =
            plane + static_cast<std::ptrdiff_t>(first_line / 2 + i) * format.width_px;
        const JSAMPROW* const from =
            decoded.lines.data() + static_cast<std::ptrdiff_t>(i) * steps.y;
        if (decompressor.num_components == 1) {
            for (int x = 0; x < width; ++x) to[2 * x] = 128;
        } else {
            AverageLine(from, steps, width, to);
        }
    }
}

FrameJpegDecoder::FrameJpegDecoder(const hal::FrameFormat& format)
    : library_(std::make_unique<Library>(format)) {
    HV_EXPECT(format.pixel_format == hal::PixelFormat::kNv12);
}

FrameJpegDecoder::~FrameJpegDecoder() = default;

hal::Result<hal::Done> FrameJpegDecoder::Decode(std::span<const std::uint8_t> jpeg,
                                                std::span<std::uint8_t> nv12) {
    HV_EXPECT(nv12.size() == hal::FrameBytes(library_->format));
    if (jpeg.empty()) return hal::Error::kCorrupted;
    library_->damaged = false;
    // libjpeg leaves by longjmp where it cannot go on; nothing between here and there needs a
    // destructor.
    if (setjmp(library_->way_out) != 0) {  // NOLINT(cert-err52-cpp)
        jpeg_abort_decompress(&library_->decompressor);
        return hal::Error::kCorrupted;
    }
    library_->DecodePicture(jpeg, nv12.data());
    if (library_->damaged) return hal::Error::kCorrupted;
    return hal::Done{};
}

}  // namespace hitchview::drivers

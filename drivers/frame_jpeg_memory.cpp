#include "drivers/frame_jpeg_memory.hpp"

#include <jerror.h>

#include <algorithm>
#include <cstdint>

namespace hitchview::drivers {
namespace {

/// The tables of a picture; independent of its size.
constexpr std::size_t kCapacityBytes = std::size_t{64} * 1024;
/// A cache line, and more than the vector instructions of libjpeg-turbo ask for.
constexpr std::size_t kAlignmentBytes = 64;

[[noreturn]] void Refuse(j_common_ptr decompressor) {
    decompressor->err->msg_code = JERR_OUT_OF_MEMORY;
    decompressor->err->error_exit(decompressor);
    __builtin_unreachable();
}

}  // namespace

void* FrameJpegMemory::Stack::Take(std::size_t count) {
    const auto top = reinterpret_cast<std::uintptr_t>(bytes.data()) + used;
    const std::size_t padding = (kAlignmentBytes - top % kAlignmentBytes) % kAlignmentBytes;
    if (count > bytes.size() - used || padding > bytes.size() - used - count) return nullptr;
    void* const block = bytes.data() + used + padding;
    used += padding + count;
    return block;
}

FrameJpegMemory::FrameJpegMemory(jpeg_decompress_struct& decompressor)
    : jpeg_memory_mgr{}, decompressor_(decompressor), original_(decompressor.mem) {
    lasting_.bytes.resize(kCapacityBytes);
    picture_.bytes.resize(kCapacityBytes);
    max_alloc_chunk = static_cast<long>(kCapacityBytes);
    ServeBlocks();
    RefuseArrays();
    decompressor_.mem = this;
}

FrameJpegMemory::~FrameJpegMemory() {
    decompressor_.mem = original_;
}

void FrameJpegMemory::Forget() {
    decompressor_.src = nullptr;
    std::ranges::fill(decompressor_.quant_tbl_ptrs, nullptr);
    std::ranges::fill(decompressor_.dc_huff_tbl_ptrs, nullptr);
    std::ranges::fill(decompressor_.ac_huff_tbl_ptrs, nullptr);
    lasting_.used = 0;
}

FrameJpegMemory& FrameJpegMemory::Of(j_common_ptr decompressor) {
    return static_cast<FrameJpegMemory&>(*decompressor->mem);
}

void* FrameJpegMemory::Take(j_common_ptr decompressor, int pool, std::size_t bytes) {
    FrameJpegMemory& self = Of(decompressor);
    void* const block = (pool == JPOOL_PERMANENT ? self.lasting_ : self.picture_).Take(bytes);
    if (block == nullptr) Refuse(decompressor);
    return block;
}

void FrameJpegMemory::ServeBlocks() {
    alloc_small = Take;
    alloc_large = Take;
    free_pool = [](j_common_ptr decompressor, int pool) {
        if (pool == JPOOL_IMAGE) Of(decompressor).picture_.used = 0;
    };
    realize_virt_arrays = [](j_common_ptr) {};
}

void FrameJpegMemory::RefuseArrays() {
    alloc_sarray = [](j_common_ptr decompressor, int, JDIMENSION, JDIMENSION) -> JSAMPARRAY {
        Refuse(decompressor);
    };
    alloc_barray = [](j_common_ptr decompressor, int, JDIMENSION, JDIMENSION) -> JBLOCKARRAY {
        Refuse(decompressor);
    };
    request_virt_sarray = [](j_common_ptr decompressor, int, boolean, JDIMENSION, JDIMENSION,
                             JDIMENSION) -> jvirt_sarray_ptr { Refuse(decompressor); };
    request_virt_barray = [](j_common_ptr decompressor, int, boolean, JDIMENSION, JDIMENSION,
                             JDIMENSION) -> jvirt_barray_ptr { Refuse(decompressor); };
    access_virt_sarray = [](j_common_ptr decompressor, jvirt_sarray_ptr, JDIMENSION, JDIMENSION,
                            boolean) -> JSAMPARRAY { Refuse(decompressor); };
    access_virt_barray = [](j_common_ptr decompressor, jvirt_barray_ptr, JDIMENSION, JDIMENSION,
                            boolean) -> JBLOCKARRAY { Refuse(decompressor); };
    self_destruct = [](j_common_ptr decompressor) { Refuse(decompressor); };
}

}  // namespace hitchview::drivers

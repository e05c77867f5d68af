#include "app/jpeg_memory.hpp"

#include <cstdint>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

/// The tables of one picture; independent of its size.
constexpr std::size_t kCapacityBytes = 64 * 1024;
/// A cache line, and more than the vector instructions of libjpeg-turbo ask for.
constexpr std::size_t kAlignmentBytes = 64;

std::size_t RoundUp(std::size_t bytes) {
    return (bytes + kAlignmentBytes - 1) / kAlignmentBytes * kAlignmentBytes;
}

std::size_t BytesToAlignment(const void* address) {
    const auto value = reinterpret_cast<std::uintptr_t>(address);
    return RoundUp(value) - value;
}

}  // namespace

JpegMemory::JpegMemory(jpeg_compress_struct& compressor)
    : jpeg_memory_mgr{},
      compressor_(compressor),
      original_(compressor.mem),
      memory_(kCapacityBytes),
      used_bytes_(BytesToAlignment(memory_.data())) {
    max_alloc_chunk = static_cast<long>(kCapacityBytes);
    ServeBlocks();
    RefuseArrays();
    compressor_.mem = this;
}

JpegMemory::~JpegMemory() {
    compressor_.mem = original_;
}

JpegMemory& JpegMemory::Of(j_common_ptr compressor) {
    return static_cast<JpegMemory&>(*compressor->mem);
}

void* JpegMemory::Take(j_common_ptr compressor, int pool, std::size_t bytes) {
    JpegMemory& self = Of(compressor);
    HV_EXPECT(pool == JPOOL_IMAGE);
    HV_EXPECT(bytes <= self.memory_.size() - self.used_bytes_);
    void* const block = self.memory_.data() + self.used_bytes_;
    self.used_bytes_ += RoundUp(bytes);
    return block;
}

void JpegMemory::ServeBlocks() {
    alloc_small = Take;
    alloc_large = Take;
    free_pool = [](j_common_ptr compressor, int) {
        JpegMemory& self = Of(compressor);
        self.used_bytes_ = BytesToAlignment(self.memory_.data());
    };
    realize_virt_arrays = [](j_common_ptr) {};
}

void JpegMemory::RefuseArrays() {
    alloc_sarray = [](j_common_ptr, int, JDIMENSION, JDIMENSION) -> JSAMPARRAY { std::abort(); };
    alloc_barray = [](j_common_ptr, int, JDIMENSION, JDIMENSION) -> JBLOCKARRAY { std::abort(); };
    request_virt_sarray = [](j_common_ptr, int, boolean, JDIMENSION, JDIMENSION,
                             JDIMENSION) -> jvirt_sarray_ptr { std::abort(); };
    request_virt_barray = [](j_common_ptr, int, boolean, JDIMENSION, JDIMENSION,
                             JDIMENSION) -> jvirt_barray_ptr { std::abort(); };
    access_virt_sarray = [](j_common_ptr, jvirt_sarray_ptr, JDIMENSION, JDIMENSION,
                            boolean) -> JSAMPARRAY { std::abort(); };
    access_virt_barray = [](j_common_ptr, jvirt_barray_ptr, JDIMENSION, JDIMENSION,
                            boolean) -> JBLOCKARRAY { std::abort(); };
    self_destruct = [](j_common_ptr) { std::abort(); };
}

}  // namespace hitchview::app

#pragma once

#include <cstdint>
#include <span>

namespace hitchview::drivers {

/// How fast the processor reads a memory, in GB/s (1e9 bytes): the better of two passes over all of
/// it. A buffer that the processor may not cache reads at a hundredth of an ordinary one, and a
/// camera that fills such is too slow to be rendered from. 0: nothing to read.
double ReadBandwidth(std::span<const std::uint8_t> memory);

/// The same of as many bytes of ordinary memory. Takes them from the heap.
double OrdinaryReadBandwidth(std::size_t bytes);

}  // namespace hitchview::drivers

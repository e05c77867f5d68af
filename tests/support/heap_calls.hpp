#pragma once

#include <cstdint>

namespace hitchview::tests {

/// False in builds with a sanitizer, which brings its own malloc.
#ifdef HITCHVIEW_SANITIZED
inline constexpr bool kHeapCallsAreCounted = false;
#else
inline constexpr bool kHeapCallsAreCounted = true;
#endif

/// How often this thread has asked for heap memory since it started: malloc, calloc, realloc,
/// aligned_alloc, posix_memalign and operator new, also inside libraries. An executable counts when
/// heap_calls.cpp is one of its sources.
std::uint64_t HeapCallsOfThisThread();

}  // namespace hitchview::tests

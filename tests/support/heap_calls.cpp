#include "tests/support/heap_calls.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdlib>

namespace {

thread_local std::uint64_t heap_calls = 0;

}  // namespace

namespace hitchview::tests {

std::uint64_t HeapCallsOfThisThread() {
    return heap_calls;
}

}  // namespace hitchview::tests

#ifndef HITCHVIEW_SANITIZED

// glibc's own names of what is replaced below. operator new calls malloc.
extern "C" {

void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* block, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

void* malloc(std::size_t bytes) {
    ++heap_calls;
    return __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) {
    ++heap_calls;
    return __libc_calloc(count, bytes);
}

void* realloc(void* block, std::size_t bytes) {
    ++heap_calls;
    return __libc_realloc(block, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
    ++heap_calls;
    return __libc_memalign(alignment, bytes);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) {
    ++heap_calls;
    *block = __libc_memalign(alignment, bytes);
    return *block == nullptr ? ENOMEM : 0;
}

}  // extern "C"

#endif

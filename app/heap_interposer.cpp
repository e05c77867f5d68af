#include <cerrno>
#include <cstddef>

#include "app/heap_calls.hpp"

// Stands in for glibc's malloc and its kin in an executable that has this file among its sources,
// so that the calls of every library are seen, operator new's among them. free is glibc's own.
#ifndef HITCHVIEW_SANITIZED

using hitchview::app::NoteHeapCall;

extern "C" {

// glibc's own names of what is replaced below.
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* block, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void* __libc_valloc(std::size_t bytes);
void* __libc_pvalloc(std::size_t bytes);

void* malloc(std::size_t bytes) {
    NoteHeapCall();
    return __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) {
    NoteHeapCall();
    return __libc_calloc(count, bytes);
}

void* realloc(void* block, std::size_t bytes) {
    NoteHeapCall();
    return __libc_realloc(block, bytes);
}

void* memalign(std::size_t alignment, std::size_t bytes) {
    NoteHeapCall();
    return __libc_memalign(alignment, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
    NoteHeapCall();
    return __libc_memalign(alignment, bytes);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) {
    NoteHeapCall();
    void* const taken = __libc_memalign(alignment, bytes);
    if (taken == nullptr) return ENOMEM;
    *block = taken;
    return 0;
}

void* valloc(std::size_t bytes) {
    NoteHeapCall();
    return __libc_valloc(bytes);
}

void* pvalloc(std::size_t bytes) {
    NoteHeapCall();
    return __libc_pvalloc(bytes);
}

}  // extern "C"

#endif

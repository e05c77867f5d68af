#include "drivers/v4l2_kernel.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace hitchview::drivers {
namespace {

class RealKernel final : public V4l2Kernel {
 public:
    int Open(const char* path, int flags) override { return open(path, flags); }
    int Close(int file) override { return close(file); }
    int Ioctl(int file, unsigned long request, void* argument) override {
        int answer = 0;
        do {
            answer = ioctl(file, request, argument);
        } while (answer < 0 && errno == EINTR);
        return answer;
    }
    void* Map(int file, std::size_t bytes, off_t offset) override {
        return mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, offset);
    }
    int Unmap(void* address, std::size_t bytes) override { return munmap(address, bytes); }
    int Poll(std::span<pollfd> files, std::chrono::milliseconds timeout) override {
        const int ready = poll(files.data(), files.size(), static_cast<int>(timeout.count()));
        return ready < 0 && errno == EINTR ? 0 : ready;
    }
};

}  // namespace

std::string ToString(const V4l2Failure& failure) {
    std::string text = failure.call;
    if (failure.error_number != 0) text += std::string(": ") + std::strerror(failure.error_number);
    return text;
}

V4l2Kernel& SystemKernel() {
    static RealKernel kernel;
    return kernel;
}

}  // namespace hitchview::drivers

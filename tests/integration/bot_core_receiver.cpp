// A display unit written by somebody else: receives bot_core.image_t over LCM with nothing of
// Hitchview but the type's description, and judges what arrives.

#include <turbojpeg.h>

#include <algorithm>
#include <bot_core/image_t.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <string>
#include <vector>

namespace {

using bot_core::image_t;
using Clock = std::chrono::steady_clock;

std::optional<std::uint32_t> Sequence(const image_t& image) {
    for (const bot_core::image_metadata_t& property : image.metadata) {
        if (property.key != "sequence") continue;
        const std::string text(property.value.begin(), property.value.end());
        return static_cast<std::uint32_t>(std::strtoul(text.c_str(), nullptr, 10));
    }
    return std::nullopt;
}

class JpegCheck {
 public:
    JpegCheck() : decoder_(tjInitDecompress()) {}
    ~JpegCheck() { tjDestroy(decoder_); }
    JpegCheck(const JpegCheck&) = delete;
    JpegCheck& operator=(const JpegCheck&) = delete;

    /// The data is a whole JPEG of the stated size.
    bool Accepts(const image_t& image) {
        int width = 0;
        int height = 0;
        int subsampling = 0;
        int colour_space = 0;
        const auto bytes = static_cast<unsigned long>(image.data.size());
        if (image.pixelformat != image_t::PIXEL_FORMAT_MJPEG) return false;
        if (tjDecompressHeader3(decoder_, image.data.data(), bytes, &width, &height, &subsampling,
                                &colour_space) != 0) {
            return false;
        }
        if (width != image.width || height != image.height) return false;
        pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
        return tjDecompress2(decoder_, image.data.data(), bytes, pixels_.data(), width, 0, height,
                             TJPF_RGB, TJFLAG_STOPONWARNING) == 0;
    }

 private:
    tjhandle decoder_;
    std::vector<std::uint8_t> pixels_;
};

class Receiver {
 public:
    void OnImage(const lcm::ReceiveBuffer*, const std::string&, const image_t* image) {
        ++received_;
        const std::optional<std::uint32_t> maybe_sequence = Sequence(*image);
        if (!maybe_sequence || !check_.Accepts(*image)) {
            ++undecodable_;
            return;
        }
        if (maybe_last_) gaps_ += *maybe_sequence - *maybe_last_ - 1;
        maybe_last_ = maybe_sequence;
        newest_ = image->data;
    }

    [[nodiscard]] long received() const { return received_; }
    [[nodiscard]] long undecodable() const { return undecodable_; }
    /// Never sent to us, as the sequence tells or as the expected number tells.
    [[nodiscard]] long Missing(long expected) const {
        return std::max(static_cast<long>(gaps_), expected - received_);
    }
    void SaveNewest(const char* path) const {
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(newest_.data()),
                   static_cast<std::streamsize>(newest_.size()));
    }

 private:
    JpegCheck check_;
    long received_ = 0;
    long undecodable_ = 0;
    std::uint32_t gaps_ = 0;
    std::optional<std::uint32_t> maybe_last_;
    std::vector<std::uint8_t> newest_;
};

/// The kernel's usual receive buffer is too small for images.
std::string WithReceiveBuffer(const std::string& url) {
    const char* const separator = url.find('?') == std::string::npos ? "?" : "&";
    return url + separator + "recv_buf_size=16777216";
}

void ReceiveUntil(lcm::LCM& lcm, const Receiver& receiver, long expected, Clock::time_point end) {
    while (receiver.received() < expected && Clock::now() < end) lcm.handleTimeout(50);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 5 && argc != 6) {
        std::fprintf(stderr, "usage: %s URL CHANNEL FRAMES TIMEOUT_S [SAVE.jpg]\n", argv[0]);
        return 2;
    }
    const long expected = std::atol(argv[3]);
    const auto timeout = std::chrono::seconds(std::atol(argv[4]));
    lcm::LCM lcm(WithReceiveBuffer(argv[1]));
    if (!lcm.good()) return 3;
    Receiver receiver;
    lcm.subscribe(argv[2], &Receiver::OnImage, &receiver)->setQueueCapacity(0);
    std::puts("ready");
    std::fflush(stdout);

    ReceiveUntil(lcm, receiver, expected, Clock::now() + timeout);
    const long missing = receiver.Missing(expected);
    std::printf("received %ld missing %ld undecodable %ld\n", receiver.received(), missing,
                receiver.undecodable());
    if (argc == 6) receiver.SaveNewest(argv[5]);
    return receiver.received() == expected && missing == 0 && receiver.undecodable() == 0 ? 0 : 1;
}

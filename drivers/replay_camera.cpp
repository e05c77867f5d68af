#include "drivers/replay_camera.hpp"

#include <pthread.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <future>
#include <optional>
#include <system_error>

namespace hitchview::drivers {
namespace {

constexpr double kDefaultRateHz = 30;

hal::Checked<std::unique_ptr<ReplaySource>> OpenSource(const std::string& path) {
    std::error_code error;
    const bool images =
        path.find('%') != std::string::npos || std::filesystem::is_directory(path, error);
    return images ? OpenImageSource(path) : OpenVideoSource(path);
}

void NameThisThread(const std::string& name) {
    constexpr std::size_t kLongestName = 15;
    pthread_setname_np(pthread_self(), name.substr(0, kLongestName).c_str());
}

hal::Instant MomentOf(std::uint32_t sequence, double rate_hz) {
    return hal::Instant(std::llround(1e9 * sequence / rate_hz));
}

}  // namespace

hal::Checked<std::unique_ptr<ReplayCamera>> ReplayCamera::Open(const std::string& path,
                                                               const ReplayCameraOptions& options) {
    HV_EXPECT(options.slots >= 4 && options.slots <= 64 && options.rate_hz >= 0);
    std::unique_ptr<ReplayCamera> camera(new ReplayCamera(options));
    if (const auto started = camera->Start(path); !started) return started.error();
    return camera;
}

ReplayCamera::ReplayCamera(const ReplayCameraOptions& options) : options_(options) {}

ReplayCamera::~ReplayCamera() {
    free_.Close();
    decoded_.Close();
    if (thread_.joinable()) thread_.join();
}

// The file is opened on the decoder's thread: threads that the decoder starts bear its name.
hal::Checked<hal::Done> ReplayCamera::Start(const std::string& path) {
    std::promise<hal::Checked<hal::Done>> opened;
    std::future<hal::Checked<hal::Done>> outcome = opened.get_future();
    thread_ = std::thread([this, path, opened = std::move(opened)]() mutable {
        NameThisThread("src-" + options_.name);
        auto source = OpenSource(path);
        if (!source) return opened.set_value(source.error());
        TakeMemory(**source);
        opened.set_value(hal::Done{});
        Decode(**source);
    });
    return outcome.get();
}

void ReplayCamera::TakeMemory(const ReplaySource& source) {
    rate_hz_ = options_.rate_hz > 0   ? options_.rate_hz
               : source.rate_hz() > 0 ? source.rate_hz()
                                      : kDefaultRateHz;
    pool_ = std::make_unique<hal::FramePool>(source.format(), options_.slots);
    while (const auto maybe_slot = pool_->Take()) slots_.push_back(*maybe_slot);
    for (const hal::FramePool::Slot& slot : slots_) free_.Append(slot);
}

void ReplayCamera::Decode(ReplaySource& source) {
    std::uint32_t sequence = 0;
    while (const auto maybe_slot = free_.Take()) {
        const hal::Result<hal::Done> outcome = source.Read(maybe_slot->bytes);
        if (!outcome && outcome.error() == hal::Error::kEndOfStream) break;
        const hal::FrameHeader header{sequence, MomentOf(sequence, rate_hz_)};
        if (!decoded_.Append({*maybe_slot, header, outcome})) break;
        ++sequence;
    }
    decoded_.Close();
}

hal::Result<hal::FrameLease> ReplayCamera::DoWaitFrame(std::chrono::milliseconds timeout) {
    const std::optional<Decoded> maybe_frame = decoded_.TakeFor(timeout);
    if (!maybe_frame) {
        return decoded_.finished() ? hal::Error::kEndOfStream : hal::Error::kTimeout;
    }
    if (!maybe_frame->outcome) {
        free_.Append(maybe_frame->slot);
        return maybe_frame->outcome.error();
    }
    const hal::FramePool::Slot& slot = maybe_frame->slot;
    return hal::FrameLease(*this, slot.index,
                           {pool_->format(), maybe_frame->header,
                            hal::PackedPlanes(pool_->format(), slot.bytes.data())});
}

// The ring is larger than the pool; what it keeps free, nobody has.
hal::PoolLevel ReplayCamera::DoPool() const {
    return {options_.slots, std::min(options_.slots, free_.low_water())};
}

void ReplayCamera::DoReturn(int slot) {
    const auto index = static_cast<std::size_t>(slot);
    HV_EXPECT(index < slots_.size() && slots_[index].index == slot);
    free_.Append(slots_[index]);
}

}  // namespace hitchview::drivers

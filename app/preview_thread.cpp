#include "app/preview_thread.hpp"

#include <algorithm>
#include <utility>

#include "app/thread_schedule.hpp"

namespace hitchview::app {
namespace {

/// Of one preview.
constexpr int kLargestBytes = 20'000;
constexpr int kQuality = 75;

}  // namespace

PreviewThread::PreviewThread(const PreviewOptions& options)
    : options_(options),
      reduced_(hal::FrameBytes(kPreviewFormat)),
      encoder_(kPreviewFormat, {.budget_bytes = kLargestBytes, .highest_quality = kQuality}) {
    for (const algo::Unit unit : algo::kUnits) {
        for (const std::string& name : options.cameras[unit])
            channels_.push_back(ChannelOf("PREVIEW_", name));
    }
    HV_EXPECT(channels_.size() <= made_.size());
    jpegs_.assign(channels_.size(), std::vector<std::uint8_t>(kLargestBytes));
    thread_ = std::thread([this] { Work(); });
}

PreviewThread::~PreviewThread() {
    Finish();
}

void PreviewThread::Finish() {
    if (!thread_.joinable()) return;
    stop_ = true;
    state_ = kStopped;
    state_.notify_one();
    thread_.join();
    set_ = FrameSet{};
}

void PreviewThread::Give(FrameSet&& set, hal::Instant start, hal::Instant now) {
    set_ = std::move(set);
    start_ = start;
    next_at_ = now + options_.period;
    state_.store(kGiven, std::memory_order_release);
    state_.notify_one();
}

std::span<const hal::PreviewImage> PreviewThread::Take() const {
    if (state_.load(std::memory_order_acquire) != kMade) return {};
    return std::span(made_).first(made_count_);
}

void PreviewThread::Done() {
    int made = kMade;
    state_.compare_exchange_strong(made, kIdle);
}

void PreviewThread::Work() {
    NameThisThread("preview");
    while (!stop_) {
        const int state = state_.load(std::memory_order_acquire);
        if (state != kGiven) {
            state_.wait(state);
            continue;
        }
        MakePreviews();
        int given = kGiven;
        // Without a frame there is nothing to be taken.
        state_.compare_exchange_strong(given, made_count_ > 0 ? kMade : kIdle);
    }
}

void PreviewThread::MakePreviews() {
    made_count_ = 0;
    std::size_t camera = 0;
    for (const algo::Unit unit : algo::kUnits) {
        for (std::size_t i = 0; i < options_.cameras[unit].size(); ++i)
            MakePreview(set_.leases[unit][i], camera++);
    }
    set_ = FrameSet{};
}

void PreviewThread::MakePreview(const hal::FrameLease& lease, std::size_t camera) {
    if (!lease) return;
    ReduceToPreview(lease.view(), reduced_);
    const auto jpeg =
        encoder_.Encode({kPreviewFormat, {}, hal::PackedPlanes(kPreviewFormat, reduced_.data())});
    if (!jpeg) return;
    std::ranges::copy(jpeg.value(), jpegs_[camera].begin());
    made_[made_count_++] = {.channel = channels_[camera].c_str(),
                            .sequence = set_.sequence,
                            .captured_at = start_ + lease.view().header.captured_at,
                            .width_px = kPreviewWidth_px,
                            .height_px = kPreviewHeight_px,
                            .jpeg = std::span(jpegs_[camera]).first(jpeg.value().size())};
}

}  // namespace hitchview::app

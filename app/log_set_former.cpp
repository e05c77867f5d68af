#include "app/log_set_former.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hal/expect.hpp"

namespace hitchview::app {

using hal::Instant;

LogSetFormer::LogSetFormer(std::size_t cameras, Instant period, Instant tolerance)
    : period_(period), rule_(period, tolerance), cameras_(cameras) {
    HV_EXPECT(cameras <= kMaxCameras);
}

void LogSetFormer::Add(const LoggedFrame& frame) {
    Camera& camera = cameras_[frame.camera];
    const Instant at = frame.header.captured_at;
    if (camera.newest && at <= *camera.newest) return;
    const auto after = std::ranges::lower_bound(
        camera.early, at, {}, [](const LoggedFrame& f) { return f.header.captured_at; });
    if (after != camera.early.end() && after->header.captured_at == at) return;
    camera.early.insert(after, frame);
    newest_read_ = std::max(newest_read_, at);
    const Instant disorder = std::max(kDisorder, 3 * period_);
    for (Camera* first = Earliest(); first != nullptr; first = Earliest()) {
        const bool due = first->early.front().header.captured_at <= newest_read_ - disorder;
        if (!due && !IsFull()) break;
        Release(*first);
    }
}

void LogSetFormer::Finish() {
    for (Camera* first = Earliest(); first != nullptr; first = Earliest()) Release(*first);
    while (HasPending()) Judge(std::max(ask_again_at_, now_ + period_));
}

std::optional<LoggedSet> LogSetFormer::Take() {
    if (sets_.empty()) return std::nullopt;
    const LoggedSet set = sets_.front();
    sets_.pop_front();
    return set;
}

LogSetFormer::Camera* LogSetFormer::Earliest() {
    Camera* earliest = nullptr;
    Instant at{};
    for (Camera& camera : cameras_) {
        if (camera.early.empty()) continue;
        const Instant first = camera.early.front().header.captured_at;
        if (earliest != nullptr && first >= at) continue;
        earliest = &camera;
        at = first;
    }
    return earliest;
}

bool LogSetFormer::IsFull() const {
    return std::ranges::any_of(cameras_,
                               [](const Camera& c) { return c.early.size() > kMostEarly; });
}

/// The camera's first frame comes, at the moment of its capture.
void LogSetFormer::Release(Camera& camera) {
    const LoggedFrame frame = camera.early.front();
    const Instant at = frame.header.captured_at;
    while (HasPending() && ask_again_at_ > now_ && ask_again_at_ <= at) Judge(ask_again_at_);
    camera.early.pop_front();
    camera.newest = at;
    auto& [head, next] = camera.pending;
    if (head && next) head = std::exchange(next, std::nullopt);
    (head ? next : head) = frame;
    Judge(std::max(now_, at));
}

void LogSetFormer::Judge(Instant now) {
    now_ = now;
    while (HasPending()) {
        const SetRule::Verdict verdict = rule_.Judge(Pending(), now);
        Drop(verdict.set_aside);
        if (verdict.taken.any()) Make(verdict.taken);
        ask_again_at_ = verdict.ask_again_at;
        if (verdict.taken.none() && verdict.set_aside.none()) return;
    }
}

PendingFrames LogSetFormer::Pending() const {
    PendingFrames pending;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        const Camera& camera = cameras_[i];
        const auto& [head, next] = camera.pending;
        if (head) pending.heads[i] = head->header.captured_at;
        pending.followed[i] = next.has_value();
        pending.awaited[i] =
            head.has_value() ||
            (!camera.early.empty() && camera.early.front().header.captured_at < now_ + period_);
    }
    return pending;
}

bool LogSetFormer::HasPending() const {
    return std::ranges::any_of(cameras_, [](const Camera& c) { return c.pending[0].has_value(); });
}

void LogSetFormer::Drop(const CameraMask& heads) {
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        auto& [head, next] = cameras_[i].pending;
        if (heads[i]) head = std::exchange(next, std::nullopt);
    }
}

void LogSetFormer::Make(const CameraMask& heads) {
    LoggedSet set;
    Instant newest = Instant::min();
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        if (!heads[i]) continue;
        set.frames[i] = cameras_[i].pending[0];
        newest = std::max(newest, set.frames[i]->header.captured_at);
    }
    set.sequence = Number(newest);
    sets_.push_back(set);
    Drop(heads);
}

/// As sets of live cameras are numbered: a gap is periods of which the recording has no frame.
std::uint32_t LogSetFormer::Number(Instant moment) {
    if (newest_set_) {
        const double periods = static_cast<double>((moment - *newest_set_).count()) /
                               static_cast<double>(period_.count());
        sequence_ += static_cast<std::uint32_t>(std::max(1L, std::lround(periods)));
    }
    newest_set_ = moment;
    return sequence_;
}

}  // namespace hitchview::app

#include "app/live_frame_synchronizer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hitchview::app {
namespace {

std::uint32_t Mask(const CameraMask& cameras) {
    return static_cast<std::uint32_t>(cameras.to_ulong());
}

}  // namespace

LiveFrameSynchronizer::LiveFrameSynchronizer(std::vector<LiveCamera> cameras, EventQueue& events,
                                             hal::Clock& clock, hal::Instant period,
                                             hal::Instant tolerance)
    : cameras_(std::move(cameras)),
      clock_(clock),
      period_(period),
      rule_(period, tolerance),
      inbox_(cameras_.size(), clock.Now()) {
    HV_EXPECT(cameras_.size() <= kMaxCameras);
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        threads_.push_back(std::make_unique<CaptureThread>(*cameras_[i].camera, cameras_[i].name, i,
                                                           inbox_, events, clock_));
    }
}

LiveFrameSynchronizer::~LiveFrameSynchronizer() {
    Finish();
    inbox_.Close();
}

void LiveFrameSynchronizer::Finish() {
    threads_.clear();
}

void LiveFrameSynchronizer::StartCounting() {
    counts_ = {};
    spread_ = {};
    sequence_ = 0;
}

hal::Result<FrameSet> LiveFrameSynchronizer::DoWaitSet() {
    FrameInbox::Visit visit(inbox_);
    while (true) {
        const hal::Instant now = clock_.Now();
        const SetRule::Verdict verdict = rule_.Judge(visit.Pending(now, kPatience * period_), now);
        visit.SetAside(verdict.set_aside);
        if (verdict.taken.any()) return TakeSet(visit, verdict.taken);
        const hal::Instant empty_at =
            std::max(visit.heard_at() + kPatience * period_, empty_at_ + period_);
        if (now >= empty_at) return EmptySet(visit, now);
        visit.Wait(std::min(verdict.ask_again_at, empty_at) - now);
    }
}

FrameSet LiveFrameSynchronizer::TakeSet(FrameInbox::Visit& visit, const CameraMask& taken) {
    FrameSet set;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        if (!taken[i]) {
            set.cameras_missing |= 1U << i;
            continue;
        }
        set.leases[cameras_[i].unit][cameras_[i].index_in_unit] = visit.Take(i);
    }
    set.FindMoments();
    NoteMissing(visit, set);
    Number(visit, set, set.captured_until);
    ++(set.cameras_missing == 0 ? counts_.complete : counts_.partial);
    spread_.Add(set.captured_until - set.captured_from);
    return set;
}

/// Why cameras are missing.
void LiveFrameSynchronizer::NoteMissing(FrameInbox::Visit& visit, FrameSet& set) {
    const auto refused = visit.TakeRefused();
    set.cameras_gone = Mask(visit.Gone()) & set.cameras_missing;
    set.cameras_late = Mask(refused.late) & set.cameras_missing;
    set.cameras_disordered = Mask(refused.disordered);
}

FrameSet LiveFrameSynchronizer::EmptySet(FrameInbox::Visit& visit, hal::Instant now) {
    empty_at_ = now;
    FrameSet set;
    set.captured_from = set.captured_until = now;
    set.cameras_missing = (1U << cameras_.size()) - 1;
    NoteMissing(visit, set);
    Number(visit, set, now);
    ++counts_.empty;
    return set;
}

/// Sets lie a period apart on average, which the moments of free cameras lead and lag. One that is
/// not there although frames came was skipped; one for which none came was not.
void LiveFrameSynchronizer::Number(const FrameInbox::Visit& visit, FrameSet& set,
                                   hal::Instant moment) {
    constexpr int kFollow = 8;  // sets in which the grid goes most of the way to where they are
    const bool first = counts_.complete + counts_.partial + counts_.empty == 0;
    const double periods =
        static_cast<double>((moment - set_due_).count()) / static_cast<double>(period_.count());
    const auto steps = static_cast<std::uint32_t>(std::max(1L, 1 + std::lround(periods)));
    const std::uint64_t unused = visit.Unused();
    const bool frames_came = unused > std::exchange(unused_, unused);
    if (!first) {
        sequence_ += steps;
        if (frames_came) counts_.skipped += steps - 1;
    }
    set_due_ += steps * period_;
    const hal::Instant off = moment + period_ - set_due_;
    set_due_ += !first && std::abs(off.count()) < period_.count() ? off / kFollow : off;
    set.sequence = sequence_;
}

LiveSummary LiveFrameSynchronizer::Summarise() const {
    LiveSummary summary{counts_, spread_, {}};
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        summary.cameras.push_back({cameras_[i].name, cameras_[i].camera->counts(), inbox_.counts(i),
                                   inbox_.pace(i).period_ms()});
    }
    return summary;
}

}  // namespace hitchview::app

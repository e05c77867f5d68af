#include "app/set_rule.hpp"

#include <algorithm>
#include <span>

namespace hitchview::app {
namespace {

struct Moments {
    std::array<hal::Instant, kMaxCameras> at{};
    std::size_t count = 0;

    [[nodiscard]] hal::Instant newest() const { return at[count - 1]; }
    [[nodiscard]] std::span<const hal::Instant> all() const { return {at.data(), count}; }
};

/// In order of time.
Moments Sorted(const PendingFrames& pending, const CameraMask& cameras) {
    Moments moments;
    for (std::size_t i = 0; i < kMaxCameras; ++i) {
        if (cameras[i]) moments.at[moments.count++] = *pending.heads[i];
    }
    std::sort(moments.at.begin(), moments.at.begin() + static_cast<std::ptrdiff_t>(moments.count));
    return moments;
}

CameraMask Present(const PendingFrames& pending) {
    CameraMask present;
    for (std::size_t i = 0; i < kMaxCameras; ++i) present[i] = pending.heads[i].has_value();
    return present;
}

CameraMask Before(const PendingFrames& pending, hal::Instant moment) {
    CameraMask early;
    for (std::size_t i = 0; i < kMaxCameras; ++i)
        early[i] = pending.heads[i] && *pending.heads[i] < moment;
    return early;
}

/// The time between two neighbours of a row that are furthest apart, and the second of them.
struct Gap {
    hal::Instant width{};
    hal::Instant end{};
};

Gap WidestGap(const Moments& moments) {
    Gap widest;
    for (std::size_t i = 1; i < moments.count; ++i) {
        const hal::Instant width = moments.at[i] - moments.at[i - 1];
        if (width > widest.width) widest = {width, moments.at[i]};
    }
    return widest;
}

/// Where the window of this length with the most moments in it begins; of several the newest.
hal::Instant FullestWindow(const Moments& moments, hal::Instant length) {
    hal::Instant fullest{};
    std::ptrdiff_t most = 0;
    for (const hal::Instant begin : moments.all()) {
        const auto within = std::ranges::count_if(
            moments.all(), [&](hal::Instant at) { return at >= begin && at <= begin + length; });
        if (within >= most) fullest = begin;
        most = std::max(most, within);
    }
    return fullest;
}

SetRule::Verdict SetAside(const CameraMask& cameras, hal::Instant now) {
    SetRule::Verdict verdict;
    verdict.set_aside = cameras;
    verdict.ask_again_at = now;
    return verdict;
}

SetRule::Verdict Wait(hal::Instant until) {
    SetRule::Verdict verdict;
    verdict.ask_again_at = until;
    return verdict;
}

}  // namespace

SetRule::Verdict SetRule::Judge(const PendingFrames& pending, hal::Instant now) {
    const CameraMask present = Present(pending);
    if (present.none()) {
        open_since_.reset();
        return Wait(now + period_);
    }
    if (!open_since_) open_since_ = now;
    if (pending.awaited.any() && (pending.awaited & ~pending.followed).none())
        return SetAside(pending.followed, now);

    const auto [group, behind] = Group(pending);
    if (const CameraMask replaced = behind & pending.followed; replaced.any())
        return SetAside(replaced, now);
    const bool complete = ((pending.awaited & ~present) | behind).none();
    if (complete) return MakeSet(pending, group);
    const hal::Instant patient_until = *open_since_ + 3 * period_ / 2;
    const bool next_one_begins = 2 * (group & pending.followed).count() >= group.count();
    if (!next_one_begins && now < patient_until) return Wait(patient_until);
    if (behind.any()) sets_without_regrouping_ = kSetsWithoutRegrouping;
    return MakeSet(pending, group | behind);
}

/// The next frames of those before the widest gap come a period later, so after all others: they
/// make a set that spans the period less the gap.
SetRule::Grouping SetRule::Group(const PendingFrames& pending) const {
    const CameraMask present = Present(pending);
    const Moments moments = Sorted(pending, present);
    const hal::Instant spread = moments.newest() - moments.at[0];
    const Gap gap = WidestGap(moments);
    if (period_ - gap.width >= spread - period_ / 8) return {present, {}};
    const CameraMask early = Before(pending, gap.end);
    const CameraMask late = present & ~early;
    if (early.count() > late.count()) return {early, {}};
    if (sets_without_regrouping_ > 0) return {present, {}};
    return {late, early};
}

SetRule::Verdict SetRule::MakeSet(const PendingFrames& pending, const CameraMask& group) {
    const hal::Instant begin = FullestWindow(Sorted(pending, group), tolerance_);
    const hal::Instant end = begin + tolerance_ + hal::Instant(1);
    Verdict verdict;
    verdict.set_aside = Before(pending, begin) & group;
    verdict.taken = Before(pending, end) & group & ~verdict.set_aside;
    open_since_.reset();
    sets_without_regrouping_ = std::max(0, sets_without_regrouping_ - 1);
    return verdict;
}

}  // namespace hitchview::app

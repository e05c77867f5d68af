#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>

#include "app/config.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// Cameras of a rig, tractor first.
using CameraMask = std::bitset<kMaxCameras>;

/// What sets can be made of. A camera has up to two frames that no set has had: its head and the
/// one after it.
struct PendingFrames {
    std::array<std::optional<hal::Instant>, kMaxCameras> heads{};  ///< moments of capture
    CameraMask followed;  ///< cameras that have a frame after their head
    CameraMask awaited;   ///< connected, and not silent for long: a set waits for these
};

/// Decides which frames of cameras with clocks of their own make a set. A set has at most one frame
/// of each camera, all captured within the tolerance:
///
/// * It is made when every camera that is awaited has a frame; without those that have none when
///   half of the others' next frames have come, or a period and a half after the set's first one.
/// * Where two groups of frames lie so far apart that one of them goes better with frames of the
///   period before or after (the set would be tighter by an eighth of a period), the larger group
///   decides: the set is made without the later frames, which wait for the next one; or it waits
///   for the next frames of the earlier ones. Where those do not come in time, the set is made as
///   it is, and for kSetsWithoutRegrouping sets nothing is waited for in this way.
/// * Of frames that lie further apart than the tolerance, the most that it spans make the set.
///   Earlier ones are set aside, later ones wait for the next set; their cameras are missing.
/// * What nobody had time for is set aside: the heads, once every camera has a frame after it.
///
/// Thread: one.
class SetRule {
 public:
    static constexpr int kSetsWithoutRegrouping = 30;

    /// `period` of the cameras, > 0; `tolerance` in (0, period].
    SetRule(hal::Instant period, hal::Instant tolerance) : period_(period), tolerance_(tolerance) {}

    struct Verdict {
        CameraMask taken;             ///< these heads are a set, if any
        CameraMask set_aside;         ///< these heads are for no set
        hal::Instant ask_again_at{};  ///< nothing changes before, unless a frame comes
    };
    /// `now` does not step back; the same clock as the frames'. Heads that are taken or set aside
    /// are gone when it is asked again.
    Verdict Judge(const PendingFrames& pending, hal::Instant now);

 private:
    /// Frames that go together, and whose next frames would go better with them.
    struct Grouping {
        CameraMask group;
        CameraMask behind;
    };
    [[nodiscard]] Grouping Group(const PendingFrames& pending) const;
    Verdict MakeSet(const PendingFrames& pending, const CameraMask& group);

    hal::Instant period_;
    hal::Instant tolerance_;
    std::optional<hal::Instant> open_since_;  ///< when the first frame of the coming set was seen
    int sets_without_regrouping_ = 0;         ///< still to come
};

}  // namespace hitchview::app

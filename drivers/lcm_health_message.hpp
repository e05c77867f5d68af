#pragma once

#include <array>
#include <cstdint>

#include "hal/health.hpp"
#include "lcmtypes/hitchview_health_t.h"

namespace hitchview::drivers {

/// A hitchview.health_t made of a hal::Health, in memory of its own and borrowing the texts. For
/// LcmEncoder alone.
class LcmHealthMessage {
 public:
    /// `health` must outlive it.
    LcmHealthMessage(const hal::Health& health, std::uint32_t sequence, std::int64_t utime_us);
    LcmHealthMessage(const LcmHealthMessage&) = delete;
    LcmHealthMessage& operator=(const LcmHealthMessage&) = delete;

    [[nodiscard]] const hitchview_health_t& get() const { return message_; }

 private:
    void AddCounts(const hal::Health& health);
    void AddMachine(const hal::Health& health);
    void AddLists(const hal::Health& health);

    std::array<hitchview_camera_health_t, 8> cameras_{};
    std::array<hitchview_stage_time_t, 12> stages_{};
    hitchview_health_t message_{};
};

}  // namespace hitchview::drivers

#pragma once

#include <optional>

#include "hal/event.hpp"

namespace hitchview::app {

/// Largest panorama that subscribers with the kernel's usual receive buffer get whole.
inline constexpr int kUsualBufferImageBytes = 150'000;

/// What the receive buffers of this system mean for panoramas of a size.
struct ReceiveBufferVerdict {
    int granted_bytes = 0;     ///< net.core.rmem_max; 0: not known
    int budget_bytes = 0;      ///< largest panorama that is worth sending
    hal::EventText warning{};  ///< with the remedy; empty when panoramas of the size get through
};

/// A subscriber asks for a buffer, of which the kernel grants at most `granted_bytes` and keeps
/// twice that: room for a message of as many bytes, with what the kernel keeps beside each packet.
/// `cut`: where that is not enough, the budget is what the usual buffer holds.
ReceiveBufferVerdict JudgeReceiveBuffer(int image_bytes, std::optional<int> granted_bytes,
                                        bool cut);

}  // namespace hitchview::app

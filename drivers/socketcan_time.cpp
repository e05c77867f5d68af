#include "drivers/socketcan_time.hpp"

#include <algorithm>

namespace hitchview::drivers {
namespace {

using hal::Instant;

constexpr Instant kWindow = std::chrono::seconds(1);
/// Two stamps of one frame that lie further apart: the controller's clock was set.
constexpr Instant kLongestDelay = std::chrono::seconds(1);

}  // namespace

Instant SocketCanTime::ReceivedAt(const SocketCanStamps& stamps) {
    Instant received_at = FromSoftware(stamps);
    offset_ = stamps.now - stamps.wall_now;
    if (stamps.hardware) received_at = FromHardware(*stamps.hardware, received_at);
    last_ = std::clamp(received_at, std::min(last_, stamps.now), stamps.now);
    return last_;
}

Instant SocketCanTime::FromSoftware(const SocketCanStamps& stamps) const {
    if (!stamps.software) return stamps.now;
    const Instant by_this_offset = *stamps.software + (stamps.now - stamps.wall_now);
    const Instant by_the_one_before = *stamps.software + offset_;
    const auto [earlier, later] = std::minmax(by_this_offset, by_the_one_before);
    return later <= stamps.now ? later : earlier;
}

Instant SocketCanTime::FromHardware(Instant hardware, Instant received_at) {
    const Instant offset = received_at - hardware;
    const Instant known = std::min(this_second_.least_offset, second_before_.least_offset);
    const bool jumped = known != Instant::max() &&
                        (offset < known - kLongestDelay || offset > known + kLongestDelay);
    if (jumped) this_second_ = second_before_ = Window{};
    MeasureDelay(offset, received_at);
    return hardware + std::min(this_second_.least_offset, second_before_.least_offset);
}

void SocketCanTime::MeasureDelay(Instant offset, Instant received_at) {
    if (received_at - this_second_.since >= kWindow) {
        const bool follows = received_at - this_second_.since < 2 * kWindow;
        second_before_ = follows ? this_second_ : Window{};
        this_second_ = {.since = received_at};
    }
    this_second_.least_offset = std::min(this_second_.least_offset, offset);
}

}  // namespace hitchview::drivers

#include "drivers/systemd_notify.hpp"

#include <cmath>
#include <utility>

namespace hitchview::drivers {
namespace {

using StatusText = hal::FixedText<512>;

void AppendTenths(double number, StatusText& text) {
    const auto tenths = static_cast<std::int64_t>(std::llround(10 * number));
    text.AppendNumber(tenths / 10).Append(".").AppendNumber(tenths % 10);
}

/// "29.9 panoramas/s; no data from rear, left"
StatusText StatusOf(const hal::Health& health) {
    StatusText text("STATUS=");
    AppendTenths(health.panoramas_per_s, text);
    text.Append(" panoramas/s");
    const char* before = "; no data from ";
    for (int i = 0; i < health.cameras.count; ++i) {
        const hal::CameraHealth& camera = health.cameras.items[static_cast<std::size_t>(i)];
        if (camera.shown) continue;
        text.Append(std::exchange(before, ", ")).Append(camera.name.view());
    }
    return text;
}

}  // namespace

hal::Checked<std::unique_ptr<hal::Watchdog>> SystemdNotify::Open(const char* address) {
    if (address == nullptr || *address == '\0') return std::unique_ptr<hal::Watchdog>();
    auto socket = SystemdSocket::Open(address);
    if (!socket) return "NOTIFY_SOCKET is " + socket.error();
    return std::unique_ptr<hal::Watchdog>(new SystemdNotify(std::move(*socket)));
}

void SystemdNotify::DoReady() {
    ready_unsent_ = !socket_.Send("READY=1");
}

void SystemdNotify::DoFeed() {
    if (ready_unsent_) DoReady();
    socket_.Send("WATCHDOG=1");
}

void SystemdNotify::DoShow(const hal::Health& health) {
    socket_.Send(StatusOf(health).view());
}

void SystemdNotify::DoStop() {
    socket_.Send("STOPPING=1");
}

}  // namespace hitchview::drivers

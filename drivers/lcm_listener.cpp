#include "drivers/lcm_listener.hpp"

#include <cerrno>
#include <utility>

namespace hitchview::drivers {
namespace {

using hal::Checked;
using hal::Done;
using hal::Error;
using hal::Result;

constexpr int kReceiveBufferBytes = 8 << 20;
/// So that a flood of messages keeps nobody from anything else.
constexpr int kMostAtOnce = 256;

}  // namespace

Checked<std::unique_ptr<LcmListener>> LcmListener::Create(const LcmListenerOptions& options,
                                                          Handler handler) {
    HV_EXPECT(options.max_message_bytes > 0);
    if (auto url = CheckLcmUrl(options.url); !url) return url.error();
    LcmHandle lcm{lcm_create(WithReceiveBuffer(options.url, kReceiveBufferBytes).c_str())};
    if (lcm) {
        return std::unique_ptr<LcmListener>(
            new LcmListener(options, std::move(handler), std::move(lcm)));
    }
    return "LCM cannot use '" + options.url +
           "': is there a route to 224.0.0.0/4 and the flag 'multicast' on its interface?";
}

LcmListener::LcmListener(const LcmListenerOptions& options, Handler handler, LcmHandle lcm)
    : handler_(std::move(handler)),
      max_message_bytes_(static_cast<std::size_t>(options.max_message_bytes)),
      lcm_(std::move(lcm)) {}

bool LcmListener::Subscribe(const std::string& pattern, int queue) {
    const auto handler = [](const lcm_recv_buf_t* message, const char* channel, void* self) {
        static_cast<LcmListener*>(self)->OnMessage(
            channel, {static_cast<const std::uint8_t*>(message->data), message->data_size});
    };
    lcm_subscription_t* const subscription =
        lcm_subscribe(lcm_.get(), pattern.c_str(), handler, this);
    return subscription != nullptr && lcm_subscription_set_queue_capacity(subscription, queue) == 0;
}

Result<Done> LcmListener::TakeAll() {
    for (int i = 0; i < kMostAtOnce; ++i) {
        errno = 0;
        const int handled = lcm_handle_timeout(lcm_.get(), 0);
        if (handled < 0 && errno == EINTR) break;  // by a signal, which may ask to stop
        if (handled < 0) return Error::kFailed;
        if (handled == 0) break;
    }
    return Done{};
}

void LcmListener::OnMessage(std::string_view channel, std::span<const std::uint8_t> message) {
    if (message.size() > max_message_bytes_) {
        ++refused_;
    } else {
        handler_(channel, message);
    }
}

}  // namespace hitchview::drivers

#include "drivers/lcm_self_test.hpp"

#include <vector>

#include "drivers/lcm_handle.hpp"
#include "drivers/lcm_receive_buffer.hpp"
#include "drivers/lcm_url.hpp"

namespace hitchview::drivers {
namespace {

constexpr const char* kChannel = "HITCHVIEW_DOCTOR";
constexpr int kTries = 3;
constexpr int kPatience_ms = 500;

void OnMessage(const lcm_recv_buf_t* message, const char* /*channel*/, void* expected_bytes) {
    auto& bytes = *static_cast<std::size_t*>(expected_bytes);
    if (message->data_size == bytes) bytes = 0;
}

}  // namespace

hal::Checked<hal::Done> SendToSelf(const std::string& url, int bytes) {
    if (auto checked = CheckLcmUrl(url); !checked) return checked;
    const LcmHandle lcm{lcm_create(WithReceiveBuffer(url, SubscriberBufferBytes()).c_str())};
    if (!lcm) return std::string("LCM cannot be opened");
    const std::vector<std::uint8_t> message(static_cast<std::size_t>(bytes), 0x5A);
    std::size_t awaited = message.size();
    if (lcm_subscribe(lcm.get(), kChannel, OnMessage, &awaited) == nullptr)
        return std::string("LCM cannot subscribe");
    for (int i = 0; i < kTries; ++i) {
        if (lcm_publish(lcm.get(), kChannel, message.data(),
                        static_cast<unsigned>(message.size())) != 0)
            return std::string("LCM cannot send");
        lcm_handle_timeout(lcm.get(), kPatience_ms);
        if (awaited == 0) return hal::Done{};
    }
    return std::string("nothing came back");
}

}  // namespace hitchview::drivers

#include "drivers/lcm_subscriber.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "drivers/lcm_camera_names.hpp"
#include "drivers/lcm_image_message.hpp"
#include "drivers/lcm_receive_buffer.hpp"

namespace hitchview::drivers {
namespace {

using hal::Checked;
using hal::Done;
using hal::Error;
using hal::PanoramaImage;
using hal::Result;

constexpr int kSmallestMessageBytes = 1024;
constexpr int kLargestMessageBytes = 64 << 20;

Checked<Done> Check(const LcmSubscriberOptions& options) {
    if (auto url = CheckLcmUrl(options.url); !url) return url;
    if (auto name = CheckLcmChannel("channel", options.channel); !name) return name;
    if (auto name = CheckLcmChannel("health_channel", options.health_channel); !name) return name;
    const int bytes = options.max_message_bytes;
    if (bytes >= kSmallestMessageBytes && bytes <= kLargestMessageBytes) return Done{};
    return "max_message_bytes is " + std::to_string(bytes) + ", must be " +
           std::to_string(kSmallestMessageBytes) + " to " + std::to_string(kLargestMessageBytes);
}

}  // namespace

Checked<std::unique_ptr<LcmSubscriber>> LcmSubscriber::Create(const LcmSubscriberOptions& options) {
    if (auto checked = Check(options); !checked) return checked.error();
    LcmHandle lcm{lcm_create(WithReceiveBuffer(options.url, SubscriberBufferBytes()).c_str())};
    if (lcm) {
        std::unique_ptr<LcmSubscriber> self(new LcmSubscriber(options, std::move(lcm)));
        if (self->Subscribe<&LcmSubscriber::OnMessage>(options.channel, kMostWaiting) &&
            self->Subscribe<&LcmSubscriber::OnHealth>(options.health_channel, 1)) {
            return self;
        }
    }
    return "LCM cannot use '" + options.url +
           "': is there a route to 224.0.0.0/4 and the flag 'multicast' on its interface?";
}

LcmSubscriber::LcmSubscriber(const LcmSubscriberOptions& options, LcmHandle lcm)
    : lcm_(std::move(lcm)),
      live_(IsMulticastUrl(options.url)),
      message_(static_cast<std::size_t>(options.max_message_bytes)) {}

template <LcmSubscriber::Handler kHandler>
bool LcmSubscriber::Subscribe(const std::string& channel, int most_waiting) {
    const auto handler = [](const lcm_recv_buf_t* message, const char*, void* self) {
        (static_cast<LcmSubscriber*>(self)->*kHandler)(
            {static_cast<const std::uint8_t*>(message->data), message->data_size});
    };
    lcm_subscription_t* const subscription =
        lcm_subscribe(lcm_.get(), channel.c_str(), handler, this);
    return subscription != nullptr &&
           lcm_subscription_set_queue_capacity(subscription, most_waiting) == 0;
}

Result<PanoramaImage> LcmSubscriber::WaitImage(std::chrono::milliseconds timeout) {
    HV_EXPECT(timeout.count() >= 0);
    image_ = Error::kTimeout;
    errno = 0;
    const int handled = lcm_handle_timeout(lcm_.get(), static_cast<int>(timeout.count()));
    if (handled < 0 && errno != EINTR) return Error::kFailed;
    for (int i = 0; live_ && i < kMostWaiting && lcm_handle_timeout(lcm_.get(), 0) > 0; ++i) {
    }
    return image_;
}

void LcmSubscriber::OnMessage(std::span<const std::uint8_t> message) {
    Result<PanoramaImage> image = Error::kTooLarge;
    if (message.size() <= message_.size()) image = ParseImageMessage(message);
    ++(image ? received_ : refused_);
    if (image) {
        std::copy(message.begin(), message.end(), message_.begin());
        image_ = ParseImageMessage({message_.data(), message.size()});
    } else if (!image_) {
        image_ = image;
    }
}

void LcmSubscriber::OnHealth(std::span<const std::uint8_t> message) {
    auto names = ParseCameraNames(message);
    if (names) {
        camera_names_ = std::move(*names);
    } else {
        ++refused_;
    }
}

}  // namespace hitchview::drivers

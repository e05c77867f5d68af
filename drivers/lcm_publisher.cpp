#include "drivers/lcm_publisher.hpp"

namespace hitchview::drivers {

using hal::Checked;
using hal::Done;
using hal::Error;
using hal::Result;

Checked<std::unique_ptr<LcmPublisher>> LcmPublisher::Create(const LcmPublisherOptions& options,
                                                            const hal::Clock& clock) {
    if (auto url = CheckLcmUrl(options.url); !url) return url.error();
    auto encoder = LcmEncoder::Create(options.messages, clock);
    if (!encoder) return encoder.error();
    LcmHandle lcm{lcm_create(options.url.c_str())};
    if (!lcm) {
        return "LCM cannot use '" + options.url +
               "': is there a route to 224.0.0.0/4 and the flag 'multicast' on its interface?";
    }
    // liblcm makes its lock, and a log file its buffer, with the first message.
    if (lcm_publish(lcm.get(), kLcmStartChannel, "", 0) != 0)
        return "LCM cannot send to '" + options.url + "'";
    return std::unique_ptr<LcmPublisher>(new LcmPublisher(std::move(*encoder), std::move(lcm)));
}

Result<Done> LcmPublisher::Send(const Result<LcmMessage>& message) {
    if (!message) return message.error();
    const int status =
        lcm_publish(lcm_.get(), message.value().channel, message.value().bytes.data(),
                    static_cast<unsigned>(message.value().bytes.size()));
    if (status != 0) return Error::kFailed;
    return Done{};
}

}  // namespace hitchview::drivers

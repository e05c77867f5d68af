#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "drivers/lcm_handle.hpp"
#include "drivers/lcm_url.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

struct LcmListenerOptions {
    std::string url = kDefaultLcmUrl;
    int max_message_bytes = 4 << 20;  ///< larger ones are refused unread
};

/// Hears several channels. Nothing is sent and no message is trusted: the handler gets the bytes as
/// they came. Thread: the one that calls TakeAll.
class LcmListener {
 public:
    /// The bytes are borrowed for the call.
    using Handler =
        std::function<void(std::string_view channel, std::span<const std::uint8_t> message)>;

    static hal::Checked<std::unique_ptr<LcmListener>> Create(const LcmListenerOptions& options,
                                                             Handler handler);

    /// `pattern`: a channel, or the start of several followed by `.*`. At most `queue` messages
    /// wait in it, the newest; 1 for what is of interest as its newest only. False: LCM refused.
    bool Subscribe(const std::string& pattern, int queue);

    /// Readable while messages wait.
    [[nodiscard]] int descriptor() const { return lcm_get_fileno(lcm_.get()); }

    /// Hands over what waits, at most some hundred messages; never blocks. kFailed: LCM gave up.
    hal::Result<hal::Done> TakeAll();

    [[nodiscard]] std::uint64_t refused() const { return refused_; }  ///< too large, since start

 private:
    LcmListener(const LcmListenerOptions& options, Handler handler, LcmHandle lcm);

    void OnMessage(std::string_view channel, std::span<const std::uint8_t> message);

    Handler handler_;
    std::size_t max_message_bytes_;
    LcmHandle lcm_;
    std::uint64_t refused_ = 0;
};

}  // namespace hitchview::drivers

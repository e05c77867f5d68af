#pragma once

#include <string>

#include "hal/result.hpp"

namespace hitchview::drivers {

/// Sends one message of so many bytes on the channel HITCHVIEW_DOCTOR and waits at most half a
/// second for it to come back, as it would come to a subscriber on this machine that asks for a
/// large receive buffer. Tried three times. The error says what did not happen.
hal::Checked<hal::Done> SendToSelf(const std::string& url, int bytes);

}  // namespace hitchview::drivers

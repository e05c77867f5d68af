#pragma once

#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace hitchview::drivers {

/// Stays on this computer; display units on the vehicle's network need ttl=1.
inline constexpr const char* kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";

/// Says what is wrong with an LCM URL before LCM, which takes some mistakes silently, sees it.
/// Schemes udpm and mpudpm: multicast address (224.0.0.0 to 239.255.255.255), port [1, 65535], and
/// the options ttl [0, 255], recv_buf_size [4096, 268435456] bytes and transmit_only (true or
/// false). Schemes file, memq and tcpq are left to LCM.
hal::Checked<hal::Done> CheckLcmUrl(std::string_view url);

/// Whether messages are sent to a network rather than written to a file or handed on.
bool IsMulticastUrl(std::string_view url);

/// An LCM channel: 1 to 63 characters of A-Z, a-z, 0-9 and '_', so that it is its own pattern.
hal::Checked<hal::Done> CheckLcmChannel(std::string_view key, std::string_view channel);

/// The URL with `recv_buf_size` for a multicast scheme, unless it says one already. With the
/// kernel's own size, messages above some 200 kB are lost.
std::string WithReceiveBuffer(const std::string& url, int bytes);

}  // namespace hitchview::drivers

#pragma once

#include <string>

#include "hal/result.hpp"

namespace hitchview::app {

struct ListeningSocket {
    int descriptor = -1;
    int port = 0;
};

/// A TCP socket that listens at an IPv4 or IPv6 address; port 0: one that is free. What it sends to
/// a client that does not read is kept in some hundred kilobytes of the kernel's memory.
hal::Checked<ListeningSocket> Listen(const std::string& address, int port);

bool IsLoopback(const std::string& address);

}  // namespace hitchview::app

#pragma once

#include <cstddef>
#include <cstdint>

/// What libFuzzer calls: the first byte chooses a channel of the page, the rest is a message on it;
/// then what a client is told must be one line of JSON in UTF-8. The bytes are also read as parts
/// of a request. Aborts where a promise is broken. Returns 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

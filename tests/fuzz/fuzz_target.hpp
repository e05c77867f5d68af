#pragma once

#include <cstddef>
#include <cstdint>

/// What a fuzz target is: looks into the bytes and aborts where a promise is broken. Returns 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

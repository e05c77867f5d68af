#pragma once

#include <cstddef>
#include <cstdint>

/// What libFuzzer calls: reads the bytes as every message that a display unit subscribes to. Aborts
/// where a promise of a parser is broken. Returns 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

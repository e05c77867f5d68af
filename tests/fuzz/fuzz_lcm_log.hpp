#pragma once

#include <cstddef>
#include <cstdint>

/// What libFuzzer calls: reads the bytes as an LCM log and every event in it as every message that
/// Hitchview knows, and decodes its pictures. Aborts where a promise of the reader is broken.
/// Returns 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

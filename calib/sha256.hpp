#pragma once

#include <string>
#include <string_view>

namespace hitchview::calib {

/// SHA-256 of `bytes` (FIPS 180-4) as 64 lower-case hexadecimal digits. It names content; it is no
/// protection against a forger. Thread-safe.
std::string Sha256(std::string_view bytes);

}  // namespace hitchview::calib

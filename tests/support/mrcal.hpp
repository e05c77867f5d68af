#pragma once

#include <cstdlib>
#include <string>

namespace hitchview::tests {

/// Debian's mrcal is for Debian's Python.
inline int RunMrcalPython(const std::string& arguments) {
    return std::system(("/usr/bin/python3 " + arguments + " >/dev/null 2>&1").c_str());
}

inline bool HasMrcal() {
    static const bool kHas = RunMrcalPython("-c 'import mrcal'") == 0;
    return kHas;
}

}  // namespace hitchview::tests

#pragma once

#include <algorithm>

namespace hitchview::algo {

/// 0 up to t = 0, 1 from t = 1, without a kink in between.
inline double SmoothStep(double t) {
    const double s = std::clamp(t, 0.0, 1.0);
    return s * s * (3 - 2 * s);
}

}  // namespace hitchview::algo

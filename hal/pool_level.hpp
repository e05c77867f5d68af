#pragma once

namespace hitchview::hal {

/// How close a bounded store came to running dry.
struct PoolLevel {
    int slots = 0;      ///< 0: not known
    int low_water = 0;  ///< fewest slots that were ever free
};

}  // namespace hitchview::hal

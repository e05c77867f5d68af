#pragma once

#include <string>
#include <vector>

#include "app/log_figures.hpp"

namespace hitchview::app {

/// Whether a recording can be relied on.
struct LogVerdict {
    std::vector<std::string> reasons;  ///< against it; none: it is good
    std::vector<std::string> notes;    ///< worth knowing

    [[nodiscard]] bool good() const { return reasons.empty(); }
};

/// What a good recording may have at most.
struct LogLimits {
    double lost_share = 0.001;       ///< of a camera's frames
    double incomplete_share = 0.01;  ///< of the frame sets
    double spread_periods = 0.5;     ///< of a frame set, for 99 of 100
    double drift_ppm = 200;          ///< of a camera's clock: two frames an hour at 30 Hz
    double lost_panorama_share = 0.01;
};

LogVerdict Judge(const LogFigures& figures, const LogLimits& limits = {});

}  // namespace hitchview::app

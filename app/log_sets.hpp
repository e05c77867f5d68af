#pragma once

#include <vector>

#include "app/log_figures.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// Puts the frames of the cameras together by time: to each of the camera with most frames the
/// nearest one of every other, within half a period. `times`: of each camera; `period_ms` > 0.
SetFigures MeasureSets(const std::vector<std::vector<hal::Instant>>& times, double period_ms);

}  // namespace hitchview::app

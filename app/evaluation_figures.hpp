#pragma once

#include <nlohmann/json.hpp>

#include "app/evaluation_coverage.hpp"
#include "app/evaluation_path.hpp"
#include "app/evaluation_seam.hpp"
#include "app/evaluation_view.hpp"

namespace hitchview::app {

/// The meters of one unit; a path of no frames is a video that there is not.
struct UnitMeters {
    PathMeter in;
    PathMeter out;
    ViewMeter view;
    double rate_hz = 30;
};

/// Figures of the finished meters as JSON objects; the keys are listed at `Evaluate`. What is not
/// known is null.
nlohmann::json UnitFigures(const UnitMeters& meters);
nlohmann::json SeamFigures(const SeamMeter& meter);
nlohmann::json PanoramaFigures(const PathMeter& path, const CoverageMeter& coverage);

/// The same over time: JSON objects of arrays of one length each.
nlohmann::json UnitSeries(const UnitMeters& meters);
nlohmann::json SeamSeries(const SeamMeter& meter);
nlohmann::json CoverageSeries(const CoverageMeter& coverage);

}  // namespace hitchview::app

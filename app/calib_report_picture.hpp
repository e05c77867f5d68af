#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// Figures that lie over the picture of one camera, as HTML with drawings.
namespace hitchview::app {

struct PictureSize {
    double width_px = 0;
    double height_px = 0;
};

/// Corners in each cell of the picture. `cells`: rows of counts.
std::string CoverageMap(const nlohmann::json& cells, const PictureSize& size);

/// Where a distant point may be off, standard deviation. `places`: [x, y, sigma] each, px, on a
/// grid.
std::string UncertaintyMap(const nlohmann::json& places, const PictureSize& size);

/// From where each corner was seen towards where the lens shows it, exaggerated. `residuals`:
/// [view, x, y, dx, dy] each, px; at most some thousands are drawn.
std::string ResidualMap(const nlohmann::json& residuals, const PictureSize& size);

}  // namespace hitchview::app

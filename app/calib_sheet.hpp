#pragma once

#include <cairo.h>

#include <string>

#include "app/calib_sheet_plan.hpp"

namespace hitchview::app {

/// Length of the bar that tells whether a printer has scaled the sheet.
inline constexpr double kMeasuringBar_mm = 100;

/// Draws pattern, measuring bar, description and the mark that tells where its top is; one user
/// unit is a millimetre.
void DrawSheet(cairo_t* cairo, const SheetPlan& plan);

enum class SheetFormat { kPdf, kSvg };

struct SheetFileContent {
    std::string bytes{};
};

/// The file that prints the sheet at its size. The error says what cairo complains about.
hal::Checked<SheetFileContent> SheetFile(const SheetPlan& plan, SheetFormat format);

}  // namespace hitchview::app

#pragma once

#include <string>

#include "app/evaluation.hpp"

namespace hitchview::app {

/// The measured quality as one HTML document that needs no other file, no network and no script:
/// the published figures beside these, paths and spectra before and after, seam errors, cropping
/// and coverage over time, the worst frames as pictures, what each figure means. What was not
/// measured says so.
std::string HtmlReport(const Quality& quality);

}  // namespace hitchview::app

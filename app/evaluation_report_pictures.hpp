#pragma once

#include <string>

#include "app/evaluation_seam.hpp"
#include "app/evaluation_view.hpp"

namespace hitchview::app {

/// The seam's worst frame: both layers around the overlap and their difference (what only the
/// tractor shows brightly is red, what only the trailer shows is cyan, agreement is grey) with the
/// pairs' offsets drawn, enlarged. HTML. `seam` has pictures.
std::string SeamPictures(const WorstSeam& seam);

/// The view's worst frame: a square grid on the camera's picture, and where the fitted homography
/// puts it on the stabilised one. HTML. `view` has pictures.
std::string ViewPictures(const WorstView& view);

}  // namespace hitchview::app

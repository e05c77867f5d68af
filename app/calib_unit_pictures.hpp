#pragma once

#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "calib/unit_session.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// Files of the pictures of one camera, by shot.
using ShotFiles = std::map<std::string, std::string>;

/// The pictures that a session names.
struct UnitPictures {
    std::vector<ShotFiles> files{};            ///< of each camera
    std::vector<calib::Sighting> sightings{};  ///< by camera, then shot, then target
};

/// Looks for every target of the session in every picture, on all processors, and shows on stderr
/// how far it is. The error names the pattern that fits no file, the picture that cannot be read,
/// the one whose size is not that of its lens, or two of one shot.
hal::Checked<UnitPictures> LookAtUnit(const calib::UnitSession& session);

/// One shot of all cameras. `flags`: of cv::imread. The error names the camera without one, or the
/// picture that cannot be read.
hal::Checked<std::vector<cv::Mat>> ReadShot(const calib::UnitSession& session,
                                            const UnitPictures& pictures, const std::string& shot,
                                            int flags);

}  // namespace hitchview::app

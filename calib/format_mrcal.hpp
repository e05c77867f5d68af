#pragma once

#include "calib/format_lens.hpp"

namespace hitchview::calib {

/// A cameramodel; its frame of reference is taken as it is. `name` is what the camera is called.
std::vector<ForeignCamera> ReadMrcal(YamlMap& root, const ImportHints& hints,
                                     const std::string& name);

/// Why mrcal cannot hold the lens; empty if it can.
std::string MrcalRefusal(const ForeignCamera& camera);

/// `camera` was not refused. Without a place it stands in the frame of reference.
std::string MrcalText(const ForeignCamera& camera);

}  // namespace hitchview::calib

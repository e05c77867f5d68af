#pragma once

#include "calib/format_lens.hpp"

namespace hitchview::calib {

/// OpenCV's FileStorage as its samples and common tools write it: one camera, or the two of a
/// stereo pair (M1 D1 M2 D2, named left and right). `name` is what the one camera is called.
std::vector<ForeignCamera> ReadOpenCv(YamlMap& root, const ImportHints& hints,
                                      const std::string& name);

std::string OpenCvText(const algo::CameraModel& model);

}  // namespace hitchview::calib

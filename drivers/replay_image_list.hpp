#pragma once

#include <string>
#include <vector>

#include "hal/result.hpp"

namespace hitchview::drivers {

/// Files named by a pattern with one `%d` or `%0Nd` in its last part, in order of their numbers.
/// Refused: no such file, a first number other than 0 or 1, a gap. At least one path.
hal::Checked<std::vector<std::string>> ListPattern(const std::string& pattern);

/// Pictures of a folder in natural order of their names: 2.png before 10.png. At least one path.
hal::Checked<std::vector<std::string>> ListFolder(const std::string& folder);

/// The same, of a folder in which are these paths.
hal::Checked<std::vector<std::string>> PickPattern(const std::string& pattern,
                                                   const std::vector<std::string>& paths);
hal::Checked<std::vector<std::string>> PickPictures(const std::string& folder,
                                                    std::vector<std::string> paths);

}  // namespace hitchview::drivers

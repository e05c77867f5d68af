#pragma once

#include <string>
#include <vector>

namespace hitchview::app {

/// Files that a pattern of the shell names, by name.
std::vector<std::string> FilesLike(const std::string& pattern);

}  // namespace hitchview::app

#include "app/file_pattern.hpp"

#include <glob.h>

namespace hitchview::app {

std::vector<std::string> FilesLike(const std::string& pattern) {
    glob_t found{};
    std::vector<std::string> files;
    if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
        files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
    globfree(&found);
    return files;
}

}  // namespace hitchview::app

#pragma once

#include <gtest/gtest.h>

#include <string>

#include "calib/format.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::calib {

/// Imports texts as files.
class FormatTest : public testing::Test {
 protected:
    ForeignCameras Imported(Format format, const std::string& text, const ImportHints& hints = {}) {
        return ImportCameras(format, folder_.Write("lens.txt", text), hints);
    }
    /// Without the folder's name.
    std::string ErrorOf(Format format, const std::string& text, const ImportHints& hints = {}) {
        std::string error = Imported(format, text, hints).error;
        const std::string folder = folder_.path() + '/';
        for (auto at = error.find(folder); at != error.npos; at = error.find(folder))
            error.erase(at, folder.size());
        return error;
    }
    tests::TemporaryFolder folder_;
};

}  // namespace hitchview::calib

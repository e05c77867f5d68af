#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "hal/result.hpp"

namespace hitchview::app {

/// Pictures of a recorded drive as files that `verify` reads: `path()/CAMERA/1.png` and so on, the
/// same number for about the same moment. They go with it.
class DrivePictures {
 public:
    /// Of each camera a few, some seconds apart. Error: the recording cannot be read,
    /// has nothing of a camera, or a file cannot be written.
    static hal::Checked<DrivePictures> Take(const std::vector<std::filesystem::path>& logs,
                                            const std::vector<std::string>& cameras);
    ~DrivePictures();
    DrivePictures(DrivePictures&& other) noexcept;
    DrivePictures& operator=(DrivePictures&&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
    explicit DrivePictures(std::filesystem::path folder) : folder_(std::move(folder)) {}

    std::filesystem::path folder_;  ///< empty: moved from
};

}  // namespace hitchview::app

#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hal/frame.hpp"

namespace hitchview::app {

/// I420, full range, to BGR.
cv::Mat ToBgr(const hal::FrameView& picture);

/// One sheet: the cameras' pictures in two rows, below them the panoramas, each with its caption.
struct DemoSheet {
    std::vector<cv::Mat> cameras;
    struct Panorama {
        std::string caption;
        cv::Mat picture;
    };
    std::vector<Panorama> panoramas;
};

/// Empty on success, otherwise why the file could not be written.
std::string WriteSheet(const DemoSheet& sheet, const std::filesystem::path& file);

}  // namespace hitchview::app

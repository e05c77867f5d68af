#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace hitchview::calib {

/// A tag in a picture.
struct SeenTag {
    int number = 0;
    /// Of its black frame, from its top left clockwise; px, to about half a pixel.
    std::array<Eigen::Vector2d, 4> corners_px{};

    [[nodiscard]] Eigen::Vector2d middle_px() const;
    /// Mean length of its sides.
    [[nodiscard]] double side_px() const;
};

/// The tags of tag36h11 in a grey picture, by rising number. None with a wrong bit or little
/// contrast, and none whose number is seen at two places: nobody knows which is meant. Thread-safe.
std::vector<SeenTag> ReadTags(const cv::Mat& grey);

/// The same for tags whose corners dark squares touch: blur joins them with the frames, so they are
/// read where white has been made to grow by a pixel or less.
std::vector<SeenTag> ReadJoinedTags(const cv::Mat& grey);

}  // namespace hitchview::calib

#include "app/demo_picture.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace hitchview::app {
namespace {

constexpr int kGap_px = 6;
constexpr int kCaption_px = 30;

cv::Mat Plane(const hal::Plane& plane, int width, int height) {
    return {height, width, CV_8UC1, const_cast<std::uint8_t*>(plane.data),
            static_cast<std::size_t>(plane.stride_bytes)};
}

void PutTiles(const std::vector<cv::Mat>& tiles, cv::Mat& sheet, int columns,
              const cv::Size& size) {
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const int col = static_cast<int>(i) % columns;
        const int row = static_cast<int>(i) / columns;
        cv::Mat to = sheet(cv::Rect(col * (size.width + kGap_px), row * (size.height + kGap_px),
                                    size.width, size.height));
        cv::resize(tiles[i], to, size, 0, 0, cv::INTER_AREA);
    }
}

}  // namespace

cv::Mat ToBgr(const hal::FrameView& picture) {
    const int width = picture.format.width_px;
    const int height = picture.format.height_px;
    const cv::Mat y = Plane(picture.planes[0], width, height);
    cv::Mat u;
    cv::Mat v;
    cv::resize(Plane(picture.planes[1], width / 2, height / 2), u, y.size(), 0, 0,
               cv::INTER_LINEAR);
    cv::resize(Plane(picture.planes[2], width / 2, height / 2), v, y.size(), 0, 0,
               cv::INTER_LINEAR);
    cv::Mat ycrcb;
    cv::merge(std::vector<cv::Mat>{y, v, u}, ycrcb);
    cv::Mat bgr;
    cv::cvtColor(ycrcb, bgr, cv::COLOR_YCrCb2BGR);
    return bgr;
}

std::string WriteSheet(const DemoSheet& sheet, const std::filesystem::path& file) {
    const int width = sheet.panoramas.at(0).picture.cols;
    const int columns = std::max(1, static_cast<int>(sheet.cameras.size() + 1) / 2);
    const cv::Size tile((width - (columns - 1) * kGap_px) / columns,
                        (width - (columns - 1) * kGap_px) / columns * sheet.cameras.at(0).rows /
                            sheet.cameras.at(0).cols);
    const int tiles_height = 2 * (tile.height + kGap_px);
    int height = tiles_height;
    for (const DemoSheet::Panorama& panorama : sheet.panoramas)
        height += kCaption_px + panorama.picture.rows;
    cv::Mat all(height, width, CV_8UC3, cv::Scalar(32, 32, 32));
    PutTiles(sheet.cameras, all, columns, tile);
    int y = tiles_height;
    for (const DemoSheet::Panorama& panorama : sheet.panoramas) {
        cv::putText(all, panorama.caption, cv::Point(8, y + kCaption_px - 9),
                    cv::FONT_HERSHEY_SIMPLEX, 0.65, cv::Scalar(230, 230, 230), 1, cv::LINE_AA);
        y += kCaption_px;
        panorama.picture.copyTo(all(cv::Rect(0, y, width, panorama.picture.rows)));
        y += panorama.picture.rows;
    }
    return cv::imwrite(file.string(), all) ? "" : file.string() + ": cannot be written";
}

}  // namespace hitchview::app

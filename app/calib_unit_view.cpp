#include "app/calib_unit_view.hpp"

#include <algorithm>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>

namespace hitchview::app {
namespace {

using algo::UnitGeometry;

constexpr int kWidth_px = 4096;
constexpr int kHeight_px = 1024;
constexpr double kHorizon = 0.45;

/// Calls `use(pixel of the view, sight)` for each camera that has a share in a pixel.
template <typename Use>
void ForEachSight(const UnitGeometry& geometry, const Use& use) {
    for (int y = 0; y < geometry.view().height_px; ++y) {
        for (int x = 0; x < geometry.view().width_px; ++x) {
            UnitGeometry::Sights sights;
            geometry.See(geometry.view().Ray({x, y}), sights);
            for (const algo::CameraSight& sight : sights) {
                if (sight.weight > 0) use(cv::Point(x, y), sight);
            }
        }
    }
}

}  // namespace

UnitGeometry SemiSurroundOf(const calib::UnitSession& session,
                            const calib::UnitSolution& solution) {
    const double centre_rad = session.unit == algo::Unit::kTractor ? 0.0 : std::numbers::pi;
    const auto view = algo::Projection::Cylinder(kWidth_px, kHeight_px, kHorizon, centre_rad);
    std::vector<algo::CameraGeometry> cameras;
    for (std::size_t i = 0; i < solution.cameras.size(); ++i)
        cameras.push_back({session.problem.cameras[i].model, solution.cameras[i].T_unit_camera});
    return UnitGeometry::Ring(view, cameras, {});
}

cv::Mat3b DrawView(const UnitGeometry& geometry, std::span<const cv::Mat> pictures) {
    cv::Mat3f sum(geometry.view().height_px, geometry.view().width_px, cv::Vec3f(0, 0, 0));
    ForEachSight(geometry, [&](const cv::Point& at, const algo::CameraSight& sight) {
        cv::Mat3b patch;
        cv::getRectSubPix(pictures[static_cast<std::size_t>(sight.camera)], {1, 1},
                          cv::Point2d(sight.pixel.x(), sight.pixel.y()), patch);
        sum(at) += static_cast<float>(sight.weight) * cv::Vec3f(patch(0, 0));
    });
    cv::Mat3b view;
    sum.convertTo(view, CV_8U);
    return view;
}

cv::Mat3b CropSeam(const UnitGeometry& geometry, const cv::Mat3b& view,
                   const Eigen::Isometry3d& T_unit_first, const Eigen::Isometry3d& T_unit_second) {
    constexpr int kHalfWidth_px = 250;
    constexpr int kHalfHeight_px = 150;
    Eigen::Vector3d middle = T_unit_first.linear().col(2) + T_unit_second.linear().col(2);
    middle.z() = 0;
    const Eigen::Vector2d at = geometry.view().Pixel(middle);
    const int x = std::clamp(static_cast<int>(at.x()), kHalfWidth_px, view.cols - kHalfWidth_px);
    const int y = std::clamp(static_cast<int>(at.y()), kHalfHeight_px, view.rows - kHalfHeight_px);
    return view(
        cv::Rect(x - kHalfWidth_px, y - kHalfHeight_px, 2 * kHalfWidth_px, 2 * kHalfHeight_px));
}

std::string WriteMaps(const UnitGeometry& geometry, const std::vector<std::string>& names,
                      const std::filesystem::path& folder) {
    std::error_code refused;
    std::filesystem::create_directories(folder, refused);
    if (refused) return folder.string() + ": cannot be made: " + refused.message();
    // OpenCV writes the last channel first.
    std::vector<cv::Mat3f> maps;
    for (std::size_t i = 0; i < names.size(); ++i)
        maps.emplace_back(geometry.view().height_px, geometry.view().width_px,
                          cv::Vec3f(0, -1, -1));
    ForEachSight(geometry, [&](const cv::Point& at, const algo::CameraSight& sight) {
        maps[static_cast<std::size_t>(sight.camera)](at) = {static_cast<float>(sight.weight),
                                                            static_cast<float>(sight.pixel.y()),
                                                            static_cast<float>(sight.pixel.x())};
    });
    constexpr int kUncompressed = 1;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string file = (folder / (names[i] + ".tiff")).string();
        if (!cv::imwrite(file, maps[i], {cv::IMWRITE_TIFF_COMPRESSION, kUncompressed}))
            return file + ": cannot be written";
    }
    return "";
}

}  // namespace hitchview::app

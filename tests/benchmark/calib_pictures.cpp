// Writes pictures of a board by the cameras of a rig, to calibrate with:
//     calib_pictures FOLDER CAMERAS VIEWS WIDTH_PX checkerboard|charuco|tags
// The lenses are known: FOLDER/truth.txt has focal length and centre of each camera.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "tests/support/board_pictures.hpp"
#include "tests/support/board_views.hpp"

namespace {

using namespace hitchview;

calib::Board BoardOf(const std::string& pattern) {
    if (pattern == "tags")
        return {.columns = 6,
                .rows = 4,
                .square_m = 0.11,
                .pattern = calib::Pattern::kTags,
                .tag_m = 0.085};
    const bool is_charuco = pattern == "charuco";
    return {.columns = 9,
            .rows = 6,
            .square_m = 0.07,
            .pattern = is_charuco ? calib::Pattern::kCharuco : calib::Pattern::kCheckerboard,
            .tag_m = is_charuco ? 0.05 : 0};
}

algo::CameraModel LensOf(int camera, int width_px) {
    algo::CameraModel lens = tests::FisheyeLens();
    const double scale = width_px / 1280.0;
    lens.width_px = width_px;
    lens.height_px = width_px * 9 / 16;
    lens.fx_px = scale * (lens.fx_px + camera);
    lens.fy_px = scale * (lens.fy_px + camera);
    lens.cx_px = scale * (lens.cx_px + 2 * camera);
    lens.cy_px = scale * (lens.cy_px - camera);
    return lens;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 6) {
        std::fprintf(stderr, "calib_pictures FOLDER CAMERAS VIEWS WIDTH_PX PATTERN\n");
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    const calib::Board board = BoardOf(argv[5]);
    std::filesystem::create_directories(folder);
    std::ofstream truth(folder / "truth.txt");
    for (int camera = 0; camera < std::atoi(argv[2]); ++camera) {
        const std::string name = "camera_" + std::to_string(camera);
        std::filesystem::create_directories(folder / name);
        const algo::CameraModel lens = LensOf(camera, std::atoi(argv[4]));
        truth << name << ' ' << lens.fx_px << ' ' << lens.fy_px << ' ' << lens.cx_px << ' '
              << lens.cy_px << '\n';
        tests::BoardPictures pictures(lens, board, static_cast<unsigned>(camera) + 1);
        for (int view = 0; view < std::atoi(argv[3]); ++view) {
            const std::string file = std::to_string(100 + view) + ".png";
            cv::imwrite((folder / name / file).string(), pictures.Picture(pictures.NextPlace()));
        }
    }
    return 0;
}

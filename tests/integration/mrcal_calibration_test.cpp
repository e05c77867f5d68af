#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <opencv2/imgcodecs.hpp>

#include "calib/board_detector.hpp"
#include "calib/format.hpp"
#include "calib/intrinsics.hpp"
#include "tests/support/mrcal.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"

// The same corners for mrcal and for us. What differs by design: mrcal bends a board by two
// numbers, we measure every corner of it; mrcal draws coefficients towards zero (regularization)
// and leaves single corners out, we leave whole views out. All of mrcal's are switched off where
// both are to solve the same problem. mrcal's own figure counts x and y as two measurements and is
// smaller by the root of two; here all errors are distances.
namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Eigen::Vector2d;
using Eigen::Vector3d;

LensPictures FindCorners(const std::string& folder, const std::string& prefix, const Board& board,
                         CameraModel::Kind kind) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::filesystem::path& file = entry.path();
        if (file.extension() == ".jpg" && file.filename().string().starts_with(prefix))
            files.push_back(file);
    }
    std::ranges::sort(files);
    LensPictures pictures{.kind = kind, .board = board};
    for (const std::string& file : files) {
        const cv::Mat grey = cv::imread(file, cv::IMREAD_GRAYSCALE);
        pictures.width_px = grey.cols;
        pictures.height_px = grey.rows;
        SeenCorners corners = DetectBoards(grey, {&board, 1}).at(0);
        if (!corners.empty()) pictures.views.push_back({.name = file, .corners = corners});
    }
    return pictures;
}

std::string CornersText(const LensPictures& pictures) {
    std::ostringstream text;
    text << std::setprecision(12) << "# filename x y level\n";
    for (const BoardView& view : pictures.views) {
        for (const SeenCorner& corner : view.corners)
            text << view.name << ' ' << corner.at_px.x() << ' ' << corner.at_px.y() << " 0\n";
    }
    return text.str();
}

LensProblem ProblemOf(const LensPictures& pictures) {
    LensProblem problem{pictures.kind, pictures.width_px, pictures.height_px, pictures.board, {}};
    for (const BoardView& view : pictures.views) problem.views.push_back(view.corners);
    return problem;
}

/// What mrcal-calibrate-cameras makes of the corners.
class MrcalSolution {
 public:
    MrcalSolution(const LensPictures& pictures, const std::string& model,
                  const std::string& flags) {
        const std::string corners = folder_.Write("corners.vnl", CornersText(pictures));
        const Board& board = pictures.board;
        const std::string command =
            "/usr/bin/python3 /usr/bin/mrcal-calibrate-cameras --corners-cache " + corners +
            " --lensmodel " + model + " --focal 500 --object-spacing " +
            std::to_string(board.square_m) + " --object-width-n " + std::to_string(board.columns) +
            " --object-height-n " + std::to_string(board.rows) + " --imagersize " +
            std::to_string(pictures.width_px) + ' ' + std::to_string(pictures.height_px) + ' ' +
            flags + " --outdir " + folder_.path() + " '" +
            std::filesystem::path(pictures.views.front().name).parent_path().string() +
            "/*.jpg' >/dev/null 2>&1";
        solved_ = std::system(command.c_str()) == 0;
    }
    [[nodiscard]] bool solved() const { return solved_; }
    [[nodiscard]] std::string file() const { return folder_ / "camera-0.cameramodel"; }
    [[nodiscard]] double RmsPx() const {
        const std::string command = "/usr/bin/python3 " HITCHVIEW_SOURCE_DIR
                                    "/tests/support/mrcal_rms.py " +
                                    file() + " > " + (folder_ / "rms");
        double rms_px = -1;
        if (std::system(command.c_str()) == 0) std::ifstream(folder_ / "rms") >> rms_px;
        return rms_px;
    }

 private:
    tests::TemporaryFolder folder_;
    bool solved_ = false;
};

using Pixels = std::vector<Vector2d>;

Pixels WholePicture(const LensPictures& pictures) {
    constexpr double kStep_px = 20;
    Pixels pixels;
    for (double y = 0; y < pictures.height_px; y += kStep_px) {
        for (double x = 0; x < pictures.width_px; x += kStep_px) pixels.emplace_back(x, y);
    }
    return pixels;
}

Pixels WhereCornersWere(const LensPictures& pictures) {
    Pixels pixels;
    for (const BoardView& view : pictures.views) {
        for (const SeenCorner& corner : view.corners) pixels.push_back(corner.at_px);
    }
    return pixels;
}

/// Distances between the pixels of two lenses for the same distant points, rising, after the turn
/// of the whole camera that brings them nearest. `at_px`: where in the picture of `a`.
std::vector<double> Differences(const CameraModel& a, const CameraModel& b, const Pixels& at_px) {
    std::vector<Vector3d> from_a;
    Pixels pixels;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Vector2d& pixel : at_px) {
        const auto in_a = a.Unproject(pixel);
        const auto in_b = b.Unproject(pixel);
        if (!in_a || !in_b) continue;
        from_a.push_back(*in_a);
        pixels.push_back(pixel);
        sum += *in_b * in_a->transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Matrix3d R_b_a = svd.matrixU() * svd.matrixV().transpose();
    std::vector<double> off_px;
    for (std::size_t i = 0; i < from_a.size(); ++i) {
        if (const auto shown = b.Project(R_b_a * from_a[i]))
            off_px.push_back((*shown - pixels[i]).norm());
    }
    std::ranges::sort(off_px);
    return off_px;
}

bool HasMrcalCalibration() {
    return tests::HasMrcal() && std::filesystem::exists("/usr/bin/mrcal-calibrate-cameras");
}

TEST(MrcalCalibrationTest, SolvesTheSameFlatBoardToTheSameLens) {
    const std::string folder = tests::TestData("calib/pinhole");
    if (folder.empty()) GTEST_SKIP() << "no recordings beside the source tree";
    if (!HasMrcalCalibration()) GTEST_SKIP() << "mrcal is not installed";
    const Board board{.columns = 9, .rows = 6, .square_m = 0.025};
    const LensPictures pictures =
        FindCorners(folder, "left", board, CameraModel::Kind::kPinholeRadtan);
    ASSERT_EQ(pictures.views.size(), 13U);

    const MrcalSolution mrcal(pictures, "LENSMODEL_OPENCV5",
                              "--skip-calobject-warp-solve --skip-outlier-rejection "
                              "--skip-regularization");
    ASSERT_TRUE(mrcal.solved());
    const ForeignCameras imported = ImportCameras(Format::kMrcal, mrcal.file(), {});
    ASSERT_EQ(imported.error, "");
    const auto ours = SolveLens(ProblemOf(pictures), {});
    ASSERT_TRUE(ours);
    CameraModel lens = ours->model;
    lens.max_theta_rad = imported.cameras.at(0).model.max_theta_rad;

    const std::vector<double> off_px =
        Differences(lens, imported.cameras[0].model, WholePicture(pictures));
    const double mrcal_rms_px = mrcal.RmsPx();
    std::cout << "rms " << ours->rms_px << " px, mrcal " << mrcal_rms_px << " px; projection "
              << off_px[off_px.size() / 2] << " px median, " << off_px.back() << " px at most\n";
    EXPECT_LE(ours->rms_px, mrcal_rms_px + 1e-6);
    EXPECT_NEAR(ours->rms_px, mrcal_rms_px, 1e-5);
    EXPECT_GT(off_px.size(), 700U);
    EXPECT_LT(off_px.back(), 1e-3);
}

/// Each as its user gets it: mrcal with its bent board, regularization and outliers, we with our
/// measured board. In the picture's corners, where no board was, five coefficients of either are a
/// guess: they differ by tens of pixels there.
TEST(MrcalCalibrationTest, ToolsAsTheyAreAgreeWhereCornersWere) {
    const std::string folder = tests::TestData("calib/pinhole");
    if (folder.empty()) GTEST_SKIP() << "no recordings beside the source tree";
    if (!HasMrcalCalibration()) GTEST_SKIP() << "mrcal is not installed";
    const Board board{.columns = 9, .rows = 6, .square_m = 0.025};
    const LensPictures pictures =
        FindCorners(folder, "left", board, CameraModel::Kind::kPinholeRadtan);
    const MrcalSolution mrcal(pictures, "LENSMODEL_OPENCV5", "");
    ASSERT_TRUE(mrcal.solved());
    const auto ours = MeasureIntrinsics(pictures);
    const ForeignCameras imported = ImportCameras(Format::kMrcal, mrcal.file(), {});
    ASSERT_TRUE(ours && imported.error.empty());

    const std::vector<double> off_px =
        Differences(ours->model, imported.cameras.at(0).model, WhereCornersWere(pictures));
    std::cout << "rms " << ours->rms_px << " px, mrcal " << mrcal.RmsPx() << " px; projection "
              << off_px[off_px.size() / 2] << " px median, " << off_px.back() << " px at most\n";
    EXPECT_LT(ours->rms_px, mrcal.RmsPx());
    EXPECT_LT(off_px.back(), 0.2);
}

/// No perspective model of mrcal holds 190 degrees, so its splined one with more than 300 numbers
/// stands here against our eight.
TEST(MrcalCalibrationTest, ABoardMeasuredCornerByCornerExplainsWideLensesBetter) {
    if (tests::TestData("calib/chessboard_2").empty())
        GTEST_SKIP() << "no recordings beside the source tree";
    if (!HasMrcalCalibration()) GTEST_SKIP() << "mrcal is not installed";
    const Board board{.columns = 7, .rows = 7, .square_m = 0.1};
    for (const char* const name : {"calib/chessboard_1", "calib/chessboard_2"}) {
        const LensPictures pictures =
            FindCorners(tests::TestData(name), "frame", board, CameraModel::Kind::kKannalaBrandt4);
        ASSERT_EQ(pictures.views.size(), 10U);
        const MrcalSolution perspective(pictures, "LENSMODEL_OPENCV5", "--skip-outlier-rejection");
        const MrcalSolution splined(
            pictures, "LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=16_Ny=11_fov_x_deg=190",
            "--skip-outlier-rejection");
        ASSERT_TRUE(perspective.solved() && splined.solved());
        const auto ours = MeasureIntrinsics(pictures);
        ASSERT_TRUE(ours && ours->heldout_rms_px);
        std::cout << name << ": rms " << ours->rms_px << " px, in views left out "
                  << *ours->heldout_rms_px << " px; mrcal splined " << splined.RmsPx()
                  << " px, OPENCV5 " << perspective.RmsPx() << " px\n";
        EXPECT_LT(*ours->heldout_rms_px, splined.RmsPx());
        EXPECT_LT(splined.RmsPx(), perspective.RmsPx());
    }
}

}  // namespace
}  // namespace hitchview::calib

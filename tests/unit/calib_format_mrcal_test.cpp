#include <gtest/gtest.h>

#include <fstream>

#include "calib/format.hpp"
#include "tests/support/format_samples.hpp"
#include "tests/support/mrcal.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::calib {
namespace {

using Kind = algo::CameraModel::Kind;
using tests::TemporaryFolder;

constexpr int kPoints = 200;

/// Points before the camera at 1 to 20 m, in the unit frame, and the pixels that show them.
struct Sight {
    Sight(const CalibratedCamera& camera, tests::FormatSamples& samples) {
        const algo::CameraGeometry geometry = camera.Geometry();
        for (int i = 0; i < kPoints; ++i) {
            const Eigen::Vector3d p_camera = samples.Ray(camera.model) * samples.Between(1, 20);
            p_unit.emplace_back(geometry.T_unit_camera * p_camera);
            pixels.push_back(camera.model.Project(p_camera).value());
        }
    }
    std::vector<Eigen::Vector3d> p_unit{};
    std::vector<Eigen::Vector2d> pixels{};
};

std::string PointsText(const std::vector<Eigen::Vector3d>& points) {
    std::ostringstream text;
    text.precision(17);
    for (const Eigen::Vector3d& p : points) text << p.transpose() << '\n';
    return text.str();
}

std::vector<Eigen::Vector2d> ReadPixels(const std::string& file) {
    std::vector<Eigen::Vector2d> pixels;
    std::ifstream stream(file);
    for (Eigen::Vector2d p; stream >> p.x() >> p.y();) pixels.push_back(p);
    return pixels;
}

TEST(FormatMrcalTest, MrcalShowsPointsOfTheUnitAtTheSamePixels) {
    if (!tests::HasMrcal()) GTEST_SKIP() << "mrcal is not installed";
    const TemporaryFolder folder;
    tests::FormatSamples samples(11);
    const RigCalibration rig = samples.Rig(Kind::kPinholeRadtan);
    const ExportedFiles exported = ExportRig(Format::kMrcal, rig);
    ASSERT_EQ(exported.error, "");
    for (const auto& [name, camera] : rig.cameras) {
        const Sight sight(camera, samples);
        const auto file =
            std::ranges::find(exported.files, name + ".cameramodel", &ForeignFile::name);
        ASSERT_NE(file, exported.files.end());
        const std::string model = folder.Write(file->name, file->text);
        const std::string points = folder.Write("points", PointsText(sight.p_unit));
        ASSERT_EQ(tests::RunMrcalPython(HITCHVIEW_SOURCE_DIR "/tests/support/mrcal_project.py " +
                                        model + ' ' + points + ' ' + (folder / "pixels")),
                  0);
        const auto pixels = ReadPixels(folder / "pixels");
        ASSERT_EQ(pixels.size(), sight.pixels.size());
        for (std::size_t i = 0; i < pixels.size(); ++i)
            EXPECT_LT((pixels[i] - sight.pixels[i]).norm(), 1e-6) << name;
    }
}

}  // namespace
}  // namespace hitchview::calib

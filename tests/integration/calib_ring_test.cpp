#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/imgproc.hpp>

#include "algo/unit_geometry.hpp"
#include "calib/camera_graph.hpp"
#include "calib/far_matches.hpp"
#include "calib/unit_solver.hpp"
#include "tests/support/ground_cloth.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"

// Four real fisheye cameras round a car that stands on a checkered cloth, as one unit. Their lenses
// are as published with the pictures.
namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPanorama_px = 4096;

class FisheyeRingTest : public testing::Test {
 protected:
    void SetUp() override {
        const std::string folder = tests::TestData("stills/fisheye-car");
        if (folder.empty()) GTEST_SKIP() << "no test data";
        problem_.targets.push_back(Cloth());
        constexpr double kQuarter = std::numbers::pi / 2;
        for (const auto& [name, quarters] :
             {std::pair{"front", 0}, {"left", 1}, {"back", 2}, {"right", -1}}) {
            pictures_.push_back(tests::ClothReader(folder, name).Read());
            problem_.sightings.push_back({.camera = problem_.cameras.size(),
                                          .target = 0,
                                          .shot = "1",
                                          .corners = pictures_.back().corners});
            problem_.cameras.push_back(
                {.name = name, .model = pictures_.back().model, .yaw_rad = quarters * kQuarter});
        }
    }

    /// The unit frame lies in the middle of the cloth, on the ground.
    static UnitTarget Cloth() {
        UnitTarget cloth{.name = "cloth", .board = tests::kGroundCloth, .sigma_m = 0.005};
        const int columns = tests::kGroundCloth.columns;
        const int last = tests::kGroundCloth.count() - 1;
        for (const int index : {0, columns - 1, last - columns + 1, last}) {
            const Vector3d at = tests::kGroundCloth.Corner(index);
            cloth.surveyed.push_back({at, {4.6 - at.y(), 2.6 - at.x(), 0}});
        }
        return cloth;
    }

    /// How far apart neighbours see corners of the cloth that both see, in pixels of the panorama
    /// from the middle of the car; the median.
    [[nodiscard]] double MisalignmentOnTheGround(const UnitSolution& solution) const {
        std::vector<double> off_px;
        for (std::size_t a = 0; a < pictures_.size(); ++a) {
            for (std::size_t b = a + 1; b < pictures_.size(); ++b) {
                for (const SeenCorner& by_a : pictures_[a].corners)
                    for (const SeenCorner& by_b : pictures_[b].corners)
                        if (by_a.index == by_b.index)
                            off_px.push_back(Between(OnGround(solution, a, by_a.at_px),
                                                     OnGround(solution, b, by_b.at_px)));
            }
        }
        std::ranges::sort(off_px);
        return off_px.at(off_px.size() / 2);
    }
    [[nodiscard]] Vector3d OnGround(const UnitSolution& solution, std::size_t camera,
                                    const Eigen::Vector2d& at_px) const {
        const Isometry3d& T = solution.cameras[camera].T_unit_camera;
        const Vector3d ray = T.linear() * problem_.cameras[camera].model.Unproject(at_px).value();
        return T.translation() - ray * (T.translation().z() / ray.z());
    }
    static double Between(const Vector3d& a, const Vector3d& b) {
        const Vector3d viewpoint(0, 0, 1.3);
        const Vector3d to_a = (a - viewpoint).normalized();
        const Vector3d to_b = (b - viewpoint).normalized();
        return std::atan2(to_a.cross(to_b).norm(), to_a.dot(to_b)) * kPanorama_px /
               (2 * std::numbers::pi);
    }

    void Draw(const UnitSolution& solution, const std::string& file) const {
        std::vector<algo::CameraGeometry> cameras;
        for (std::size_t i = 0; i < pictures_.size(); ++i) {
            cameras.push_back({problem_.cameras[i].model, solution.cameras[i].T_unit_camera});
            cameras.back().model.max_theta_rad = 1.45;  // beyond, the picture is dark
        }
        const auto canvas = algo::Projection::Cylinder(2048, 512, 0.35);
        const auto ring = algo::UnitGeometry::Ring(
            canvas, cameras, {.radius_m = 15, .viewpoint_m = 1.5, .ground_m = 0});
        cv::Mat3b panorama(canvas.height_px, canvas.width_px);
        for (int y = 0; y < panorama.rows; ++y)
            for (int x = 0; x < panorama.cols; ++x)
                panorama(y, x) = Colour(ring, canvas.Ray({x, y}));
        cv::imwrite(file, panorama);
    }
    [[nodiscard]] cv::Vec3b Colour(const algo::UnitGeometry& ring, const Vector3d& ray) const {
        algo::UnitGeometry::Sights sights;
        ring.See(ray, sights);
        cv::Vec3d colour(0, 0, 0);
        for (const algo::CameraSight& sight : sights) {
            if (sight.weight <= 0) continue;
            cv::Mat3b at;
            const cv::Point2f pixel(static_cast<float>(sight.pixel.x()),
                                    static_cast<float>(sight.pixel.y()));
            cv::getRectSubPix(pictures_[static_cast<std::size_t>(sight.camera)].colour, {1, 1},
                              pixel, at);
            colour += sight.weight * cv::Vec3d(at(0, 0));
        }
        return colour;
    }

    UnitProblem problem_;
    std::vector<tests::ClothPicture> pictures_;
};

TEST_F(FisheyeRingTest, ClosesOnTheGroundAndFarAway) {
    const CameraGraph graph = BuildCameraGraph(problem_);
    ASSERT_TRUE(graph.missing.empty()) << graph.missing[0];
    const auto solution = SolveUnit(problem_, graph);
    ASSERT_TRUE(solution);
    for (std::size_t i = 0; i < problem_.cameras.size(); ++i) {
        const PlacedCamera& camera = solution->cameras[i];
        EXPECT_LT(camera.rms_px, 1.0) << problem_.cameras[i].name;
        EXPECT_GE(camera.corners, 20) << problem_.cameras[i].name;
        EXPECT_NEAR(camera.T_unit_camera.translation().z(), 0.85, 0.25);
    }
    const double on_ground_px = MisalignmentOnTheGround(*solution);
    EXPECT_LT(on_ground_px, 4);

    std::vector<cv::Mat> greys;
    for (const tests::ClothPicture& picture : pictures_) greys.push_back(picture.grey);
    problem_.far_matches = FindFarMatches(problem_.cameras, solution->places.T_unit_camera, greys);
    const auto refined = SolveUnitFrom(solution->places, problem_, graph);
    ASSERT_TRUE(refined);
    const auto before = Misalignments(problem_, solution->places.T_unit_camera);
    const auto after = Misalignments(problem_, refined->places.T_unit_camera);
    ASSERT_GE(after.size(), 2);
    const double per_px = kPanorama_px / (2 * std::numbers::pi);
    std::printf("on the ground %.1f px of 4096\n", on_ground_px);
    for (std::size_t i = 0; i < after.size(); ++i) {
        EXPECT_LT(after[i].median_rad, before[i].median_rad);
        EXPECT_LT(after[i].median_rad * per_px, 4);
        std::printf("%s to %s: %.1f px of 4096, with %zu far matches %.1f px\n",
                    problem_.cameras[after[i].first].name.c_str(),
                    problem_.cameras[after[i].second].name.c_str(), before[i].median_rad * per_px,
                    after[i].matches, after[i].median_rad * per_px);
    }
    if (const char* const folder = std::getenv("HITCHVIEW_TEST_PICTURES"))
        Draw(*refined, std::string(folder) + "/fisheye_ring.png");
}

}  // namespace
}  // namespace hitchview::calib

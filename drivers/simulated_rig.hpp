#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "algo/camera_model.hpp"
#include "drivers/simulated_drops.hpp"
#include "drivers/simulated_exposure.hpp"
#include "drivers/simulated_motion.hpp"
#include "drivers/simulated_outlook.hpp"
#include "drivers/simulated_renderer.hpp"
#include "drivers/simulated_sheet.hpp"
#include "drivers/simulated_snowfall.hpp"
#include "drivers/simulated_sun.hpp"

namespace hitchview::drivers {

struct SimulatedCameraGeometry {
    std::string_view name;
    algo::Unit unit = algo::Unit::kTractor;
    algo::CameraGeometry geometry;
};

/// The cameras in rig order: the three of the tractor, then the five of the trailer.
using SimulatedRigGeometryTable = std::array<SimulatedCameraGeometry, 8>;

/// Lenses of 120 degrees across and mounts of the eight cameras, for images of this size (even, not
/// taller than wide).
SimulatedRigGeometryTable SimulatedRigGeometry(int width_px, int height_px);
/// What a calibration with these errors says of them.
SimulatedRigGeometryTable Miscalibrated(SimulatedRigGeometryTable cameras,
                                        const CalibrationErrors& errors);

/// A drive with a tractor-trailer: what its eight cameras see and what is true. The side cameras
/// next to the hitch, left_front and left (right_front and right), are 1.8 m apart when the vehicle
/// is straight: each sits 0.9 m from the hitch. Thread-safe.
class SimulatedRig {
 public:
    static constexpr int kCameras = 8;
    /// Distance given to what is infinitely far away.
    static constexpr double kFar_m = 10'000;

    /// Takes the memory of scene and lens once (about 30 MB at 1280 x 720).
    static hal::Checked<std::unique_ptr<SimulatedRig>> Create(const SimulationOptions& options);

    [[nodiscard]] const SimulationOptions& options() const { return options_; }
    [[nodiscard]] const SimulatedCameraGeometry& camera(int camera_index) const;
    [[nodiscard]] hal::FrameFormat format() const;
    /// Gain on the light of this camera, near 1, before exposure changes it.
    [[nodiscard]] double GainOf(int camera_index) const;
    /// Gain at one frame, with gain steps and automatic exposure.
    [[nodiscard]] double GainAt(int camera_index, int frame) const;
    /// False while the camera delivers nothing. Render works all the same.
    [[nodiscard]] bool CameraPresent(int camera_index, int frame) const;

    /// Image of camera `camera_index` (0..7) at frame `frame` (0..frames-1), to
    /// FrameBytes(format()) bytes. A frame has the same bytes whenever and wherever it is rendered.
    void Render(int camera_index, int frame, Renderer::Workspace& workspace,
                std::span<std::uint8_t> out_nv12) const;

    /// T_world_unit; origin in the hitch point, world frame as in HeadingAt.
    [[nodiscard]] Eigen::Isometry3d PoseAt(int frame, algo::Unit unit,
                                           Shaking shaking = Shaking::kWith) const;
    /// T_world_camera, with shaking.
    [[nodiscard]] Eigen::Isometry3d CameraPoseAt(int camera_index, int frame) const;
    /// Yaw of the trailer relative to the tractor, positive to the left, without shaking.
    [[nodiscard]] double HitchAngleAt(int frame) const;
    /// Same at any moment from the start of the drive to its last frame.
    [[nodiscard]] double HitchAngleAt(hal::Instant since_start) const;

    /// Yaw of the trailer relative to the tractor as the cameras ride, with shaking; rad, positive
    /// to the left.
    [[nodiscard]] double ArticulationAt(int frame) const;

    struct SeenPoint {
        Eigen::Vector3d p_world_m;
        double distance_m;  ///< from the camera; kFar_m for sky and backdrop
    };
    /// What the pixel shows; empty where the lens has no ray.
    [[nodiscard]] std::optional<SeenPoint> WorldPointAt(int camera_index, int frame,
                                                        const Eigen::Vector2d& pixel) const;
    /// Same for many pixels of one picture; `outlook` is that of the camera and frame.
    [[nodiscard]] std::optional<SeenPoint> WorldPointAt(int camera_index, int frame,
                                                        const Eigen::Vector2d& pixel,
                                                        const Outlook& outlook) const;
    /// From the camera, at the frame.
    [[nodiscard]] Outlook OutlookOf(int camera_index, int frame) const;

    enum class Occlusion { kIgnored, kTested };
    /// Pixel that shows the point; empty outside the image, and with kTested also behind something.
    [[nodiscard]] std::optional<Eigen::Vector2d> ProjectWorldPoint(
        int camera_index, int frame, const Eigen::Vector3d& p_world_m,
        Occlusion occlusion = Occlusion::kIgnored) const;

 private:
    explicit SimulatedRig(const SimulationOptions& options);
    [[nodiscard]] Moment MomentOf(int frame) const;
    [[nodiscard]] double LightAround(int camera_index, int frame) const;
    void DrawSnow(int camera_index, int frame, std::span<std::uint8_t> nv12) const;
    void DrawSun(int camera_index, int frame, std::span<std::uint8_t> nv12) const;

    SimulationOptions options_;
    SimulatedRigGeometryTable cameras_;
    Motion motion_;
    World world_;
    Renderer renderer_;
    Snowfall snowfall_;
    LensDrops drops_;
    std::optional<LowSun> sun_;
    std::optional<HeldSheet> sheet_;
    std::optional<AutoExposure> auto_exposure_;
};

}  // namespace hitchview::drivers

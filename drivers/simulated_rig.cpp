#include "drivers/simulated_rig.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/simulated_noise.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kHalfView_rad = 60 * kDegree;
constexpr double kPitchDown_rad = 5 * kDegree;
constexpr double kMountHeight_m = 1.7 - VehicleDimensions::kHitchHeight;
constexpr double kSide_m = 0.72;
constexpr double kFromHitch_m = 0.9;  // left_front to left: 1.8 m when the vehicle is straight

/// Mount and direction of one camera in the frame of its unit; yaw positive to the left.
struct Mount {
    std::string_view name;
    algo::Unit unit;
    double x_m, y_m, yaw_rad;
};

constexpr double kNose_m = VehicleDimensions::kFront - 0.05;
constexpr double kTail_m = -VehicleDimensions::kRear + 0.05;

constexpr std::array<Mount, SimulatedRig::kCameras> kMounts{{
    {"front", algo::Unit::kTractor, kNose_m, 0, 0},
    {"left_front", algo::Unit::kTractor, kFromHitch_m, kSide_m, 70 * kDegree},
    {"right_front", algo::Unit::kTractor, kFromHitch_m, -kSide_m, -70 * kDegree},
    {"left", algo::Unit::kTrailer, -kFromHitch_m, kSide_m, 90 * kDegree},
    {"left_rear", algo::Unit::kTrailer, kTail_m, kSide_m, 135 * kDegree},
    {"rear", algo::Unit::kTrailer, kTail_m, 0, 180 * kDegree},
    {"right_rear", algo::Unit::kTrailer, kTail_m, -kSide_m, -135 * kDegree},
    {"right", algo::Unit::kTrailer, -kFromHitch_m, -kSide_m, -90 * kDegree},
}};

algo::CameraModel Lens(int width_px, int height_px) {
    algo::CameraModel lens{.kind = algo::CameraModel::Kind::kKannalaBrandt4,
                           .width_px = width_px,
                           .height_px = height_px,
                           .fx_px = 1,
                           .fy_px = 1,
                           .cx_px = 0,
                           .cy_px = 0,
                           .distortion = {-0.018, 0.0035, -0.0011, 0.0001},
                           .max_theta_rad = 1.56};
    const Vector3d outermost{std::sin(kHalfView_rad), 0, std::cos(kHalfView_rad)};
    lens.fx_px = lens.fy_px = 0.5 * width_px / lens.Project(outermost)->x();
    lens.cx_px = 0.5 * (width_px - 1);
    lens.cy_px = 0.5 * (height_px - 1);
    return lens;
}

/// x right, y down, z forward to x forward, y left, z up.
Eigen::Matrix3d BodyFromCamera() {
    Eigen::Matrix3d R;
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return R;
}

Isometry3d MountPose(const Mount& mount) {
    Isometry3d T = Isometry3d::Identity();
    T.translate(Vector3d{mount.x_m, mount.y_m, kMountHeight_m});
    T.rotate(Eigen::AngleAxisd(mount.yaw_rad, Vector3d::UnitZ()) *
             Eigen::AngleAxisd(kPitchDown_rad, Vector3d::UnitY()));
    T.rotate(BodyFromCamera());
    return T;
}

bool InImage(const algo::CameraModel& lens, const Vector2d& pixel) {
    return pixel.x() >= -0.5 && pixel.x() < lens.width_px - 0.5 && pixel.y() >= -0.5 &&
           pixel.y() < lens.height_px - 0.5;
}

}  // namespace

SimulatedRigGeometryTable SimulatedRigGeometry(int width_px, int height_px) {
    HV_EXPECT(width_px >= height_px && height_px > 0);
    const algo::CameraModel lens = Lens(width_px, height_px);
    SimulatedRigGeometryTable table;
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = {kMounts[i].name, kMounts[i].unit, {lens, MountPose(kMounts[i])}};
    }
    return table;
}

SimulatedRigGeometryTable Miscalibrated(SimulatedRigGeometryTable cameras,
                                        const CalibrationErrors& errors) {
    for (const CalibrationErrors::Turn& turn : errors.turns) {
        const Eigen::Matrix3d R_body_camera = BodyFromCamera();
        const Eigen::Matrix3d R_turn = (Eigen::AngleAxisd(turn.yaw_rad, Vector3d::UnitZ()) *
                                        Eigen::AngleAxisd(turn.pitch_rad, Vector3d::UnitY()) *
                                        Eigen::AngleAxisd(turn.roll_rad, Vector3d::UnitX()))
                                           .toRotationMatrix();
        Isometry3d& T = cameras[static_cast<std::size_t>(turn.camera)].geometry.T_unit_camera;
        T.linear() = T.linear() * R_body_camera.transpose() * R_turn * R_body_camera;
    }
    for (SimulatedCameraGeometry& camera : cameras) {
        if (camera.unit == algo::Unit::kTrailer)
            camera.geometry.T_unit_camera.translation().x() -= errors.hitch_m;
    }
    return cameras;
}

hal::Checked<std::unique_ptr<SimulatedRig>> SimulatedRig::Create(const SimulationOptions& options) {
    if (const auto checked = CheckOptions(options); !checked.ok()) return checked.error();
    return std::unique_ptr<SimulatedRig>(new SimulatedRig(options));
}

SimulatedRig::SimulatedRig(const SimulationOptions& options)
    : options_(options),
      cameras_(SimulatedRigGeometry(options.width_px, options.height_px)),
      motion_(options),
      world_(options, motion_.PathOffRoad()),
      renderer_(world_, cameras_[0].geometry.model),
      snowfall_(options.scene.snowflakes, Hash(options.seed, 500)),
      drops_(options.scene.lens_drops, options.width_px, options.height_px,
             Hash(options.seed, 700)) {
    if (options.scene.sun) sun_.emplace(*options.scene.sun, cameras_[0].geometry.model);
    if (options.sheet)
        sheet_.emplace(*options.sheet, cameras_[0].geometry.model, Hash(options.seed, 600));
    if (!options.sensor.auto_exposure) return;
    auto_exposure_.emplace(options, kCameras, [this](int camera_index, int frame) {
        return LightAround(camera_index, frame);
    });
}

Moment SimulatedRig::MomentOf(int frame) const {
    Moment moment;
    moment.time_s = std::chrono::duration<double>(FrameTime(options_, frame)).count();
    for (const algo::Unit unit : algo::kUnits)
        moment.T_unit_world[unit] = PoseAt(frame, unit).inverse().cast<float>();
    return moment;
}

/// Mean from the camera to three metres before it.
double SimulatedRig::LightAround(int camera_index, int frame) const {
    constexpr int kPlaces = 4;
    const Isometry3d T_world_camera = CameraPoseAt(camera_index, frame);
    const Moment moment = MomentOf(frame);
    double sum = 0;
    for (int i = 0; i < kPlaces; ++i) {
        const Vector3d place = T_world_camera * Vector3d{0, 0, 1.0 * i};
        sum += world_.lighting().LevelAt(place, moment);
    }
    return sum / kPlaces;
}

const SimulatedCameraGeometry& SimulatedRig::camera(int camera_index) const {
    HV_EXPECT(camera_index >= 0 && camera_index < kCameras);
    return cameras_[static_cast<std::size_t>(camera_index)];
}

hal::FrameFormat SimulatedRig::format() const {
    return {options_.width_px, options_.height_px, hal::PixelFormat::kNv12, hal::Range::kFull};
}

double SimulatedRig::GainOf(int camera_index) const {
    const auto camera = static_cast<std::uint32_t>(camera_index);
    return 1 + options_.gain_spread * (2 * Unit01(Hash(options_.seed, 300, camera)) - 1);
}

double SimulatedRig::GainAt(int camera_index, int frame) const {
    double factor = 1;
    for (const SensorOptions::GainStep& step : options_.sensor.gain_steps) {
        if (step.camera == camera_index && step.first_frame <= frame) factor = step.factor;
    }
    if (auto_exposure_) factor *= auto_exposure_->GainAt(camera_index, frame);
    return GainOf(camera_index) * factor * options_.sensor.gain;
}

bool SimulatedRig::CameraPresent(int camera_index, int frame) const {
    const auto& outages = options_.sensor.outages;
    return std::none_of(outages.begin(), outages.end(), [&](const SensorOptions::Outage& outage) {
        return outage.camera == camera_index && frame >= outage.first_frame &&
               frame < outage.end_frame;
    });
}

void SimulatedRig::Render(int camera_index, int frame, Renderer::Workspace& workspace,
                          std::span<std::uint8_t> out_nv12) const {
    const std::uint32_t noise_seed =
        Hash(Hash(options_.seed, 400), static_cast<std::uint32_t>(camera_index),
             static_cast<std::uint32_t>(frame));
    renderer_.Render(CameraPoseAt(camera_index, frame), MomentOf(frame),
                     {static_cast<float>(GainAt(camera_index, frame)),
                      static_cast<float>(options_.noise_sigma), noise_seed},
                     options_.render_threads, workspace, out_nv12);
    if (options_.scene.snowflakes > 0) DrawSnow(camera_index, frame, out_nv12);
    if (sun_) DrawSun(camera_index, frame, out_nv12);
    if (options_.scene.lens_drops > 0)
        drops_.DrawOver(camera_index,
                        std::chrono::duration<double>(FrameTime(options_, frame)).count(),
                        out_nv12);
    if (sheet_) sheet_->DrawOver(camera_index, frame, GainAt(camera_index, frame), out_nv12);
}

void SimulatedRig::DrawSnow(int camera_index, int frame, std::span<std::uint8_t> nv12) const {
    constexpr std::chrono::milliseconds kShutter{6};
    const hal::Instant opens = FrameTime(options_, frame);
    const SimulatedCameraGeometry& at = camera(camera_index);
    const auto pose = [&](hal::Instant since_start) {
        return motion_.PoseAt(since_start, at.unit, Shaking::kWith) * at.geometry.T_unit_camera;
    };
    snowfall_.DrawOver(
        {at.geometry.model, pose(opens), pose(opens + kShutter),
         std::chrono::duration<double>(opens).count(),
         std::chrono::duration<double>(kShutter).count(), GainAt(camera_index, frame)},
        nv12);
}

/// Rays to the middle and round it tell how much of the disc is free.
void SimulatedRig::DrawSun(int camera_index, int frame, std::span<std::uint8_t> nv12) const {
    constexpr int kRays = 12;
    constexpr double kRing_rad = 0.5 * kDegree;
    const Isometry3d T_world_camera = CameraPoseAt(camera_index, frame);
    const Outlook outlook = OutlookOf(camera_index, frame);
    const Vector3d across = sun_->direction().unitOrthogonal();
    const auto is_free = [&](const Vector3d& direction) {
        return outlook.DistanceTo(direction.normalized()) >= kFar_m ? 1 : 0;
    };
    int free = is_free(sun_->direction());
    for (int i = 0; i < kRays; ++i) {
        const Eigen::AngleAxisd round(2 * std::numbers::pi * i / kRays, sun_->direction());
        free += is_free(sun_->direction() + std::tan(kRing_rad) * (round * across));
    }
    sun_->DrawOver({T_world_camera, free / (kRays + 1.0), GainAt(camera_index, frame)}, nv12);
}

Isometry3d SimulatedRig::PoseAt(int frame, algo::Unit unit, Shaking shaking) const {
    HV_EXPECT(frame >= 0 && frame < options_.frames);
    return motion_.PoseAt(FrameTime(options_, frame), unit, shaking);
}

Isometry3d SimulatedRig::CameraPoseAt(int camera_index, int frame) const {
    const SimulatedCameraGeometry& at = camera(camera_index);
    return PoseAt(frame, at.unit) * at.geometry.T_unit_camera;
}

double SimulatedRig::HitchAngleAt(int frame) const {
    return motion_.HitchAngleAt(FrameTime(options_, frame));
}

double SimulatedRig::HitchAngleAt(hal::Instant since_start) const {
    return motion_.HitchAngleAt(since_start);
}

double SimulatedRig::ArticulationAt(int frame) const {
    const Vector3d forward_of_trailer = PoseAt(frame, algo::Unit::kTractor).linear().transpose() *
                                        PoseAt(frame, algo::Unit::kTrailer).linear().col(0);
    return std::atan2(forward_of_trailer.y(), forward_of_trailer.x());
}

Outlook SimulatedRig::OutlookOf(int camera_index, int frame) const {
    return {world_, CameraPoseAt(camera_index, frame).translation(), MomentOf(frame)};
}

std::optional<SimulatedRig::SeenPoint> SimulatedRig::WorldPointAt(int camera_index, int frame,
                                                                  const Vector2d& pixel) const {
    return WorldPointAt(camera_index, frame, pixel, OutlookOf(camera_index, frame));
}

std::optional<SimulatedRig::SeenPoint> SimulatedRig::WorldPointAt(int camera_index, int frame,
                                                                  const Vector2d& pixel,
                                                                  const Outlook& outlook) const {
    const auto ray_camera = camera(camera_index).geometry.model.Unproject(pixel);
    if (!ray_camera) return std::nullopt;
    const Isometry3d T_world_camera = CameraPoseAt(camera_index, frame);
    const Vector3d ray_world = T_world_camera.linear() * *ray_camera;
    const double distance_m = std::min(outlook.DistanceTo(ray_world), kFar_m);
    return SeenPoint{T_world_camera.translation() + distance_m * ray_world, distance_m};
}

std::optional<Vector2d> SimulatedRig::ProjectWorldPoint(int camera_index, int frame,
                                                        const Vector3d& p_world_m,
                                                        Occlusion occlusion) const {
    const algo::CameraModel& lens = camera(camera_index).geometry.model;
    const Isometry3d T_world_camera = CameraPoseAt(camera_index, frame);
    const auto pixel = lens.Project(T_world_camera.inverse() * p_world_m);
    if (!pixel || !InImage(lens, *pixel)) return std::nullopt;
    if (occlusion == Occlusion::kTested && !OutlookOf(camera_index, frame).IsFreeTo(p_world_m))
        return std::nullopt;
    return pixel;
}

}  // namespace hitchview::drivers

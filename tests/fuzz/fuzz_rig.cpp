#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "app/config.hpp"
#include "calib/rig_calibration.hpp"
#include "hal/expect.hpp"
#include "tests/fuzz/fuzz_bytes.hpp"
#include "tests/fuzz/fuzz_complaint.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace hitchview;
using app::RigConfig;
using Projection = app::CanvasConfig::Projection;

bool IsIn(double number, double min, double max) {
    return number >= min && number <= max;
}

bool IsSize(const app::Size& size, double widest, double highest) {
    return IsIn(size.width_px, 64, widest) && IsIn(size.height_px, 64, highest) &&
           size.width_px % 2 == 0 && size.height_px % 2 == 0;
}

void ExpectCanvas(const app::CanvasConfig& canvas) {
    HV_EXPECT(IsSize(canvas.size_px, 8192, 4096));
    HV_EXPECT(IsIn(canvas.horizon, 0, 1) && IsIn(canvas.radius_m, 1, 1000));
    HV_EXPECT(IsIn(canvas.viewpoint_m, 0.5, 10) && IsIn(canvas.ground_m, -3, 0));
}

void ExpectCamera(const app::CameraConfig& camera) {
    HV_EXPECT(calib::IsName(camera.name));
    HV_EXPECT(IsSize(camera.live.size_px, 4096, 4096) && IsIn(camera.live.input, -1, 63));
    HV_EXPECT(camera.live.buffers == 0 || IsIn(camera.live.buffers, 2, 32));
    HV_EXPECT(camera.live.rotation_deg == 0 || camera.live.rotation_deg == 180);
    HV_EXPECT(camera.IsLive() == !camera.live.device.empty());
    for (const app::ControlConfig& control : camera.live.controls)
        HV_EXPECT(!control.value.empty());
}

void ExpectUnits(const RigConfig& rig) {
    std::set<std::string> names;
    std::size_t cameras = 0;
    for (const algo::Unit unit : algo::kUnits) {
        for (const app::CameraConfig& camera : rig.units[unit].cameras) {
            ExpectCamera(camera);
            HV_EXPECT(names.insert(camera.name).second && camera.IsLive() == rig.IsLive());
        }
        cameras += rig.units[unit].cameras.size();
        HV_EXPECT(rig.canvas.projection == Projection::kCylinder ||
                  rig.units[unit].cameras.size() <= 1);
    }
    HV_EXPECT(rig.HasUnit(algo::Unit::kTractor) && cameras <= app::kMaxCameras);
}

void ExpectSimulation(const app::SimulationConfig& simulation) {
    HV_EXPECT(IsIn(simulation.frames.value_or(1), 1, 36000));
    HV_EXPECT(!simulation.camera_size_px || IsSize(*simulation.camera_size_px, 4096, 4096));
    HV_EXPECT(IsIn(simulation.speed_mps.value_or(0), 0, 30));
    HV_EXPECT(IsIn(simulation.noise.value_or(0), 0, 50));
    for (const algo::Unit unit : algo::kUnits)
        HV_EXPECT(IsIn(simulation.shake[unit].value_or(0), 0, 5));
}

void ExpectMethod(const RigConfig& rig) {
    HV_EXPECT(IsIn(rig.stabilization.lookahead_frames, 0, app::kMaxLookaheadFrames));
    HV_EXPECT(IsIn(rig.stabilization.cropping, 0.5, 1) && IsIn(rig.stitching.kappa, 0, 1));
    if (!rig.placement) return;
    for (const algo::Unit unit : algo::kUnits) {
        HV_EXPECT(IsIn((*rig.placement)[unit].x_px, -8192, 8192));
        HV_EXPECT(IsIn((*rig.placement)[unit].y_px, -8192, 8192));
    }
}

void ExpectTiming(const RigConfig& rig) {
    using std::chrono::milliseconds;
    const auto period = rig.period.value_or(app::kDefaultPeriod);
    HV_EXPECT(period >= milliseconds(1) && period <= milliseconds(1000));
    HV_EXPECT(!rig.set_tolerance || *rig.set_tolerance >= milliseconds(1));
    HV_EXPECT(!rig.set_tolerance || *rig.set_tolerance <= period);
    HV_EXPECT(!rig.set_tolerance || rig.IsLive());
    HV_EXPECT(IsIn(rig.workers, 1, app::kMaxWorkers) && IsIn(rig.schedule.priority, 0, 99));
    HV_EXPECT(rig.schedule.affinity.size() <= app::kMaxCpus);
    for (const int cpu : rig.schedule.affinity) HV_EXPECT(IsIn(cpu, 0, app::kMaxCpus - 1));
}

void ExpectCan(const app::CanConfig& can) {
    const app::HitchAngleSignal& signal = can.hitch_angle;
    HV_EXPECT(IsIn(can.receive_buffer_bytes, 4096, 1 << 26));
    HV_EXPECT(signal.id <= 0x1fffffff && IsIn(signal.start_bit, 0, 511));
    HV_EXPECT(IsIn(signal.length_bits, 1, 32));
    HV_EXPECT(signal.factor_deg != 0 && IsIn(signal.factor_deg, -1000, 1000));
    HV_EXPECT(IsIn(signal.offset_deg, -100'000, 100'000) && IsIn(signal.min_deg, -360, 360));
    HV_EXPECT(IsIn(signal.max_deg, signal.min_deg, 360));
    HV_EXPECT(IsIn(signal.max_rate_deg_s, 0, 10'000));
    HV_EXPECT(IsIn(static_cast<double>(signal.max_age.count()), 0, 60'000));
}

void ExpectChannel(const std::string& channel, std::set<std::string>& channels) {
    HV_EXPECT(calib::IsName(channel) && channel.size() <= 63 && channels.insert(channel).second);
}

void ExpectViewport(const app::ViewportConfig& view, const app::PublishConfig& publish, bool ring) {
    HV_EXPECT(IsIn(view.every, 1, 300) && IsIn(view.max_bytes, 20'000, publish.max_bytes));
    HV_EXPECT(view.azimuth_deg.has_value() != view.columns_px.has_value());
    HV_EXPECT(ring || !view.azimuth_deg);
    for (const auto& span : {view.columns_px, view.rows_px})
        HV_EXPECT(!span || (IsIn((*span)[0], 0, 8192) && (*span)[0] < (*span)[1]));
    for (const double azimuth : view.azimuth_deg.value_or(std::array<double, 2>{}))
        HV_EXPECT(IsIn(azimuth, -360, 360));
}

void ExpectPublish(const app::PublishConfig& publish, bool ring) {
    std::set<std::string> channels;
    for (const std::string& channel :
         {publish.panorama_channel, publish.status_channel, publish.hitch_angle_channel,
          publish.event_channel, publish.health_channel, publish.overlay.channel})
        ExpectChannel(channel, channels);
    HV_EXPECT(!publish.url.empty() && IsIn(publish.jpeg_quality, 30, 95));
    HV_EXPECT(IsIn(publish.max_bytes, 20'000, 4'000'000) && publish.viewports.size() <= 8);
    for (const app::ViewportConfig& view : publish.viewports) {
        ExpectChannel(view.channel, channels);
        ExpectViewport(view, publish, ring);
    }
    HV_EXPECT(IsIn(publish.preview.rate_hz, 0, 5) && IsIn(publish.overlay.rate_hz, 0, 5));
}

void ExpectRecord(const app::RecordConfig& record) {
    constexpr double kMost_mb = 1e7;
    HV_EXPECT(IsIn(record.segment_s, 1, 3600) && IsIn(record.quota_mb, 0, kMost_mb));
    HV_EXPECT(IsIn(record.min_free_mb, 0, kMost_mb) && IsIn(record.memory_mb, 8, 16'384));
    HV_EXPECT(IsIn(record.pre_trigger_s, 0, 600) && IsIn(record.after_trigger_s, 0, 86'400));
    HV_EXPECT(IsIn(record.quality, 30, 100) && IsIn(record.every, 1, 1000));
    HV_EXPECT(IsIn(record.threads, 1, 8));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(tests::TextOf({data, size}));
    const auto rig = app::ParseRigConfig({"rig", text}, "/nowhere");
    if (!rig) {
        tests::ExpectComplaint(rig.error(), "rig", tests::LinesOf(text));
        return 0;
    }
    const bool ring = rig.value().canvas.projection == Projection::kCylinder;
    HV_EXPECT(ring != rig.value().calibration.empty());
    ExpectCanvas(rig.value().canvas);
    ExpectUnits(rig.value());
    ExpectSimulation(rig.value().simulation);
    ExpectMethod(rig.value());
    ExpectTiming(rig.value());
    if (rig.value().can) ExpectCan(*rig.value().can);
    ExpectPublish(rig.value().publish, ring);
    ExpectRecord(rig.value().record);
    return 0;
}

#include <gtest/gtest.h>

#include "app/config.hpp"
#include "drivers/simulated_scenario.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using algo::Unit;

/// Each line stands for ten times the one before.
std::string AliasesOfAliases(char lines) {
    std::string text = "a: &a [1]\n";
    for (char name = 'b'; name < 'a' + lines; ++name) {
        text.append(1, name).append(": &").append(1, name).append(" [");
        for (int k = 0; k < 10; ++k) text.append("*").append(1, static_cast<char>(name - 1)) += ',';
        text.append("]\n");
    }
    return text;
}

const std::string kPlane =
    "schema: 1\n"
    "canvas: {projection: plane, size_px: [1100, 520]}\n"
    "units:\n"
    "  tractor: {cameras: [{name: left, source: {replay: left.avi}}]}\n"
    "  trailer: {cameras: [{name: right, source: {replay: /data/right.avi}}]}\n";

const std::string kSimulated =
    "schema: 1\n"
    "canvas: {projection: cylinder}\n"
    "calibration: rig.calib.yaml\n"
    "units:\n"
    "  tractor: {cameras: [{name: a, source: {simulated: true}}]}\n";

class ConfigTest : public testing::Test {
 protected:
    hal::Checked<RigConfig> Load(const std::string& text) {
        return LoadRigConfig(folder_.Write("rig.yaml", text));
    }

    /// The complaints about `text`, with the file's folder left out.
    std::string ErrorOf(const std::string& text) {
        const auto config = Load(text);
        if (config.ok()) return "no error";
        std::string error = config.error();
        const std::string folder = folder_.path() + '/';
        for (auto at = error.find(folder); at != error.npos; at = error.find(folder)) {
            error.erase(at, folder.size());
        }
        return error;
    }

    tests::TemporaryFolder folder_;
};

TEST_F(ConfigTest, AnAliasStandsForWhatItNames) {
    const auto config = Load(kPlane +
                             "publish: {max_bytes: &most 30000, viewports: [{name: a, "
                             "columns_px: [0, 64], max_bytes: *most}]}\n");
    ASSERT_TRUE(config.ok()) << config.error();
    EXPECT_EQ(config.value().publish.viewports.at(0).max_bytes, 30000);
}

TEST_F(ConfigTest, AMinimalPlaneRigGetsItsDefaults) {
    const auto config = Load(kPlane);
    ASSERT_TRUE(config.ok()) << config.error();
    const RigConfig& rig = config.value();
    EXPECT_EQ(rig.canvas.projection, CanvasConfig::Projection::kPlane);
    EXPECT_EQ(rig.canvas.size_px.width_px, 1100);
    EXPECT_EQ(rig.canvas.size_px.height_px, 520);
    EXPECT_TRUE(rig.calibration.empty());
    EXPECT_EQ(rig.stabilization.cropping, 0.90);
    EXPECT_EQ(rig.stabilization.lookahead_frames, 0);
    EXPECT_EQ(rig.stabilization.smoother, StabilizationConfig::Smoother::kRecedingHorizon);
    EXPECT_EQ(rig.publish.panorama_channel, "PANORAMA");
    EXPECT_EQ(rig.workers, 2);
    EXPECT_FALSE(rig.period);
    EXPECT_FALSE(rig.can);
    EXPECT_FALSE(rig.placement);
}

TEST_F(ConfigTest, RelativePathsStandRelativeToTheFile) {
    const auto config = Load(kPlane);
    ASSERT_TRUE(config.ok()) << config.error();
    EXPECT_EQ(config.value().units[Unit::kTractor].cameras.at(0).replay, folder_ / "left.avi");
    EXPECT_EQ(config.value().units[Unit::kTrailer].cameras.at(0).replay, "/data/right.avi");
}

TEST_F(ConfigTest, ATractorWithoutItsTrailerIsARig) {
    const auto config = Load(kSimulated);
    ASSERT_TRUE(config.ok()) << config.error();
    EXPECT_TRUE(config.value().HasUnit(Unit::kTractor));
    EXPECT_FALSE(config.value().HasUnit(Unit::kTrailer));
    EXPECT_EQ(config.value().canvas.size_px.width_px, 2048);
    EXPECT_EQ(config.value().canvas.size_px.height_px, 360);
}

TEST_F(ConfigTest, ALibcameraCameraIsLive) {
    const auto config = Load(
        "schema: 1\ncanvas: {projection: plane, size_px: [640, 360]}\nunits: {tractor: "
        "{cameras: [{name: front, source: {libcamera: platform/vimc.0 Sensor B, size_px: [960, "
        "540], format: yuyv, accept_granted_size: true, buffers: 9, rotation_deg: 180, "
        "controls: {brightness: 0.2, ColourGains: '1.5 2'}}}]}}\n");
    ASSERT_TRUE(config.ok()) << config.error();
    const CameraConfig& camera = config.value().units[Unit::kTractor].cameras.at(0);
    EXPECT_EQ(camera.source, CameraConfig::Source::kLibcamera);
    EXPECT_TRUE(camera.IsLive());
    EXPECT_EQ(camera.live.device, "platform/vimc.0 Sensor B");
    EXPECT_EQ(camera.live.size_px.width_px, 960);
    EXPECT_EQ(camera.live.format, "yuyv");
    EXPECT_TRUE(camera.live.accept_granted_size);
    EXPECT_EQ(camera.live.buffers, 9);
    EXPECT_EQ(camera.live.rotation_deg, 180);
    ASSERT_EQ(camera.live.controls.size(), 2U);
    EXPECT_EQ(camera.live.controls[1].value, "1.5 2");
}

TEST_F(ConfigTest, WhatTheFileSaysReplacesTheDefaults) {
    const auto config =
        Load(kPlane +
             "placement: {tractor: [0, -4], trailer: [540, 6]}\n"
             "stabilization: {border: covered, cropping: 0.8, enabled: false,"
             " lookahead_frames: 10, smoother: paper_weights}\n"
             "stitching: {kappa: 0.25, enabled: false}\n"
             "threads: {workers: 7, priority: 50, affinity: [3, 1]}\n"
             "real_time: {lock_memory: required}\n"
             "period_ms: 40.5\n"
             "can: {source: {simulated: true}, hitch_angle: {id: 0x7A1, start_bit: 7,"
             " length_bits: 12, byte_order: motorola, signed: true, factor_deg: -0.1,"
             " min_deg: -90, max_deg: 80}}\n");
    ASSERT_TRUE(config.ok()) << config.error();
    const RigConfig& rig = config.value();
    EXPECT_EQ(rig.placement->of[0].y_px, -4);
    EXPECT_EQ(rig.placement->of[1].x_px, 540);
    EXPECT_EQ(rig.stabilization.border, StabilizationConfig::Border::kCovered);
    EXPECT_EQ(rig.stabilization.lookahead_frames, 10);
    EXPECT_EQ(rig.stabilization.smoother, StabilizationConfig::Smoother::kPaperWeights);
    EXPECT_FALSE(rig.stabilization.enabled);
    EXPECT_EQ(rig.stitching.kappa, 0.25);
    EXPECT_FALSE(rig.stitching.enabled);
    EXPECT_EQ(rig.workers, 7);
    EXPECT_EQ(rig.schedule.priority, 50);
    EXPECT_EQ(rig.schedule.affinity, (std::vector<int>{3, 1}));
    EXPECT_EQ(rig.real_time.lock_memory, RealTimeConfig::LockMemory::kRequired);
    EXPECT_EQ(*rig.period, std::chrono::microseconds(40500));
    EXPECT_EQ(rig.can->source, CanConfig::Source::kSimulated);
    EXPECT_EQ(rig.can->hitch_angle.id, 0x7A1U);
    EXPECT_EQ(rig.can->hitch_angle.byte_order, HitchAngleSignal::ByteOrder::kMotorola);
    EXPECT_TRUE(rig.can->hitch_angle.is_signed);
    EXPECT_EQ(rig.can->hitch_angle.factor_deg, -0.1);
}

TEST_F(ConfigTest, ALoopedSimulationIsLiveIfTheFileSaysSo) {
    const auto drive = Load(kSimulated);
    EXPECT_FALSE(drive.value().simulation.loop_frames);
    const auto looped = Load(kSimulated + "simulation: {loop_frames: 60, frames: 900}\n");
    ASSERT_TRUE(looped.ok()) << looped.error();
    EXPECT_EQ(looped.value().simulation.loop_frames, 60);
    EXPECT_FALSE(looped.value().IsLive());
    const auto live = Load(kSimulated +
                           "simulation: {loop_frames: 60, live: true}\n"
                           "set_tolerance_ms: 5\n"
                           "can: {source: {simulated: true}, hitch_angle: {id: 1, start_bit: 0, "
                           "length_bits: 8, factor_deg: 1}}\n");
    ASSERT_TRUE(live.ok()) << live.error();
    EXPECT_TRUE(live.value().IsLive());
}

TEST_F(ConfigTest, AMissingFileIsNamed) {
    EXPECT_EQ(LoadRigConfig("no/such/rig.yaml").error(),
              "no/such/rig.yaml: the file cannot be read, must be a readable YAML file");
    EXPECT_FALSE(LoadRigConfig(folder_.path()).ok());
}

TEST_F(ConfigTest, EveryMistakeIsNamedInTheOrderOfTheFile) {
    EXPECT_EQ(ErrorOf(kPlane + "threads: {workers: 99}\nperiod_ms: 0\n"),
              "rig.yaml:6: threads.workers is 99, must be 1 to 16\n"
              "rig.yaml:7: period_ms is 0, must be 1 to 1000");
}

TEST_F(ConfigTest, RandomBytesAndNestingWithoutEndAreErrors) {
    EXPECT_FALSE(Load(std::string(100000, '[')).ok());
    EXPECT_FALSE(Load(std::string("\x00\xff\xfe{:\t&a *a", 11)).ok());
    EXPECT_FALSE(Load("&a [*a, *a]").ok());
    EXPECT_FALSE(Load(kPlane + "\n...\n, more\n").ok());
    EXPECT_FALSE(Load(", more\n" + kPlane).ok());
    EXPECT_FALSE(Load(std::string((1 << 20) + 1, ' ')).ok());
}

struct BadFile {
    std::string text;
    std::string error;
};

void PrintTo(const BadFile& file, std::ostream* out) {
    *out << '\n' << file.text;
}

class BadConfigTest : public ConfigTest, public testing::WithParamInterface<BadFile> {};

TEST_P(BadConfigTest, IsRefusedWithFileLineKeyValueAndRange) {
    EXPECT_EQ(ErrorOf(GetParam().text), GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
    PlaneRig, BadConfigTest,
    testing::Values(
        BadFile{kPlane + "stabilisation: {}\n",
                "rig.yaml:6: stabilisation is no key, must be one of schema, canvas, calibration, "
                "units, simulation, stabilization, stitching, placement, threads, real_time, "
                "period_ms, set_tolerance_ms, can, publish, "
                "record"},
        BadFile{kPlane + "threads: {priority: 100, affinity: [0, -1]}\n"
                         "real_time: {lock_memory: always}\n",
                "rig.yaml:6: threads.priority is 100, must be 0 to 99\n"
                "rig.yaml:6: threads.affinity[1] is -1, must be 0 to 255\n"
                "rig.yaml:7: real_time.lock_memory is always, must be one of false, try, required"},
        BadFile{kPlane + "stabilization: {lookahead: 3}\n",
                "rig.yaml:6: stabilization.lookahead is no key, must be one of enabled, "
                "lookahead_frames, border, cropping, smoother"},
        BadFile{kPlane + "stabilization:\n  lookahead_frames: 11\n",
                "rig.yaml:7: stabilization.lookahead_frames is 11, must be 0 to 10"},
        BadFile{kPlane + "stabilization: {lookahead_frames: 2.5}\n",
                "rig.yaml:6: stabilization.lookahead_frames is 2.5, must be a whole number, "
                "0 to 10"},
        BadFile{kPlane + "stabilization: {lookahead_frames: \"3\"}\n",
                "rig.yaml:6: stabilization.lookahead_frames is \"3\", must be a whole number, "
                "0 to 10"},
        BadFile{kPlane + "stabilization: {cropping: .nan}\n",
                "rig.yaml:6: stabilization.cropping is .nan, must be a number, 0.5 to 1"},
        BadFile{kPlane + "stabilization: {cropping: nan}\n",
                "rig.yaml:6: stabilization.cropping is nan, must be 0.5 to 1"},
        BadFile{kPlane + "stabilization: {border: open}\n",
                "rig.yaml:6: stabilization.border is open, must be one of free, covered"},
        BadFile{kPlane + "stabilization: {smoother: kalman}\n",
                "rig.yaml:6: stabilization.smoother is kalman, must be one of receding_horizon, "
                "paper_weights"},
        BadFile{kPlane + "stabilization: {enabled: yes}\n",
                "rig.yaml:6: stabilization.enabled is yes, must be one of false, true"},
        BadFile{kPlane + "stabilization: 5\n", "rig.yaml:6: stabilization is 5, must be a map"},
        BadFile{kPlane + "stabilization:\n", "rig.yaml:6: stabilization is empty, must be a map"},
        BadFile{kPlane + "stitching: {kappa: -0.1}\n",
                "rig.yaml:6: stitching.kappa is -0.1, must be 0 to 1"},
        BadFile{kPlane + "threads: {workers: 1}\nthreads: {workers: 2}\n",
                "rig.yaml:7: threads is given twice, must be given once"},
        BadFile{kPlane + "period_ms: 1001\n", "rig.yaml:6: period_ms is 1001, must be 1 to 1000"},
        BadFile{kPlane + "calibration: rig.calib.yaml\n",
                "rig.yaml:6: calibration is rig.calib.yaml, must be absent with canvas.projection "
                "plane"},
        BadFile{kPlane + "simulation: {seed: 1}\n",
                "rig.yaml:6: simulation is a map, must be absent unless a camera has the source "
                "{simulated: true}"},
        BadFile{kPlane + "placement: {tractor: [0, 0]}\n",
                "rig.yaml:6: placement.trailer is missing, must be a list of 2"},
        BadFile{kPlane + "placement: {tractor: [0, 0], trailer: [0, 9000]}\n",
                "rig.yaml:6: placement.trailer[1] is 9000, must be -8192 to 8192"},
        BadFile{kPlane + "--- \nschema: 1\n",
                "rig.yaml:1: the file does not have one document, must be one"},
        BadFile{"", "rig.yaml:1: the file does not have one document, must be one"},
        BadFile{"just words\n", "rig.yaml:1: the file is just words, must be a map"},
        BadFile{"schema: 1\ncanvas: {size_px: [1, 2}\n",
                "rig.yaml:2: the file is not YAML (illegal flow end), must be YAML"},
        BadFile{
            kPlane + "x: &a [1, *a]\n",
            "rig.yaml:6: the file is not YAML (an alias within what it stands for), must be YAML"},
        BadFile{kPlane + "x: [" + std::string(64, '[') + "\n",
                "rig.yaml:6: the file is not YAML (more than 64 levels, aliases followed), must be "
                "YAML"},
        BadFile{kPlane + AliasesOfAliases(8),
                "rig.yaml:12: the file is not YAML (more than 1048576 values, aliases followed), "
                "must be YAML"},
        BadFile{kPlane + "real_time: {\"a\\nb\": 1}\n",
                "rig.yaml:6: real_time.a?b is no key, must be one of lock_memory"},
        BadFile{"schema: 2\n" + kPlane.substr(10), "rig.yaml:1: schema is 2, must be 1"},
        BadFile{kPlane.substr(10), "rig.yaml:1: schema is missing, must be 1"}));

std::string Plane(const std::string& canvas, const std::string& tractor) {
    return "schema: 1\n" + canvas + "\nunits: {tractor: " + tractor + "}\n";
}
const std::string kCanvas = "canvas: {size_px: [640, 480]}";
const std::string kTractor = "{cameras: [{name: a, source: {replay: a.avi}}]}";

INSTANTIATE_TEST_SUITE_P(
    CanvasAndUnits, BadConfigTest,
    testing::Values(
        BadFile{"schema: 1\nunits: {tractor: " + kTractor + "}\n",
                "rig.yaml:1: canvas.size_px is missing, must be a list of 2"},
        BadFile{Plane("canvas: {size_px: [641, 480]}", kTractor),
                "rig.yaml:2: canvas.size_px[0] is 641, must be 64 to 8192 and even"},
        BadFile{Plane("canvas: {size_px: [640, 4098]}", kTractor),
                "rig.yaml:2: canvas.size_px[1] is 4098, must be 64 to 4096 and even"},
        BadFile{Plane("canvas: {size_px: [640]}", kTractor),
                "rig.yaml:2: canvas.size_px is a list of 1, must be a list of 2"},
        BadFile{Plane("canvas: {size_px: 640}", kTractor),
                "rig.yaml:2: canvas.size_px is 640, must be a list of 2"},
        BadFile{Plane("canvas: {size_px: [640, 480], horizon: 0.5}", kTractor),
                "rig.yaml:2: canvas.horizon is 0.5, must be absent with projection plane"},
        BadFile{Plane("canvas: {projection: sphere, size_px: [640, 480]}", kTractor),
                "rig.yaml:2: canvas.projection is sphere, must be one of plane, cylinder"},
        BadFile{"schema: 1\n" + kCanvas + "\n", "rig.yaml:1: units is missing, must be a map"},
        BadFile{"schema: 1\n" + kCanvas + "\nunits: {trailer: " + kTractor + "}\n",
                "rig.yaml:3: units.tractor is missing, must be a map"},
        BadFile{Plane(kCanvas, "{cameras: []}"),
                "rig.yaml:3: units.tractor.cameras is a list of 0, must be a list of 1 to 8"},
        BadFile{Plane(kCanvas, "{cameras: [{name: a b, source: {replay: a}}]}"),
                "rig.yaml:3: units.tractor.cameras[0].name is a b, must be letters, digits and _ "
                "only"},
        BadFile{Plane(kCanvas, "{cameras: [{source: {replay: a}}]}"),
                "rig.yaml:3: units.tractor.cameras[0].name is missing, must be text"},
        BadFile{Plane(kCanvas, "{cameras: [{name: a}]}"),
                "rig.yaml:3: units.tractor.cameras[0].source is missing, must be a map"},
        BadFile{Plane(kCanvas, "{cameras: [{name: a, source: {rtsp: a}}]}"),
                "rig.yaml:3: units.tractor.cameras[0].source is a map, must be a map with exactly "
                "one of simulated, replay, v4l2 and libcamera\n"
                "rig.yaml:3: units.tractor.cameras[0].source.rtsp is no key, must be one of "
                "simulated, replay, v4l2, libcamera"},
        BadFile{Plane(kCanvas, "{cameras: [{name: a, source: {v4l2: a}}]}"),
                "rig.yaml:3: units.tractor.cameras[0].source.v4l2 is a, must be the absolute path "
                "of a device, best one of /dev/v4l/by-path"},
        BadFile{Plane(kCanvas, "{cameras: [{name: a, source: {v4l2: /dev/a, libcamera: a}}]}"),
                "rig.yaml:3: units.tractor.cameras[0].source is a map, must be a map with exactly "
                "one of simulated, replay, v4l2 and libcamera"},
        BadFile{Plane(kCanvas, "{cameras: [{name: a, source: {libcamera: a, format: mjpeg}}]}"),
                "rig.yaml:3: units.tractor.cameras[0].source.format is mjpeg, must be one of best, "
                "nv12, uyvy, yuyv, rgb888, bgr888, grey"},
        BadFile{Plane(kCanvas, "{cameras: [{name: a, source: {libcamera: a, input: 1}}]}"),
                "rig.yaml:3: units.tractor.cameras[0].source.input is no key, must be one of "
                "simulated, "
                "replay, v4l2, libcamera, size_px, buffers, rotation_deg, flip, controls, format, "
                "accept_granted_size"},
        BadFile{Plane(kCanvas, "{cameras: [{name: a, source: {simulated: false}}]}"),
                "rig.yaml:3: units.tractor.cameras[0].source.simulated is false, must be true"},
        BadFile{Plane(kCanvas,
                      "{cameras: [{name: a, source: {replay: a}}, {name: b, source: {replay: "
                      "b}}]}"),
                "rig.yaml:3: units.tractor.cameras is a list of 2, must be a list of 1 with "
                "projection plane"},
        BadFile{kSimulated + "  trailer: {cameras: [{name: a, source: {simulated: true}}]}\n",
                "rig.yaml:6: units.trailer.cameras[0].name is a, must be unique in the rig"},
        BadFile{"schema: 1\ncanvas: {projection: cylinder}\n" + kSimulated.substr(68),
                "rig.yaml:1: calibration is missing, must be text"},
        BadFile{kSimulated + "placement: {tractor: [0, 0]}\n",
                "rig.yaml:6: placement is a map, must be absent with projection cylinder"}));

INSTANTIATE_TEST_SUITE_P(
    SimulationCanAndPublish, BadConfigTest,
    testing::Values(
        BadFile{kSimulated + "simulation: {seed: -1}\n",
                "rig.yaml:6: simulation.seed is -1, must be 0 to 4294967295"},
        BadFile{kSimulated + "simulation: {camera_size_px: [480, 640]}\n",
                "rig.yaml:6: simulation.camera_size_px is a list of 2, must be at least as wide as "
                "high"},
        BadFile{kSimulated + "simulation: {profile: zigzag}\n",
                "rig.yaml:6: simulation.profile is zigzag, must be one of straight, slalom, "
                "turn_left, turn_right"},
        BadFile{kSimulated + "simulation: {loop_frames: 1}\n",
                "rig.yaml:6: simulation.loop_frames is 1, must be 2 to 600"},
        BadFile{kSimulated + "simulation: {loop_frames: 601, live: maybe}\n",
                "rig.yaml:6: simulation.loop_frames is 601, must be 2 to 600\n"
                "rig.yaml:6: simulation.live is maybe, must be one of false, true"},
        BadFile{kSimulated + "simulation: {live: true}\n",
                "rig.yaml:6: simulation.live is true, must be absent or false without "
                "loop_frames"},
        BadFile{kSimulated + "simulation: {loop_frames: 9, live: true, frames: 30}\n",
                "rig.yaml:6: simulation.frames is 30, must be absent with live: true, which goes "
                "on until it is stopped"},
        BadFile{kSimulated + "  trailer: {cameras: [{name: b, source: {replay: b.avi}}]}\n"
                             "simulation: {loop_frames: 9, live: true}\n",
                "rig.yaml:7: simulation.live is true, must be absent or false beside cameras that "
                "are not simulated"},
        BadFile{kSimulated + "simulation: {loop_frames: 9, live: true}\n"
                             "can: {source: {candump: a.log}, hitch_angle: {id: 1, start_bit: 0, "
                             "length_bits: 8, factor_deg: 1}}\n",
                "rig.yaml:7: can is a map, must be a map with the source {simulated: true} or "
                "{socketcan: NAME} with simulation.live"},
        BadFile{kSimulated + "simulation: {loop_frames: 9}\nset_tolerance_ms: 5\n",
                "rig.yaml:7: set_tolerance_ms is 5, must be absent unless the cameras are live "
                "(v4l2, libcamera, simulation.live)"},
        BadFile{kSimulated + "simulation: {shake: {trailer: 6}}\n",
                "rig.yaml:6: simulation.shake.trailer is 6, must be 0 to 5"},
        BadFile{kSimulated + "can: {source: {candump: a.log}}\n",
                "rig.yaml:6: can.hitch_angle is missing, must be a map"},
        BadFile{kSimulated + "can: {source: {simulated: true}, hitch_angle: {id: 0x20000000, "
                             "start_bit: 0, length_bits: 8, factor_deg: 1}}\n",
                "rig.yaml:6: can.hitch_angle.id is 0x20000000, must be 0 to 536870911"},
        BadFile{kSimulated + "can: {source: {simulated: true}, hitch_angle: {id: 1, start_bit: 0, "
                             "length_bits: 8, factor_deg: 0}}\n",
                "rig.yaml:6: can.hitch_angle.factor_deg is 0, must be other than 0"},
        BadFile{kSimulated + "can: {source: {simulated: true}, hitch_angle: {id: 1, start_bit: 0, "
                             "length_bits: 8, factor_deg: 1, max_deg: -130}}\n",
                "rig.yaml:6: can.hitch_angle.max_deg is -130, must be greater than min_deg"},
        BadFile{kSimulated + "publish: {jpeg_quality: 96}\n",
                "rig.yaml:6: publish.jpeg_quality is 96, must be 30 to 95"},
        BadFile{kSimulated + "publish: {max_bytes: 100}\n",
                "rig.yaml:6: publish.max_bytes is 100, must be 20000 to 4000000"},
        BadFile{kSimulated + "publish: {url: \"\"}\n",
                "rig.yaml:6: publish.url is \"\", must be text"},
        BadFile{kSimulated + "publish: {status_channel: PANORAMA}\n",
                "rig.yaml:6: publish.status_channel is PANORAMA, must be a channel of its own"},
        BadFile{kSimulated + "publish: {viewports: [{name: rear, azimuth_deg: [1, 400]}]}\n",
                "rig.yaml:6: publish.viewports[0].azimuth_deg[1] is 400, must be -360 to 360"},
        BadFile{kSimulated + "publish: {viewports: [{name: rear}]}\n",
                "rig.yaml:6: publish.viewports[0].azimuth_deg is missing, must be a list of 2"},
        BadFile{kSimulated + "publish: {viewports: [{name: a b, azimuth_deg: [1, 0]}]}\n",
                "rig.yaml:6: publish.viewports[0].name is a b, must be letters, digits and _, at "
                "most 58"},
        BadFile{kSimulated + "publish: {viewports: [{name: x, azimuth_deg: [1, 0]}, {name: X, "
                             "azimuth_deg: [1, 0]}]}\n",
                "rig.yaml:6: publish.viewports[1].name is X, must be a name of its own"},
        BadFile{kPlane + "publish: {viewports: [{name: x, azimuth_deg: [1, 0]}]}\n",
                "rig.yaml:6: publish.viewports[0].azimuth_deg is a list of 2, must be absent with "
                "projection plane"},
        BadFile{
            kPlane + "publish: {viewports: [{name: x, columns_px: [50, 20]}]}\n",
            "rig.yaml:6: publish.viewports[0].columns_px is a list of 2, must be two numbers, the "
            "first smaller"},
        BadFile{kSimulated + "publish: {preview: {rate_hz: 6}}\n",
                "rig.yaml:6: publish.preview.rate_hz is 6, must be 0 to 5"},
        BadFile{kSimulated + "publish: {overlay: {channel: PANORAMA}}\n",
                "rig.yaml:6: publish.overlay.channel is PANORAMA, must be a channel of its own"},
        BadFile{kSimulated + "publish: {status_channel: a/b}\n",
                "rig.yaml:6: publish.status_channel is a/b, must be an LCM channel: letters, "
                "digits and _, at most 63 characters"},
        BadFile{kSimulated + "record: {segment_s: 0}\n",
                "rig.yaml:6: record.segment_s is 0, must be 1 to 3600"},
        BadFile{kSimulated + "record: {format: png}\n",
                "rig.yaml:6: record.format is png, must be one of jpeg, raw"},
        BadFile{kSimulated + "record: {trigger: camera_lost}\n",
                "rig.yaml:6: record.trigger is camera_lost, must be absent without "
                "pre_trigger_s"}));

TEST_F(ConfigTest, TheFolderOfRecordingsStandsRelativeToTheFile) {
    const auto config = Load(kSimulated +
                             "record: {folder: drives, pre_trigger_s: 30, after_trigger_s: 60, "
                             "trigger: camera_lost, format: raw, every: 3}\n");
    ASSERT_TRUE(config) << config.error();
    const RecordConfig& record = config.value().record;
    EXPECT_EQ(record.folder, folder_.path() + "/drives");
    EXPECT_EQ(record.pre_trigger_s, 30);
    EXPECT_EQ(record.after_trigger_s, 60);
    EXPECT_EQ(record.trigger, RecordConfig::Trigger::kCameraLost);
    EXPECT_EQ(record.format, RecordConfig::Format::kRaw);
    EXPECT_EQ(record.every, 3);
    EXPECT_TRUE(Load(kSimulated).value().record.folder.empty());
    const auto fault = Load(kSimulated + "record: {pre_trigger_s: 9, trigger: camera_fault}\n");
    ASSERT_TRUE(fault) << fault.error();
    EXPECT_EQ(fault.value().record.trigger, RecordConfig::Trigger::kCameraFault);
}

TEST(RigExampleTest, LoadsAndShowsTheDefaults) {
    const auto config = LoadRigConfig(HITCHVIEW_SOURCE_DIR "/docs/rig.example.yaml");
    ASSERT_TRUE(config.ok()) << config.error();
    const RigConfig& rig = config.value();
    const RigConfig defaults;
    EXPECT_EQ(rig.canvas.horizon, defaults.canvas.horizon);
    EXPECT_EQ(rig.canvas.radius_m, defaults.canvas.radius_m);
    EXPECT_EQ(rig.canvas.viewpoint_m, defaults.canvas.viewpoint_m);
    EXPECT_EQ(rig.canvas.ground_m, defaults.canvas.ground_m);
    EXPECT_EQ(rig.stabilization.cropping, defaults.stabilization.cropping);
    EXPECT_EQ(rig.stitching.kappa, defaults.stitching.kappa);
    EXPECT_EQ(rig.simulation.scenario, defaults.simulation.scenario);
    const drivers::SimulationOptions& simulation =
        drivers::FindScenario(defaults.simulation.scenario)->options;
    EXPECT_EQ(rig.simulation.frames, simulation.frames);
    EXPECT_EQ(rig.simulation.profile, SimulationConfig::Profile::kSlalom);
    EXPECT_EQ(rig.simulation.camera_size_px->width_px, simulation.width_px);
    EXPECT_EQ(rig.simulation.speed_mps, simulation.speed_mps);
    EXPECT_EQ(rig.simulation.noise, simulation.noise_sigma);
    for (const drivers::Scenario& scenario : drivers::Scenarios()) {
        EXPECT_NE(
            tests::FileText(HITCHVIEW_SOURCE_DIR "/docs/rig.example.yaml").find(scenario.name),
            std::string::npos)
            << scenario.name;
    }
    EXPECT_EQ(rig.workers, defaults.workers);
    EXPECT_EQ(rig.publish.url, defaults.publish.url);
    EXPECT_EQ(rig.publish.jpeg_quality, defaults.publish.jpeg_quality);
    EXPECT_EQ(rig.publish.max_bytes, defaults.publish.max_bytes);
    EXPECT_EQ(rig.can->hitch_angle.id, 0x18ff7a27U);
}

class RigExampleKeysTest : public ConfigTest, public testing::WithParamInterface<std::string> {};

/// The reader itself lists the keys of a section when it meets one that it does not know.
TEST_P(RigExampleKeysTest, EveryKeyOfTheSectionIsShown) {
    const std::string example = tests::FileText(HITCHVIEW_SOURCE_DIR "/docs/rig.example.yaml");
    const std::string error = ErrorOf(kSimulated + GetParam());
    const std::string before = "x is no key, must be one of ";
    const auto start = error.find(before);
    ASSERT_NE(start, error.npos) << error;
    std::istringstream keys(error.substr(start + before.size()));
    for (std::string key; keys >> key;) {
        if (key.back() == ',') key.pop_back();
        EXPECT_NE(example.find(key + ":"), example.npos) << key;
        if (keys.peek() == '\n') break;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Sections, RigExampleKeysTest,
    testing::Values("x: 1\n",
                    "  trailer: {cameras: [{name: b, source: {v4l2: /dev/b, "
                    "x: 1}}]}\n",
                    "simulation: {x: 1}\n", "stabilization: {x: 1}\n", "stitching: {x: 1}\n",
                    "threads: {x: 1}\n", "real_time: {x: 1}\n", "can: {x: 1}\n",
                    "publish: {viewports: [{x: 1}]}\n", "publish: {preview: {x: 1}}\n",
                    "publish: {overlay: {x: 1}}\n", "can: {hitch_angle: {x: 1}}\n",
                    "publish: {x: 1}\n", "record: {x: 1}\n"));

}  // namespace
}  // namespace hitchview::app

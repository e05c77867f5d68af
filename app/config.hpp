#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "algo/unit.hpp"
#include "app/thread_schedule.hpp"
#include "calib/rig_calibration.hpp"
#include "hal/frame.hpp"
#include "hal/result.hpp"

/// What rig.yaml says. docs/rig.example.yaml shows every key; ranges stand in square brackets.
namespace hitchview::app {

inline constexpr int kMaxCameras = 8;
inline constexpr int kMaxLookaheadFrames = 10;
inline constexpr int kMaxWorkers = 16;
inline constexpr int kMaxCpus = 256;
/// Of cameras and recordings whose pace nobody says.
inline constexpr std::chrono::nanoseconds kDefaultPeriod{33'333'333};

struct Size {
    int width_px = 0;
    int height_px = 0;
};

struct CanvasConfig {
    enum class Projection {
        kPlane,     ///< one camera per unit, no calibration
        kCylinder,  ///< 360 degrees around the tractor
    };

    Projection projection = Projection::kPlane;
    Size size_px{};            ///< even, [64, 8192] x [64, 4096]; cylinder: 2048 x 360 unless given
    double horizon = 0.48;     ///< cylinder: share of the height above the horizon. [0, 1]
    double radius_m = 1000.0;  ///< cylinder: distance at which the calibration aligns. [1, 1000]
    double viewpoint_m = 1.7;  ///< cylinder: height it is seen from, in the unit frame. [0.5, 10]
    double ground_m = -0.4;    ///< cylinder: height of the ground in the unit frame. [-3, 0]
};

/// A setting of a device. What there is, and its range, the device knows.
struct ControlConfig {
    std::string name{};
    std::string value{};  ///< a number, true or false, or the text of a menu's entry
};

/// A camera that runs at its own pace.
struct LiveCameraConfig {
    std::string device{};     ///< absolute path; kLibcamera: libcamera's id
    Size size_px{1280, 720};  ///< even, [64, 4096]
    /// best, nv12, nm12, uyvy, yuyv, mjpeg, grey; kLibcamera: best, nv12, uyvy, yuyv, rgb888,
    /// bgr888, grey
    std::string format = "best";
    bool accept_granted_size = false;  ///< another size than asked for will do; kLibcamera only
    int input = -1;        ///< of a device with several. [0, 63]; -1: the one selected; kV4l2 only
    int buffers = 0;       ///< [2, 32]; 0: what the program holds and what the device needs
    int rotation_deg = 0;  ///< 0 or 180
    bool horizontal_flip = false;
    bool vertical_flip = false;
    std::vector<ControlConfig> controls{};  ///< in the order of the file
};

/// A camera of a recording: where its frames are, and what they are. No rig file says it, the
/// recording does.
struct LogCameraConfig {
    std::size_t recording = 0;  ///< of LogConfig::recordings
    std::string channel{};
    hal::FrameFormat format{};
    bool compressed = false;  ///< JPEG; `format` is what it becomes
};

/// Recordings in place of a vehicle.
struct LogConfig {
    std::vector<std::vector<std::filesystem::path>> recordings{};  ///< segments of each, in order
    std::int64_t from_us = 0;             ///< since the epoch; events before are passed over
    std::optional<std::int64_t> to_us{};  ///< this event and later ones too
    /// All cameras' frames carry the moment of their capture; otherwise the time of their messages
    /// is taken for it.
    bool stamped = true;
    /// That the recording must keep to its end, where the calibration is its own; otherwise empty.
    std::string calibration_id{};
};

struct CameraConfig {
    enum class Source { kReplay, kSimulated, kV4l2, kLibcamera, kLog };

    std::string name{};  ///< letters, digits and _; unique in the rig
    Source source = Source::kReplay;
    std::filesystem::path replay{};  ///< video file, image sequence or LCM log; kReplay only
    LogCameraConfig log{};           ///< kLog only
    LiveCameraConfig live{};         ///< kV4l2 and kLibcamera only

    [[nodiscard]] bool IsLive() const {
        return source == Source::kV4l2 || source == Source::kLibcamera;
    }
    /// A video file or pictures; otherwise `replay` is an LCM log.
    [[nodiscard]] bool ReadsPictures() const {
        return source == Source::kReplay && replay.extension() != ".lcm";
    }
};

struct UnitConfig {
    std::vector<CameraConfig> cameras{};  ///< [1, 8]; empty: the rig has no such unit
};

/// The drive that simulated cameras see. What is not given is the scenario's.
struct SimulationConfig {
    enum class Profile { kStraight, kSlalom, kTurnLeft, kTurnRight };

    std::string scenario = "slalom";  ///< which there are, the simulation knows
    std::optional<std::uint32_t> seed{};
    std::optional<int> frames{};  ///< [1, 36000]; with loop_frames [1, 36000000]
    std::optional<Profile> profile{};
    std::optional<Size> camera_size_px{};          ///< even, [64, 4096]; landscape
    std::optional<double> speed_mps{};             ///< throughout. [0, 30]
    algo::PerUnit<std::optional<double>> shake{};  ///< share of the scenario's vibration. [0, 5]
    std::optional<double> noise{};                 ///< standard deviation, grey levels. [0, 50]
    /// Only so many of its first frames are rendered, at the start, and shown forth and back until
    /// there were `frames`. [2, 600]
    std::optional<int> loop_frames{};
    /// The cameras run at their own pace and without an end; with loop_frames, without frames only.
    bool live = false;
};

struct StabilizationConfig {
    enum class Border {
        kFree,     ///< uncovered pixels show 'no data'
        kCovered,  ///< zoomed by 1 / cropping, or more, until the canvas is filled
    };
    enum class Smoother {
        kRecedingHorizon,  ///< plans ahead, knows its walls
        kPaperWeights,     ///< the paper's weights made causal, for comparison
    };

    bool enabled = true;
    int lookahead_frames = 0;  ///< frames seen before one is shown; each costs a period. [0, 10]
    Border border = Border::kFree;
    double cropping = 0.90;  ///< share of width and height that stays in view. [0.5, 1]
    Smoother smoother = Smoother::kRecedingHorizon;
};

struct StitchingConfig {
    bool enabled = true;
    double kappa = 0.5;  ///< who gives way: 0 the trailer alone, 1 the tractor alone. [0, 1]
};

/// Top-left corner of a unit's view on a plane canvas.
struct Corner {
    int x_px = 0;  ///< [-8192, 8192]
    int y_px = 0;
};
using Placement = algo::PerUnit<Corner>;

enum class CanByteOrder { kMotorola, kIntel };

/// Where a number stands in a CAN frame.
struct CanField {
    int start_bit = 0;     ///< as in DBC files. [0, 511]
    int length_bits = 16;  ///< [1, 32]
    CanByteOrder byte_order = CanByteOrder::kIntel;
    bool is_signed = false;
};

/// Raw values that are no angle.
struct HitchAngleCodes {
    std::vector<std::int64_t> errors{};
    std::vector<std::int64_t> not_available{};
};

/// A second signal of the same frame, which says whether the angle may be used.
struct HitchAngleStatus {
    CanField field{};
    std::vector<std::int64_t> valid{};   ///< raw values that say that it may
    std::vector<std::int64_t> errors{};  ///< that say that the sensor failed; others: not available
};

/// The frame has the angle only while `field` is `value`.
struct CanMultiplexor {
    CanField field{};
    std::int64_t value = 0;
};

/// Where the yaw of the trailer stands in a CAN frame: angle = factor * raw + offset.
struct HitchAngleSignal {
    using ByteOrder = CanByteOrder;

    std::uint32_t id = 0;  ///< [0, 0x1fffffff]
    int start_bit = 0;     ///< as CanField
    int length_bits = 16;  ///< [1, 32]
    ByteOrder byte_order = ByteOrder::kIntel;
    bool is_signed = false;
    double factor_deg = 1.0;  ///< not 0. [-1000, 1000]
    double offset_deg = 0.0;  ///< [-100000, 100000]
    double min_deg = -120.0;  ///< below: implausible. [-360, 360]
    double max_deg = 120.0;   ///< above: implausible. [min_deg, 360]
    bool extended = false;    ///< always so above 0x7ff
    bool j1939 = true;        ///< the top of the range are the codes of SAE J1939-71
    HitchAngleCodes codes{};
    std::optional<HitchAngleStatus> status{};
    std::optional<CanMultiplexor> multiplexor{};
    double max_rate_deg_s = 0;  ///< faster: implausible; 0: any rate will do. [0, 10000]
    std::chrono::milliseconds max_age{1000};  ///< of silence: stale; 0: never. [0, 60000]

    [[nodiscard]] bool IsExtended() const { return extended || id > 0x7ff; }
    [[nodiscard]] CanField field() const { return {start_bit, length_bits, byte_order, is_signed}; }
};

struct CanConfig {
    enum class Source { kSimulated, kCandump, kSocketCan, kLog };

    Source source = Source::kSimulated;
    std::filesystem::path candump{};     ///< text log as `candump -L` writes it; kCandump only
    std::string interface {};            ///< 1 to 15 characters; kSocketCan only
    int receive_buffer_bytes = 1 << 20;  ///< kSocketCan only. [4096, 2^26]
    HitchAngleSignal hitch_angle{};
};

/// A part of the panorama that is sent on a channel of its own. On a ring by azimuth_deg or
/// columns_px, on a plane by columns_px.
struct ViewportConfig {
    std::string name{};     ///< letters, digits and _; unique
    std::string channel{};  ///< VIEW_ and the name in capitals
    /// Left and right edge, positive to the left, all that lies to the right of the first up to the
    /// second. [-360, 360]
    std::optional<std::array<double, 2>> azimuth_deg{};
    std::optional<std::array<int, 2>>
        columns_px{};                             ///< left edge, and the one right of it. [0, 8192]
    std::optional<std::array<int, 2>> rows_px{};  ///< top edge, and the one below it; all rows
    int every = 1;                                ///< so many panoramas one is sent. [1, 300]
    int max_bytes = 60000;                        ///< of one picture. [20000, publish.max_bytes]
};

/// Pictures of single cameras for whoever looks after the rig.
struct PreviewConfig {
    double rate_hz = 2;  ///< 0: none. [0, 5]
};

/// Seams and meshes of the panorama for whoever wants to see them.
struct OverlayConfig {
    std::string channel = "PANORAMA_OVERLAY";
    double rate_hz = 5;  ///< 0: none. [0, 5]
};

struct PublishConfig {
    std::string url = "udpm://239.255.76.67:7667?ttl=0";
    std::string panorama_channel = "PANORAMA";  ///< LCM channel, at most 63 characters
    std::string status_channel = "PANORAMA_STATUS";
    std::string hitch_angle_channel = "HITCH_ANGLE";
    std::string event_channel = "PANORAMA_EVENT";
    std::string health_channel = "PANORAMA_HEALTH";
    int jpeg_quality = 85;   ///< [30, 95]
    int max_bytes = 150000;  ///< of one compressed panorama. [20000, 4000000]
    /// Panoramas that this system's receive buffers cannot hold are made small enough.
    bool fit_receive_buffer = true;
    std::vector<ViewportConfig> viewports{};  ///< at most 8
    PreviewConfig preview{};
    OverlayConfig overlay{};
};

/// How drives are recorded.
struct RecordConfig {
    enum class Format { kJpeg, kRaw };
    enum class Trigger {
        kSignal,       ///< SIGUSR1
        kCameraLost,   ///< that, or a camera that is lost
        kCameraFault,  ///< that, or a camera with any fault
    };

    std::filesystem::path folder{};  ///< empty: nothing is recorded
    int segment_s = 60;              ///< length of a file. [1, 3600]
    int quota_mb = 0;                ///< of all files, in 10^6 bytes; 0: none. [0, 10^7]
    int min_free_mb = 500;           ///< that recordings leave free. [0, 10^7]
    int pre_trigger_s = 0;    ///< kept in memory until a trigger; 0: all is written. [0, 600]
    int after_trigger_s = 0;  ///< 0: for ever; with pre_trigger_s only. [0, 86400]
    Trigger trigger = Trigger::kSignal;
    int memory_mb = 64;             ///< for what waits to be written. [8, 16384]
    Format format = Format::kJpeg;  ///< of the cameras' frames
    int quality = 85;               ///< of JPEG. [30, 100]
    int every = 1;                  ///< each so many-th frame of the cameras. [1, 1000]
    int threads = 2;                ///< that compress. [1, 8]
};

/// What a run at the cameras' pace asks of the system.
struct RealTimeConfig {
    enum class LockMemory {
        kNever,
        kTry,       ///< goes on without it, and says so
        kRequired,  ///< does not start without it
    };

    LockMemory lock_memory = LockMemory::kTry;
};

/// What is in a file that came in another way.
struct NamedText {
    std::string name{};  ///< what messages call the file
    std::string text{};
};

struct RigConfig {
    std::filesystem::path file{};  ///< where it was read from
    CanvasConfig canvas{};
    std::filesystem::path calibration{};          ///< empty for a plane
    std::optional<NamedText> calibration_text{};  ///< in place of what is in that file
    algo::PerUnit<UnitConfig> units{};
    SimulationConfig simulation{};
    StabilizationConfig stabilization{};
    StitchingConfig stitching{};
    std::optional<Placement> placement{};  ///< plane only; otherwise found by matching
    int workers = 2;  ///< threads that share a frame, the pipeline's own among them. [1, 16]
    ThreadSchedule schedule{};  ///< of the pipeline and those
    RealTimeConfig real_time{};
    std::optional<std::chrono::nanoseconds> period{};  ///< [1, 1000] ms; otherwise the recording's
    /// From the oldest to the newest frame of a set of live cameras, at most. [1 ms, period];
    /// otherwise the period.
    std::optional<std::chrono::nanoseconds> set_tolerance{};
    std::optional<CanConfig> can{};
    PublishConfig publish{};
    LogConfig log{};  ///< of cameras and a CAN bus whose source is kLog
    RecordConfig record{};

    /// Its cameras run at their own pace: all of a rig's do, or none.
    [[nodiscard]] bool IsLive() const {
        if (!HasUnit(algo::Unit::kTractor)) return false;
        const CameraConfig& camera = units[algo::Unit::kTractor].cameras.front();
        return camera.IsLive() ||
               (camera.source == CameraConfig::Source::kSimulated && simulation.live);
    }
    [[nodiscard]] bool HasUnit(algo::Unit unit) const { return !units[unit].cameras.empty(); }
};

/// The channel of something that has a name: the prefix and the name in capitals.
std::string ChannelOf(const std::string& prefix, const std::string& name);

/// Reads and checks a rig file. Relative paths in the result stand relative to the file's folder.
/// The error has one line `file:line: key.path is VALUE, must be ...` for each mistake.
/// A DBC file that it names is read and checked with it; whether the other files exist is not
/// looked at. Throws nothing.
hal::Checked<RigConfig> LoadRigConfig(const std::filesystem::path& file);
/// The same of a recorded rig file's content. Relative paths stand relative to `folder`; a CAN bus
/// whose DBC file is not there is left out, with a word on stderr.
hal::Checked<RigConfig> ParseRigConfig(const NamedText& rig, const std::filesystem::path& folder);

/// Reads the calibration of a cylinder rig and checks that it has every camera of the rig, on the
/// same unit. It may have more cameras than the rig.
hal::Checked<calib::RigCalibration> LoadCalibrationFor(const RigConfig& config);

}  // namespace hitchview::app

#include "app/demo_recording.hpp"

#include <unistd.h>

#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <sstream>
#include <thread>
#include <vector>

#include "app/jpeg_encoder.hpp"
#include "app/truth_calibration.hpp"
#include "drivers/simulated_can_bus.hpp"

namespace hitchview::app {
namespace {

using drivers::SimulatedRig;

constexpr int kQuality = 85;
constexpr int kMaxPictureBytes = 4'000'000;
constexpr int kThreads = 2;

std::string FrameName(int frame) {
    char name[16];
    std::snprintf(name, sizeof name, "%05d.jpg", frame);
    return name;
}

void Describe(const drivers::Script& script, std::ostream& text) {
    for (const drivers::Key& key : script) text << ' ' << key.time_s << ':' << key.value;
    text << ';';
}

void Describe(const drivers::SceneOptions& scene, std::ostream& text) {
    text << ", scene " << static_cast<int>(scene.ground) << ' ' << scene.density << ' '
         << scene.visibility_m << ' ' << scene.overcast << ' ' << scene.night << ' '
         << scene.snowflakes;
    if (scene.tunnel) text << ", tunnel " << scene.tunnel->from_m << ' ' << scene.tunnel->to_m;
    for (const auto& truck : scene.trucks)
        text << ", truck " << truck.start_m << ' ' << truck.across_m << ' ' << truck.speed_mps;
}

void Describe(const drivers::SensorOptions& sensor, std::ostream& text) {
    text << ", gain " << sensor.gain << ' ' << sensor.auto_exposure;
    for (const auto& step : sensor.gain_steps)
        text << ", step " << step.camera << ' ' << step.first_frame << ' ' << step.factor;
    for (const auto& outage : sensor.outages)
        text << ", outage " << outage.camera << ' ' << outage.first_frame << ' '
             << outage.end_frame;
}

/// Everything that the recording depends on, to tell whether one on disk can be used again.
std::string Describe(const SimulatedRig& rig) {
    const drivers::SimulationOptions& o = rig.options();
    std::ostringstream text;
    text << "simulation 1: seed " << o.seed << ", " << o.frames << " frames of " << o.period.count()
         << " ns, " << o.width_px << "x" << o.height_px << ", speed " << o.speed_mps << ", profile "
         << static_cast<int>(o.profile) << ", curvature " << o.curvature_per_m << ", slalom "
         << o.slalom_period_s << ", gains " << o.gain_spread << ", noise " << o.noise_sigma
         << ", shake";
    for (const algo::Unit unit : algo::kUnits) {
        const drivers::ShakeOptions& s = o.shake[unit];
        text << ' ' << s.roll_pitch_rad << ' ' << s.yaw_rad << ' ' << s.translation_m << ' '
             << s.lowest_hz << ' ' << s.highest_hz << ' ' << s.scale;
    }
    text << ", scripts";
    Describe(o.speed, text);
    Describe(o.hitch_angle, text);
    Describe(o.scene, text);
    Describe(o.sensor, text);
    text << ", quality " << kQuality << '\n';
    return text.str();
}

bool WriteFile(const std::filesystem::path& file, std::string_view text) {
    std::ofstream out(file, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    return static_cast<bool>(out);
}

std::string ReadFile(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A bar that is drawn again in place; silent where nobody looks.
class ProgressBar {
 public:
    ProgressBar(std::string what, int total) : what_(std::move(what)), total_(total) {}
    ~ProgressBar() {
        if (shown_) std::fputc('\n', stderr);
    }

    void Step() {
        const std::lock_guard lock(mutex_);
        ++done_;
        if (isatty(STDERR_FILENO) == 0) return;
        constexpr int kWidth = 40;
        const int filled = done_ * kWidth / total_;
        std::fprintf(stderr, "\r%s [%s%s] %3d %%", what_.c_str(),
                     std::string(static_cast<std::size_t>(filled), '#').c_str(),
                     std::string(static_cast<std::size_t>(kWidth - filled), '.').c_str(),
                     done_ * 100 / total_);
        shown_ = true;
    }

 private:
    std::string what_;
    int total_;
    int done_ = 0;
    bool shown_ = false;
    std::mutex mutex_;
};

/// NV12 to I420: the chroma of simulated cameras comes interleaved, the compressor takes planes.
void SplitChroma(const hal::FrameFormat& format, const std::vector<std::uint8_t>& nv12,
                 std::vector<std::uint8_t>& i420) {
    const std::size_t luma =
        static_cast<std::size_t>(format.width_px) * static_cast<std::size_t>(format.height_px);
    std::copy_n(nv12.begin(), luma, i420.begin());
    for (std::size_t i = 0; i < luma / 4; ++i) {
        i420[luma + i] = nv12[luma + 2 * i];
        i420[luma + luma / 4 + i] = nv12[luma + 2 * i + 1];
    }
}

/// Renders and compresses every kThreads-th picture.
class Recorder {
 public:
    Recorder(const SimulatedRig& rig, const DemoRecording& recording)
        : rig_(rig),
          recording_(recording),
          format_{rig.format().width_px, rig.format().height_px, hal::PixelFormat::kI420,
                  hal::Range::kFull},
          nv12_(hal::FrameBytes(rig.format())),
          i420_(hal::FrameBytes(format_)),
          encoder_(format_, {.budget_bytes = kMaxPictureBytes, .highest_quality = kQuality}) {}

    /// A picture that the camera does not deliver becomes an empty file, which is a damaged one.
    bool Record(int camera, int frame) {
        if (!rig_.CameraPresent(camera, frame))
            return WriteFile(recording_.picture(camera, frame), "");
        rig_.Render(camera, frame, workspace_, nv12_);
        SplitChroma(format_, nv12_, i420_);
        const auto jpeg = encoder_.Encode({format_, {}, hal::PackedPlanes(format_, i420_.data())});
        if (!jpeg) return false;
        return WriteFile(recording_.picture(camera, frame),
                         {reinterpret_cast<const char*>(jpeg.value().data()), jpeg.value().size()});
    }

 private:
    const SimulatedRig& rig_;
    const DemoRecording& recording_;
    hal::FrameFormat format_;
    std::vector<std::uint8_t> nv12_;
    std::vector<std::uint8_t> i420_;
    JpegEncoder encoder_;
    drivers::Renderer::Workspace workspace_;
};

bool RecordPictures(const SimulatedRig& rig, const DemoRecording& recording,
                    const std::atomic<bool>& stop) {
    const int pictures = rig.options().frames * SimulatedRig::kCameras;
    ProgressBar progress("rendering the drive", pictures);
    std::atomic<int> next{0};
    std::atomic<bool> failed{false};
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
        threads.emplace_back([&] {
            Recorder recorder(rig, recording);
            for (int i = next++; i < pictures && !stop && !failed; i = next++) {
                if (!recorder.Record(i % SimulatedRig::kCameras, i / SimulatedRig::kCameras))
                    failed = true;
                progress.Step();
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    return !failed && !stop;
}

std::string RigYaml(const SimulatedRig& rig, bool unified) {
    std::ostringstream yaml;
    yaml << "# The simulated drive, recorded.\nschema: 1\ncanvas: {projection: cylinder}\n"
         << "calibration: rig.calib.yaml\nunits:\n";
    for (const algo::Unit unit : algo::kUnits) {
        yaml << "  " << ToString(unit) << ":\n    cameras:\n";
        for (int i = 0; i < SimulatedRig::kCameras; ++i) {
            if (rig.camera(i).unit != unit) continue;
            yaml << "      - {name: " << rig.camera(i).name
                 << ", source: {replay: " << rig.camera(i).name << "}}\n";
        }
    }
    yaml << "period_ms: " << std::chrono::duration<double, std::milli>(rig.options().period).count()
         << '\n';
    if (!unified) yaml << "stabilization: {enabled: false}\nstitching: {enabled: false}\n";
    yaml << "can:\n  source: {candump: can.log}\n  hitch_angle: {id: "
         << drivers::SimulatedCanBus::kHitchAngleId
         << ", start_bit: 23, length_bits: 12, byte_order: motorola, factor_deg: 0.1, offset_deg: "
            "-90,\n"
            "                min_deg: -90, max_deg: 90}\n";
    return yaml.str();
}

std::string SaveRig(const SimulatedRig& rig, const DemoRecording& recording) {
    std::string refused =
        calib::SaveCalibration(CalibrationOf(rig), recording.folder / "rig.calib.yaml");
    if (!refused.empty()) return refused;
    if (!WriteFile(recording.rig(), RigYaml(rig, true)) ||
        !WriteFile(recording.plain_rig(), RigYaml(rig, false))) {
        return recording.folder.string() + ": cannot be written";
    }
    return "";
}

/// The bus as `candump -L` writes it.
bool RecordCan(const SimulatedRig& rig, const DemoRecording& recording) {
    std::string log;
    drivers::SimulatedCanBus bus(rig, hal::Instant{0});
    while (const auto frame = bus.WaitFrame(std::chrono::milliseconds(1))) {
        const std::int64_t us = frame.value().received_at.count() / 1000;
        char head[64];
        std::snprintf(head, sizeof head, "(%010" PRId64 ".%06" PRId64 ") can0 %03X#",
                      us / 1'000'000, us % 1'000'000, frame.value().id);
        log += head;
        for (int i = 0; i < frame.value().size_bytes; ++i) {
            char byte[3];
            std::snprintf(byte, sizeof byte, "%02X",
                          frame.value().data[static_cast<std::size_t>(i)]);
            log += byte;
        }
        log += '\n';
    }
    return WriteFile(recording.folder / "can.log", log);
}

}  // namespace

std::filesystem::path DemoRecording::picture(int camera, int frame) const {
    constexpr int kAnySize = 64;  // names do not depend on it
    const auto cameras = drivers::SimulatedRigGeometry(kAnySize, kAnySize);
    return folder / std::string(cameras[static_cast<std::size_t>(camera)].name) / FrameName(frame);
}

hal::Checked<DemoRecording> RecordDemo(const SimulatedRig& rig, const std::filesystem::path& folder,
                                       const std::atomic<bool>& stop) {
    const DemoRecording recording{folder};
    const std::filesystem::path mark = folder / "complete.txt";
    const std::string description = Describe(rig);
    if (ReadFile(mark) != description) {
        std::error_code refused;
        std::filesystem::remove_all(folder, refused);
        for (int i = 0; i < SimulatedRig::kCameras; ++i) {
            std::filesystem::create_directories(recording.picture(i, 0).parent_path(), refused);
        }
        if (refused) return folder.string() + ": " + refused.message();
        if (!RecordPictures(rig, recording, stop) || !RecordCan(rig, recording)) {
            return folder.string() +
                   (stop ? ": stopped before the drive was rendered" : ": cannot be written");
        }
    }
    const std::string saved = SaveRig(rig, recording);
    if (!saved.empty()) return saved;
    if (!WriteFile(mark, description)) return mark.string() + ": cannot be written";
    return recording;
}

}  // namespace hitchview::app

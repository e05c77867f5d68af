#include "app/demo_verb.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "app/board.hpp"
#include "app/demo_picture.hpp"
#include "app/demo_recording.hpp"
#include "app/demo_truth.hpp"
#include "app/program.hpp"
#include "app/report.hpp"
#include "app/run_loop.hpp"
#include "drivers/simulated_scenario.hpp"

namespace hitchview::app {
namespace {

using algo::Unit;
using drivers::SimulatedRig;

constexpr int kMachineFailed = 3;

int Fail(const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    return kMachineFailed;
}

hal::Checked<std::unique_ptr<SimulatedRig>> MakeDrive(const DemoOptions& options) {
    drivers::SimulationOptions simulation{.speed_mps = 4, .curvature_per_m = 0.12};
    if (!options.scenario.empty()) {
        const drivers::Scenario* scenario = drivers::FindScenario(options.scenario);
        if (scenario == nullptr) {
            return "--scenario: " + options.scenario + " is none, must be one of " +
                   drivers::ScenarioNames();
        }
        simulation = scenario->options;
    }
    simulation.frames = options.frames;
    simulation.width_px = options.camera_width_px;
    simulation.height_px = options.camera_width_px * 9 / 16;
    simulation.render_threads = 1;
    return SimulatedRig::Create(simulation);
}

/// The frame set shown on the sheet: the one with the largest hitch angle after the first second.
int FrameOfLargestHitchAngle(const SimulatedRig& rig) {
    int best = 0;
    for (int i = std::min(30, rig.options().frames - 1); i < rig.options().frames; ++i) {
        if (std::abs(rig.HitchAngleAt(i)) > std::abs(rig.HitchAngleAt(best))) best = i;
    }
    return best;
}

/// One run over the recording with what was learnt of it.
struct DemoRun {
    RunSummary summary;
    std::unique_ptr<TruthMeter> truth;
    cv::Mat picture;  ///< the panorama of the chosen frame set
};

class Demo {
 public:
    Demo(const DemoOptions& options, const SimulatedRig& rig, const DemoRecording& recording,
         const std::atomic<bool>& stop)
        : options_(options),
          rig_(rig),
          recording_(recording),
          stop_(stop),
          chosen_(FrameOfLargestHitchAngle(rig)) {}

    hal::Checked<DemoRun> Drive(const std::filesystem::path& rig_file,
                                const RunOptions& run_options) {
        const auto config = LoadRigConfig(rig_file);
        if (!config) return config.error();
        const auto calibration = LoadCalibrationFor(config.value());
        if (!calibration) return calibration.error();
        CameraFormats formats;
        for (int i = 0; i < SimulatedRig::kCameras; ++i)
            formats[rig_.camera(i).unit].push_back(rig_.format());
        const auto geometry = MakeRigGeometry(config.value(), calibration.value(), formats);
        if (!geometry) return geometry.error();

        DemoRun run;
        run.truth = std::make_unique<TruthMeter>(rig_, geometry.value());
        auto summary = RunRig(config.value(), run_options, stop_,
                              [&](const ShownPanorama& shown, const Pipeline& pipeline) {
                                  run.truth->Observe(shown, pipeline);
                                  // The chosen one may have been dropped: then the next one that
                                  // was shown.
                                  const bool reached =
                                      static_cast<int>(shown.picture.header.sequence) >= chosen_;
                                  if (reached && run.picture.empty())
                                      run.picture = ToBgr(shown.picture);
                              });
        if (!summary) return summary.error();
        run.summary = *summary;
        return run;
    }

    std::string WriteSheetOf(const DemoRun& before, const DemoRun& after) const {
        if (before.picture.empty() || after.picture.empty())
            return "too few panoramas were shown for before_after.png";
        DemoSheet sheet;
        for (int i = 0; i < SimulatedRig::kCameras; ++i) {
            sheet.cameras.push_back(cv::imread(recording_.picture(i, chosen_).string()));
        }
        char caption[128];
        std::snprintf(
            caption, sizeof caption,
            "fixed calibration, hitch at %.0f degrees: no stabilisation, no stitching motion",
            rig_.HitchAngleAt(chosen_) * 57.29578);
        sheet.panoramas = {{caption, before.picture}, {"unified vertex motion", after.picture}};
        return WriteSheet(sheet, options_.out / "before_after.png");
    }

 private:
    const DemoOptions& options_;
    const SimulatedRig& rig_;
    const DemoRecording& recording_;
    const std::atomic<bool>& stop_;
    int chosen_;
};

nlohmann::json TruthJson(const TruthMeter& truth) {
    nlohmann::json json;
    for (const Unit unit : algo::kUnits) {
        const TruthMeter::Shake shake = truth.ShakeOf(unit);
        json["shake"][ToString(unit)] = {
            {"input_px", shake.input_px},
            {"output_px", shake.output_px},
            {"ratio", shake.input_px > 0 ? nlohmann::json(shake.output_px / shake.input_px)
                                         : nlohmann::json()},
            {"samples", shake.samples}};
    }
    const TruthMeter::ArticulationError articulation = truth.ErrorOfArticulation();
    json["articulation"] = nullptr;
    if (articulation.samples > 0)
        json["articulation"] = {{"rms_rad", articulation.rms_rad},
                                {"largest_rad", articulation.largest_rad},
                                {"samples", articulation.samples}};
    const auto seam = [&](double from, double to) -> nlohmann::json {
        const TruthMeter::Seam s = truth.SeamOf(from, to);
        if (s.samples == 0) return nullptr;
        return {{"median_px", s.median_px}, {"p95_px", s.p95_px}, {"samples", s.samples}};
    };
    json["seam"] = {{"beyond_10_m", seam(10, 1e9)}, {"4_to_10_m", seam(4, 10)}};
    return json;
}

void PrintTruth(const TruthMeter& before, const TruthMeter& after) {
    std::printf("against ground truth (canvas px):         before    after\n");
    for (const Unit unit : algo::kUnits) {
        std::printf("  shake of the %s, rms second diff. %7.2f  %7.2f\n", ToString(unit),
                    after.ShakeOf(unit).input_px, after.ShakeOf(unit).output_px);
    }
    struct Range {
        const char* name;
        double from_m, to_m;
    };
    for (const Range& range : {Range{"beyond 10 m", 10, 1e9}, Range{"4 to 10 m  ", 4, 10}}) {
        const TruthMeter::Seam b = before.SeamOf(range.from_m, range.to_m);
        const TruthMeter::Seam a = after.SeamOf(range.from_m, range.to_m);
        std::printf("  seam error %s, median       %7.2f  %7.2f\n", range.name, b.median_px,
                    a.median_px);
        std::printf("  seam error %s, p95          %7.2f  %7.2f\n", range.name, b.p95_px, a.p95_px);
    }
    const TruthMeter::ArticulationError articulation = after.ErrorOfArticulation();
    std::printf("  articulation error, rms of %d: %.2f degrees\n", articulation.samples,
                articulation.rms_rad * 57.29578);
}

}  // namespace

int DemoVerb(const DemoOptions& options, const std::atomic<bool>& stop) {
    const auto rig = MakeDrive(options);
    if (!rig) return Fail(rig.error());
    const auto recording = RecordDemo(*rig.value(), options.out / "recording", stop);
    if (!recording) return Fail(recording.error());
    Demo demo(options, *rig.value(), recording.value(), stop);

    std::optional<BackgroundProgram> display;
    if (!options.headless)
        display.emplace(SiblingProgram("hitchview-view"), std::vector<std::string>{});
    RunOptions plain;
    plain.workers = options.workers;
    RunOptions unified = plain;
    unified.out = options.out;
    unified.write_video = unified.publish = true;
    unified.realtime = options.realtime || !options.headless;
    const auto after = demo.Drive(recording.value().rig(), unified);
    if (!after) return Fail(after.error());
    const auto before = demo.Drive(recording.value().plain_rig(), plain);
    if (!before) return Fail(before.error());

    std::fputs(Table(after.value().summary).c_str(), stdout);
    PrintTruth(*before.value().truth, *after.value().truth);
    nlohmann::json report = MakeReport(after.value().summary, nullptr);
    report["truth"] = {{"before", TruthJson(*before.value().truth)},
                       {"after", TruthJson(*after.value().truth)}};
    for (const std::string& refused : {WriteJson(report, options.out / "report.json"),
                                       demo.WriteSheetOf(before.value(), after.value())}) {
        if (!refused.empty()) return Fail(refused);
    }
    std::printf("%s: panorama.avi, before_after.png, report.json\n", options.out.c_str());
    return stop ? 1 : 0;
}

}  // namespace hitchview::app

#include "app/demo_verb.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "app/board.hpp"
#include "app/demo_picture.hpp"
#include "app/demo_recording.hpp"
#include "app/demo_table.hpp"
#include "app/exit_code.hpp"
#include "app/program.hpp"
#include "app/report.hpp"
#include "app/run_loop.hpp"
#include "app/scenario_meter.hpp"
#include "drivers/simulated_scenario.hpp"

namespace hitchview::app {
namespace {

using drivers::SimulatedRig;

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

/// What the script says of the drive stands in place of what the options do.
DemoOptions WithDriveOf(const FaultScript& faults, DemoOptions options) {
    options.scenario = faults.scenario.value_or(options.scenario);
    options.frames = faults.frames.value_or(options.frames);
    return options;
}

/// One run over the recording with what was learnt of it.
struct DemoRun {
    RunSummary summary;
    nlohmann::json truth;  ///< figures of ScenarioMeter
    cv::Mat picture;       ///< the panorama of the chosen frame set
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
        ScenarioMeter meter(rig_, geometry.value());
        auto summary = RunRig(config.value(), run_options, stop_,
                              [&](const ShownPanorama& shown, const Pipeline& pipeline) {
                                  meter.Observe(shown, pipeline.map());
                                  // The chosen one may have been dropped: then the next one that
                                  // was shown.
                                  const bool reached =
                                      static_cast<int>(shown.picture.header.sequence) >= chosen_;
                                  if (reached && run.picture.empty())
                                      run.picture = ToBgr(shown.picture);
                              });
        if (!summary) return summary.error();
        run.summary = *summary;
        run.truth = meter.Figures();
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

}  // namespace

int DemoVerb(const DemoOptions& given, const std::atomic<bool>& stop) {
    std::optional<FaultScript> faults;
    if (!given.faults.empty()) {
        auto script = LoadFaultScript(given.faults);
        if (!script) return Fail(kWrongUse, script.error());
        faults = std::move(*script);
    }
    const DemoOptions options = faults ? WithDriveOf(*faults, given) : given;
    const auto rig = MakeDrive(options);
    if (!rig) return Fail(kWrongUse, rig.error());
    const auto recording = RecordDemo(*rig.value(), options.out / "recording", stop);
    if (!recording) return Fail(kMachineFailed, recording.error());
    Demo demo(options, *rig.value(), recording.value(), stop);

    std::optional<BackgroundProgram> display;
    if (!options.headless)
        display.emplace(SiblingProgram("hitchview-view"), std::vector<std::string>{});
    RunOptions plain;
    plain.workers = options.workers;
    RunOptions unified = plain;
    unified.out = options.out;
    unified.faults = std::move(faults);
    unified.write_video = unified.publish = true;
    unified.realtime = options.realtime || !options.headless;
    const auto after = demo.Drive(recording.value().rig(), unified);
    if (!after) return Fail(kMachineFailed, after.error());
    const auto before = demo.Drive(recording.value().plain_rig(), plain);
    if (!before) return Fail(kMachineFailed, before.error());

    std::fputs(Table(after.value().summary).c_str(), stdout);
    std::fputs(DemoTable(before.value().truth, after.value().truth).c_str(), stdout);
    nlohmann::json report = MakeReport(after.value().summary, nullptr);
    report["truth"] = {{"before", before.value().truth}, {"after", after.value().truth}};
    for (const std::string& refused : {WriteJson(report, options.out / "report.json"),
                                       demo.WriteSheetOf(before.value(), after.value())}) {
        if (!refused.empty()) return Fail(kMachineFailed, refused);
    }
    std::printf("%s: panorama.avi, before_after.png, report.json\n", options.out.c_str());
    return stop ? 1 : 0;
}

}  // namespace hitchview::app

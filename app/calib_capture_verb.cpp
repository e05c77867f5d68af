#include "app/calib_capture_verb.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "app/calib_capture_source.hpp"
#include "app/calib_provenance.hpp"
#include "app/exit_code.hpp"
#include "calib/board_detector.hpp"
#include "calib/view_keeper.hpp"

namespace hitchview::app {
namespace {

using calib::Tilt;
using calib::ViewKeeper;
using nlohmann::json;

/// One camera's part of the work.
struct CameraCapture {
    std::string name{};
    std::filesystem::path folder{};
    std::optional<ViewKeeper> keeper{};  ///< since the first picture
    std::string advice = "show the board";
    std::size_t frames = 0;
    bool keeps = false;  ///< the newest picture

    [[nodiscard]] bool enough() const { return keeper && keeper->enough(); }
};

class Capture {
 public:
    Capture(const CaptureOptions& options, const calib::Board& board,
            std::unique_ptr<CaptureSource> source)
        : options_(options), board_(board), source_(std::move(source)) {
        for (const std::string& name : source_->cameras())
            cameras_.push_back({.name = name, .folder = options.out / name});
    }

    /// The error says which folder is not new.
    [[nodiscard]] std::string MakeFolders() const;
    /// Until every camera has enough or the source is over; empty, or what could not be written.
    std::string Run();
    [[nodiscard]] bool enough() const {
        return std::ranges::all_of(cameras_, &CameraCapture::enough);
    }
    [[nodiscard]] std::string failure() const { return source_->failure(); }
    void Print() const;
    [[nodiscard]] json Report() const;

 private:
    void Look(CameraCapture& camera, const cv::Mat1b& picture) const;
    void LookAtAll(const std::vector<cv::Mat1b>& pictures);
    std::string SaveKept(const std::vector<cv::Mat1b>& pictures);
    void ShowAdvice() const;

    const CaptureOptions& options_;
    calib::Board board_;
    std::unique_ptr<CaptureSource> source_;
    std::vector<CameraCapture> cameras_;
    int shots_ = 0;
};

std::string Capture::MakeFolders() const {
    for (const CameraCapture& camera : cameras_) {
        std::error_code error;
        std::filesystem::create_directories(camera.folder, error);
        if (error) return camera.folder.string() + ": cannot be made: " + error.message();
        if (!std::filesystem::is_empty(camera.folder, error))
            return camera.folder.string() + ": is not empty, must be new";
    }
    return "";
}

void Capture::Look(CameraCapture& camera, const cv::Mat1b& picture) const {
    camera.keeps = false;
    if (picture.empty() || camera.enough()) return;
    if (!camera.keeper) {
        calib::ViewGoals goals{.views = options_.views};
        if (!options_.images.empty()) goals.most_motion_px = 0;  // each was taken on its own
        camera.keeper.emplace(board_, Eigen::Vector2d(picture.cols, picture.rows), goals);
    }
    ++camera.frames;
    const calib::SeenCorners corners =
        calib::DetectBoards(picture, {&board_, 1}, calib::Search::kQuick).front();
    const auto answer = camera.keeper->Judge(corners, calib::LookAtCorners(picture, corners));
    camera.keeps = answer.keep;
    camera.advice = answer.advice;
}

void Capture::LookAtAll(const std::vector<cv::Mat1b>& pictures) {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < cameras_.size(); ++i)
        threads.emplace_back([this, i, &pictures] { Look(cameras_[i], pictures[i]); });
}

/// Pictures of one moment have the same name.
std::string Capture::SaveKept(const std::vector<cv::Mat1b>& pictures) {
    if (std::ranges::none_of(cameras_, &CameraCapture::keeps)) return "";
    char name[16];
    std::snprintf(name, sizeof name, "%04d.png", ++shots_);
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        const std::filesystem::path file = cameras_[i].folder / name;
        if (cameras_[i].keeps && !cv::imwrite(file.string(), pictures[i]))
            return file.string() + ": the file cannot be written";
    }
    return "";
}

void Capture::ShowAdvice() const {
    if (isatty(STDERR_FILENO) == 0) return;
    std::fprintf(stderr, "\r\033[K");
    for (const CameraCapture& camera : cameras_)
        std::fprintf(stderr, "%s %d: %s   ", camera.name.c_str(),
                     camera.keeper ? camera.keeper->views() : 0, camera.advice.c_str());
}

std::string Capture::Run() {
    while (!enough() && !(options_.stop != nullptr && *options_.stop)) {
        const auto pictures = source_->Next();
        if (!pictures) break;
        LookAtAll(*pictures);
        if (std::string problem = SaveKept(*pictures); !problem.empty()) return problem;
        ShowAdvice();
    }
    if (isatty(STDERR_FILENO) != 0) std::fprintf(stderr, "\n");
    return "";
}

void PrintMap(const ViewKeeper& keeper) {
    for (int row = 0; row < ViewKeeper::kRows; ++row) {
        std::printf("    ");
        for (int column = 0; column < ViewKeeper::kColumns; ++column) {
            const int views =
                keeper.cells()[static_cast<std::size_t>(row * ViewKeeper::kColumns + column)];
            std::printf(views == 0 ? "  ." : " %2d", views);
        }
        std::printf("\n");
    }
}

void Capture::Print() const {
    for (const CameraCapture& camera : cameras_) {
        if (!camera.keeper) {
            std::printf("%s: no picture\n", camera.name.c_str());
            continue;
        }
        std::printf("%s: %d views kept of %zu pictures, in %s\n", camera.name.c_str(),
                    camera.keeper->views(), camera.frames, camera.folder.c_str());
        PrintMap(*camera.keeper);
        for (const std::string& missing : camera.keeper->missing())
            std::printf("    missing: %s\n", missing.c_str());
        if (camera.enough()) std::printf("    enough\n");
    }
}

json CameraReport(const CameraCapture& camera) {
    json report = {{"name", camera.name}, {"pictures", camera.frames}, {"enough", camera.enough()}};
    if (!camera.keeper) return report;
    const ViewKeeper& keeper = *camera.keeper;
    report["views"] = keeper.views();
    report["covered"] = keeper.covered();
    report["cells"] = keeper.cells();
    report["tilted"] = {{"left", keeper.tilted(Tilt::kLeftAway)},
                        {"right", keeper.tilted(Tilt::kRightAway)},
                        {"upper", keeper.tilted(Tilt::kTopAway)},
                        {"lower", keeper.tilted(Tilt::kBottomAway)}};
    report["near"] = keeper.near();
    report["far"] = keeper.far();
    report["missing"] = keeper.missing();
    return report;
}

json Capture::Report() const {
    json cameras = json::array();
    for (const CameraCapture& camera : cameras_) cameras.push_back(CameraReport(camera));
    return {{"enough", enough()}, {"cameras", cameras}};
}

hal::Checked<std::unique_ptr<CaptureSource>> OpenSource(const CaptureOptions& options,
                                                        const calib::Board& board) {
    const auto given = [](const std::string& option) { return option.empty() ? 0 : 1; };
    if (given(options.rig) + given(options.video) + given(options.images) + given(options.log) != 1)
        return std::string("one of --rig, --video, --images and --log must be given");
    if (!options.log.empty() && options.camera.empty())
        return std::string("--log needs --camera: one of its cameras");
    const std::string name = options.camera.empty() ? "camera" : options.camera;
    if (!options.images.empty()) return OpenPictures(options.images, name);
    if (!options.log.empty()) return OpenLog(options.log, name);
    if (!options.video.empty()) return OpenVideo(options.video, name);
    return OpenRig(options.rig, options.camera, board);
}

}  // namespace

CLI::App& AddCapture(CLI::App& app, CaptureOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "capture",
        "Choose pictures of a board that is held before the cameras, and say what to do next.\n"
        "Exit code 0: every camera has enough, 1: not, and what is missing.\n"
        "Example: hitchview-calib capture --rig rig.yaml --board board.yaml --out pictures");
    verb.add_option("--board", options.board, "board file, or COLSxROWS,SQUARE_M")->required();
    verb.add_option("--rig", options.rig, "rig file: all its cameras at once");
    verb.add_option("--video", options.video, "a film of one camera");
    verb.add_option("--images", options.images, "pictures of one camera, a pattern in quotes");
    verb.add_option("--log", options.log, "a recording (LCM log): its camera --camera");
    verb.add_option("--camera", options.camera, "its name; with --rig, this camera only");
    verb.add_option("--views", options.views, "of each camera, at least (20)")
        ->check(CLI::Range(6, 200));
    verb.add_option("--out", options.out, "folder for a new folder of each camera")->required();
    verb.add_option("--json", options.json, "file for all figures");
    return verb;
}

int CaptureVerb(const CaptureOptions& options) {
    const calib::ParsedBoard board = calib::ReadBoard(options.board);
    if (!board.board) return Fail(kWrongUse, board.error);
    auto source = OpenSource(options, *board.board);
    if (!source) return Fail(kWrongUse, source.error());
    Capture capture(options, *board.board, std::move(source.value()));
    if (const std::string why = capture.MakeFolders(); !why.empty()) return Fail(kWrongUse, why);
    if (const std::string problem = capture.Run(); !problem.empty())
        return Fail(kMachineFailed, problem);
    capture.Print();
    if (!options.json.empty()) {
        const std::string problem = WriteFigures(capture.Report(), options.command, options.json);
        if (!problem.empty()) return Fail(kMachineFailed, problem);
    }
    if (!capture.failure().empty()) return Fail(kWrongUse, capture.failure());
    return capture.enough() ? 0 : kBad;
}

}  // namespace hitchview::app

#include "app/calib_intrinsics_verb.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "app/calib_intrinsics_report.hpp"
#include "app/calib_pictures.hpp"
#include "app/calib_provenance.hpp"
#include "app/exit_code.hpp"
#include "calib/intrinsics.hpp"
#include "calib/lens_file.hpp"
#include "calib/rig_calibration.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;
using std::filesystem::path;

constexpr std::size_t kFewestViews = 3;

/// One lens to measure.
struct Camera {
    std::string name{};    ///< empty: the only one
    std::string images{};  ///< pattern
    path out{};
    BoardPictures pictures{};
    std::optional<calib::Intrinsics> lens{};
    std::string problem{};  ///< why there is no lens; empty: there is, or nothing was tried yet
    int code = kGood;
};

hal::Checked<std::vector<Camera>> CamerasOf(const IntrinsicsOptions& options) {
    std::vector<Camera> cameras;
    if (options.folder.empty()) {
        cameras.push_back({.images = options.images, .out = options.out});
        return cameras;
    }
    std::error_code refused;
    for (const auto& entry : std::filesystem::directory_iterator(options.folder, refused)) {
        const std::string name = entry.path().filename().string();
        if (!entry.is_directory() || !calib::IsName(name)) continue;
        cameras.push_back({.name = name,
                           .images = (entry.path() / "*").string(),
                           .out = options.out.empty() ? path() : options.out / (name + ".yaml")});
    }
    if (refused) return options.folder.string() + ": cannot be read: " + refused.message();
    if (cameras.empty())
        return options.folder.string() +
               ": has no folder that is named as a camera (letters, "
               "digits, _)";
    std::ranges::sort(cameras, {}, &Camera::name);
    return cameras;
}

/// Why there is nothing to solve; empty if there is.
std::string Refusal(const BoardPictures& pictures, const calib::Board& board) {
    const std::string size = std::to_string(board.columns) + "x" + std::to_string(board.rows);
    const bool whole = board.pattern == calib::Pattern::kCheckerboard;
    if (pictures.views.size() >= kFewestViews && 2 * pictures.larger_boards > pictures.views.size())
        return "the board goes on beyond " + size +
               " inner corners: count the corners between four squares, all of them";
    if (pictures.views.size() >= kFewestViews) return "";
    return "the board (" + calib::Describe(board) + ") is in " +
           std::to_string(pictures.views.size()) + " of " + std::to_string(pictures.pictures) +
           " pictures, at least " + std::to_string(kFewestViews) + " are needed: " +
           (whole ? "count the corners between four squares, and let the whole board be seen"
                  : "is it this board, with these tags, and large enough in the picture?");
}

void FindIn(const calib::Board& board, Camera& camera) {
    const auto found = FindBoards(camera.images, board);
    if (found) camera.pictures = found.value();
    camera.problem = found ? Refusal(camera.pictures, board) : found.error();
    if (!camera.problem.empty()) camera.code = kWrongUse;
}

void Measure(const IntrinsicsOptions& options, const calib::Board& board, Camera& camera) {
    if (!camera.problem.empty()) return;
    camera.lens = calib::MeasureIntrinsics({.kind = options.model,
                                            .width_px = camera.pictures.width_px,
                                            .height_px = camera.pictures.height_px,
                                            .board = board,
                                            .views = camera.pictures.views});
    if (!camera.lens) camera.problem = "no lens of this model explains the pictures";
    const bool passed = camera.lens && camera.lens->verdict == calib::Verdict::kPass;
    camera.code = passed ? kGood : kBad;
}

/// On all processors, one camera each.
void MeasureAll(const IntrinsicsOptions& options, const calib::Board& board,
                std::vector<Camera>& cameras) {
    std::atomic<std::size_t> next{0};
    std::atomic<std::size_t> done{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < cameras.size(); i = next++) {
            Measure(options, board, cameras[i]);
            ShowProgress("measured", ++done, cameras.size(), "lenses");
        }
    };
    std::vector<std::jthread> threads;
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    for (unsigned i = 0; i < processors && i < cameras.size(); ++i) threads.emplace_back(work);
}

json AllFigures(const std::vector<Camera>& cameras) {
    if (cameras.size() == 1 && cameras[0].name.empty())
        return IntrinsicsJson(*cameras[0].lens, cameras[0].pictures);
    json all = json::object();
    for (const Camera& camera : cameras) {
        all[camera.name] = camera.lens ? IntrinsicsJson(*camera.lens, camera.pictures)
                                       : json{{"verdict", "fail"}, {"reasons", {camera.problem}}};
    }
    return {{"verb", "intrinsics"}, {"cameras", all}};
}

void Tell(const Camera& camera) {
    if (!camera.name.empty()) std::printf("%s\n", camera.name.c_str());
    if (camera.lens) PrintIntrinsics(*camera.lens, camera.pictures);
    if (camera.problem.empty()) return;
    const std::string whose = camera.name.empty() ? "" : camera.name + ": ";
    Fail(camera.code, whose + camera.problem);
}

std::string Save(const IntrinsicsOptions& options, const std::vector<Camera>& cameras) {
    std::error_code refused;
    if (!options.folder.empty() && !options.out.empty())
        std::filesystem::create_directories(options.out, refused);
    if (refused) return options.out.string() + ": cannot be made: " + refused.message();
    for (const Camera& camera : cameras) {
        if (!camera.lens || camera.out.empty()) continue;
        if (camera.lens->verdict == calib::Verdict::kFail && !options.keeps_failed) continue;
        const std::string problem = calib::SaveLens(
            *camera.lens, WrittenBy(options.command, calib::IntrinsicsLimits()), camera.out);
        if (!problem.empty()) return problem;
    }
    return options.json.empty() ? ""
                                : WriteFigures(AllFigures(cameras), options.command, options.json);
}

}  // namespace

CLI::App& AddIntrinsics(CLI::App& app, IntrinsicsOptions& options) {
    CLI::App& verb =
        *app.add_subcommand("intrinsics",
                            "Measure a lens from pictures of a board, and judge the result.\n"
                            "Exit code 0: it may be driven with, 1: not, and why.\n"
                            "Example: hitchview-calib intrinsics --images 'front/*.jpg' --board "
                            "9x6,0.025 --model fisheye "
                            "--out front.yaml");
    auto* const source = verb.add_option_group("pictures");
    source->add_option("--images", options.images, "pictures of one camera, a pattern in quotes");
    source->add_option("--folder", options.folder,
                       "a folder of pictures for each camera, named as the camera is");
    source->require_option(1);
    verb.add_option("--board", options.board,
                    "board file, or COLSxROWS,SQUARE_M: inner corners, side of a square in metres")
        ->required();
    verb.add_option("--model", options.model, "pinhole, or fisheye for 120 degrees and more")
        ->transform(CLI::CheckedTransformer(std::map<std::string, algo::CameraModel::Kind>{
            {"pinhole", algo::CameraModel::Kind::kPinholeRadtan},
            {"fisheye", algo::CameraModel::Kind::kKannalaBrandt4}}))
        ->required();
    verb.add_option(
        "--out", options.out,
        "lens file to write, with the verdict in it; with --folder the folder of the files");
    verb.add_flag("--keep-failed", options.keeps_failed,
                  "write the lens file also when the verdict is fail");
    verb.add_option("--json", options.json, "file for all figures");
    return verb;
}

int IntrinsicsVerb(const IntrinsicsOptions& options) {
    const calib::ParsedBoard board = calib::ReadBoard(options.board);
    if (!board.board) return Fail(kWrongUse, board.error);
    auto found = CamerasOf(options);
    if (!found) return Fail(kWrongUse, found.error());
    std::vector<Camera>& cameras = found.value();
    for (Camera& camera : cameras) FindIn(*board.board, camera);
    MeasureAll(options, *board.board, cameras);
    for (const Camera& camera : cameras) Tell(camera);
    const bool has_one =
        std::ranges::any_of(cameras, [](const Camera& c) { return c.lens.has_value(); });
    const std::string problem = has_one ? Save(options, cameras) : "";
    if (!problem.empty()) return Fail(kMachineFailed, problem);
    return std::ranges::max(cameras, {}, &Camera::code).code;
}

}  // namespace hitchview::app

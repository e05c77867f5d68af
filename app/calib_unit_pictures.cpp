#include "app/calib_unit_pictures.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <thread>

#include "app/calib_pictures.hpp"
#include "calib/board_detector.hpp"
#include "calib/board_extent.hpp"

namespace hitchview::app {
namespace {

/// One picture of one camera.
struct Look {
    std::size_t camera = 0;
    std::string shot{};
    std::string file{};
    std::vector<calib::SeenCorners> targets{};  ///< empty corners: not seen
    std::string problem{};
};

std::string Size(int width_px, int height_px) {
    return std::to_string(width_px) + "x" + std::to_string(height_px);
}

/// Files of each camera, as looks to be taken.
hal::Checked<std::vector<Look>> ListLooks(const calib::UnitSession& session,
                                          UnitPictures& pictures) {
    std::vector<Look> looks;
    for (std::size_t camera = 0; camera < session.pictures.size(); ++camera) {
        ShotFiles& shots = pictures.files.emplace_back();
        for (const std::string& file : FilesLike(session.pictures[camera])) {
            const std::string shot = std::filesystem::path(file).stem().string();
            const auto [other, fresh] = shots.try_emplace(shot, file);
            if (!fresh)
                return file + ": has the same name as " + other->second +
                       ", must have one of its own, which is that of its shot";
            looks.push_back({.camera = camera, .shot = shot, .file = file});
        }
        if (shots.empty())
            return "camera " + session.problem.cameras[camera].name + ": no file is named " +
                   session.pictures[camera];
    }
    return looks;
}

/// A part of a large checkerboard is not a small one.
void ForgetParts(const cv::Mat& grey, std::span<const calib::Board> boards,
                 std::vector<calib::SeenCorners>& targets) {
    for (std::size_t i = 0; i < boards.size(); ++i) {
        if (boards[i].pattern == calib::Pattern::kCheckerboard && !targets[i].empty() &&
            calib::GoesOnBeyond(grey, boards[i], targets[i]))
            targets[i].clear();
    }
}

void LookFor(const calib::UnitProblem& problem, std::span<const calib::Board> boards, Look& look) {
    const cv::Mat grey =
        cv::imread(look.file, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    const algo::CameraModel& lens = problem.cameras[look.camera].model;
    if (grey.empty()) {
        look.problem = look.file + ": is no picture that can be read";
    } else if (grey.cols != lens.width_px || grey.rows != lens.height_px) {
        look.problem = look.file + ": is " + Size(grey.cols, grey.rows) + ", must be " +
                       Size(lens.width_px, lens.height_px) + " as its lens was measured";
    } else {
        look.targets = calib::DetectBoards(grey, boards);
        ForgetParts(grey, boards, look.targets);
    }
}

void LookAtAll(const calib::UnitProblem& problem, std::vector<Look>& looks) {
    std::vector<calib::Board> boards;
    for (const calib::UnitTarget& target : problem.targets) boards.push_back(target.board);
    std::atomic<std::size_t> next{0};
    std::atomic<std::size_t> done{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < looks.size(); i = next++) {
            LookFor(problem, boards, looks[i]);
            ShowProgress("looked at", ++done, looks.size(), "pictures");
        }
    };
    std::vector<std::jthread> threads;
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    for (unsigned i = 0; i < processors; ++i) threads.emplace_back(work);
}

}  // namespace

hal::Checked<UnitPictures> LookAtUnit(const calib::UnitSession& session) {
    UnitPictures pictures;
    auto looks = ListLooks(session, pictures);
    if (!looks) return looks.error();
    LookAtAll(session.problem, looks.value());
    for (Look& look : looks.value()) {
        if (!look.problem.empty()) return look.problem;
        for (std::size_t target = 0; target < look.targets.size(); ++target) {
            if (look.targets[target].empty()) continue;
            pictures.sightings.push_back(
                {look.camera, target, look.shot, std::move(look.targets[target])});
        }
    }
    return pictures;
}

hal::Checked<std::vector<cv::Mat>> ReadShot(const calib::UnitSession& session,
                                            const UnitPictures& pictures, const std::string& shot,
                                            int flags) {
    std::vector<cv::Mat> shown;
    for (std::size_t camera = 0; camera < pictures.files.size(); ++camera) {
        const auto file = pictures.files[camera].find(shot);
        if (file == pictures.files[camera].end())
            return "camera " + session.problem.cameras[camera].name + ": has no picture of shot " +
                   shot;
        shown.push_back(cv::imread(file->second, flags | cv::IMREAD_IGNORE_ORIENTATION));
        if (shown.back().empty()) return file->second + ": is no picture that can be read";
    }
    return shown;
}

}  // namespace hitchview::app

#include "app/calib_pictures.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <thread>

#include "calib/board_blur.hpp"
#include "calib/board_detector.hpp"
#include "calib/board_extent.hpp"

namespace hitchview::app {
namespace {

/// What one picture shows.
struct Look {
    cv::Size size_px{};            ///< empty: it cannot be read
    calib::SeenCorners corners{};  ///< empty: no board
    std::optional<double> blur_px{};
    bool larger_board = false;
};

Look LookAt(const std::string& file, const calib::Board& board) {
    const cv::Mat grey = cv::imread(file, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    if (grey.empty()) return {};
    Look look{.size_px = grey.size(),
              .corners = std::move(calib::DetectBoards(grey, {&board, 1}).front())};
    if (look.corners.empty()) return look;
    look.larger_board = board.pattern == calib::Pattern::kCheckerboard &&
                        calib::GoesOnBeyond(grey, board, look.corners);
    look.blur_px = calib::BoardBlur_px(grey, board, look.corners);
    return look;
}

std::vector<Look> LookAtAll(const std::vector<std::string>& files, const calib::Board& board) {
    std::vector<Look> looks(files.size());
    std::atomic<std::size_t> next{0};
    std::atomic<std::size_t> done{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < files.size(); i = next++) {
            looks[i] = LookAt(files[i], board);
            ShowProgress("looked at", ++done, files.size(), "pictures");
        }
    };
    std::vector<std::jthread> threads;
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    for (unsigned i = 0; i < processors; ++i) threads.emplace_back(work);
    threads.clear();
    return looks;
}

std::string Text(const cv::Size& size_px) {
    return std::to_string(size_px.width) + "x" + std::to_string(size_px.height);
}

}  // namespace

void ShowProgress(const char* what, std::size_t done, std::size_t all, const char* of_what) {
    if (isatty(STDERR_FILENO) == 0) return;
    std::fprintf(stderr, "\r%s %zu of %zu %s%s", what, done, all, of_what, done == all ? "\n" : "");
}

hal::Checked<BoardPictures> FindBoards(const std::string& pattern, const calib::Board& board) {
    const std::vector<std::string> files = FilesLike(pattern);
    if (files.empty()) return "no file is named " + pattern;
    std::vector<Look> looks = LookAtAll(files, board);
    BoardPictures found{.pictures = files.size()};
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (looks[i].size_px.empty()) return files[i] + ": is no picture that can be read";
        if (looks[i].size_px != looks[0].size_px)
            return files[i] + ": is " + Text(looks[i].size_px) + ", must be " +
                   Text(looks[0].size_px) + " as " + files[0];
        if (looks[i].corners.empty()) continue;
        if (looks[i].larger_board) ++found.larger_boards;
        found.views.push_back({std::filesystem::path(files[i]).filename().string(),
                               std::move(looks[i].corners), looks[i].blur_px});
    }
    found.width_px = looks[0].size_px.width;
    found.height_px = looks[0].size_px.height;
    return found;
}

}  // namespace hitchview::app

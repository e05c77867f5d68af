#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "calib/board.hpp"
#include "calib/board_pattern.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// What a sheet should be; what is not given is chosen so that the paper is filled.
struct SheetRequest {
    calib::Pattern pattern = calib::Pattern::kCharuco;
    std::optional<int> columns{};
    std::optional<int> rows{};
    std::optional<double> square_m{};
    std::optional<double> tag_m{};
    int first_tag = 0;
    std::string paper = "a4";  ///< a4 to a0, lying; or WIDTHxHEIGHT in mm
};

/// Where things stand on a sheet of paper: from its top left, x right, y down.
struct SheetPlan {
    calib::Board board;
    Eigen::Vector2d paper_mm = Eigen::Vector2d::Zero();
    Eigen::Vector2d pattern_mm = Eigen::Vector2d::Zero();  ///< top left of the pattern
    Eigen::Vector2d footer_mm = Eigen::Vector2d::Zero();   ///< left end of the measuring bar
};

/// The error says what is wrong with the paper or the board, and how large squares may be.
hal::Checked<SheetPlan> PlanSheet(const SheetRequest& request);

}  // namespace hitchview::app

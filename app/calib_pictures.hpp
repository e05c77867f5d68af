#pragma once

#include <string>
#include <vector>

#include "app/file_pattern.hpp"
#include "calib/board.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// What was found in pictures of one camera.
struct BoardPictures {
    int width_px = 0;
    int height_px = 0;
    std::size_t pictures = 0;               ///< looked at
    std::vector<calib::BoardView> views{};  ///< those with the whole board
    std::size_t larger_boards = 0;  ///< of these, those whose board goes on beyond its corners
};

/// Where a person sits before it: one line on stderr that says how far it is.
void ShowProgress(const char* what, std::size_t done, std::size_t all, const char* of_what);

/// Looks for the board in every picture that `pattern` (of the shell) names, on all processors, and
/// shows on stderr how far it is. The error names the pattern that fits no file, the picture that
/// cannot be read, or the two whose sizes differ.
hal::Checked<BoardPictures> FindBoards(const std::string& pattern, const calib::Board& board);

}  // namespace hitchview::app

#pragma once

#include <string>
#include <vector>

#include "calib/unit_solver.hpp"

namespace hitchview::calib {

/// Something that is not as the session says, and that explains the pictures much better.
struct UnitChange {
    enum class Kind {
        kCameraMoved,  ///< between two shots
        kTargetMoved,  ///< between two shots
        kWrongSize,    ///< of a board
    };
    Kind kind = Kind::kCameraMoved;
    std::string name{};         ///< of the camera or target
    std::size_t index = 0;      ///< same, or of a target's node, in the problem where it was found
    std::string last_before{};  ///< shot
    std::string first_after{};  ///< shot
    double turn_rad = 0;        ///< of what moved
    double shift_m = 0;         ///< same
    double size = 1;            ///< printed over said
    std::string rival{};        ///< what explains it as well: another camera or target; or empty
    double share_left = 1;      ///< of the robust cost, once it is taken into account
};

/// Looks for cameras and targets that moved between two shots and for boards of another size than
/// was said, the one that explains most first; a second one only beside the first, and so on, three
/// at most. Each camera (target) is placed anew in each shot against the targets that do not move
/// (cameras); a move is suspected where its places before and after a shot differ by more than
/// their errors allow (chi squared over 60 with 6 degrees of freedom) and by more than 0.05 degrees
/// or 5 mm; a size where it is 5 standard deviations and 0.5 % from 1. What is suspected is solved
/// for in a joint adjustment and believed if it takes away a fifth of the robust cost. Where it
/// moved is told by shots of targets that stand still only.
std::vector<UnitChange> FindChanges(const UnitProblem& problem, const CameraGraph& graph,
                                    const UnitSolution& solution);

/// For a person.
std::string Describe(const UnitChange& change);

}  // namespace hitchview::calib

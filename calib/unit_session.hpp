#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "algo/unit.hpp"
#include "calib/unit_problem.hpp"

namespace hitchview::calib {

/// What a person wrote down about the pictures of one unit:
///
///     schema: 1
///     unit: tractor                  # or trailer
///     vehicle: "yard truck 7"
///     cameras:
///       tractor_left:
///         lens: lenses/left.yaml     # of `intrinsics`; one whose verdict is fail is refused
///         pictures: 'left/*.png'
///         yaw_deg: 90                # rough direction in which it looks, within 45 degrees
///         pose: {position_m: [1, 0.7, 1.4], rpy_deg: [0, 5, 90], sigma_m: 0.02, sigma_deg: 2}
///     targets:
///       gate: {board: '10x7,0.08'}
///       pole:
///         board: boards/pole.yaml
///         surveyed: [{corner: top_left, at_m: [4.2, 1.1, -1.0]}]
///         sigma_m: 0.003
///       carried: {board: boards/small.yaml, moves: true}
///     far: '007'                     # shot that shows things far away
///
/// `pose`, `surveyed`, `moves` and `far` are optional. Names of files are relative to the session's
/// folder. Surveyed are the outer corners of what is printed (of the outermost squares or tags), in
/// the unit frame; three or more give the target's whole place. Pictures of one moment have the
/// same file stem in each camera's folder.
struct UnitSession {
    algo::Unit unit = algo::Unit::kTractor;
    std::string vehicle{};
    UnitProblem problem{};                ///< without sightings
    std::vector<std::string> pictures{};  ///< of each camera: pattern of the shell
    std::string far_shot{};               ///< empty: none
};

/// A session, or what is wrong with its file: one line `file:line: key is VALUE, must be ...` for
/// each mistake.
struct LoadedUnitSession {
    std::optional<UnitSession> session{};
    std::string error{};  ///< empty when there is a session
};

/// Strict; reads the lenses and boards, too. Throws nothing.
LoadedUnitSession LoadUnitSession(const std::filesystem::path& file);

}  // namespace hitchview::calib

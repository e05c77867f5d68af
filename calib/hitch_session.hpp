#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calib/hitch_solver.hpp"
#include "calib/unit_session.hpp"

namespace hitchview::calib {

/// What a person wrote down about pictures of both units with the trailer turned:
///
///     schema: 1
///     calibration: rig.calib.yaml    # of both units; one whose verdict is fail is refused
///     pictures: {front: 'front/*.png', left: 'left/*.png'}   # of its cameras, at least one a unit
///     targets:
///       gate: {board: '10x7,0.08'}
///     straight: ['001', '002']       # shots with the units in line; optional
///     height_m: 0.1                  # of the hitch point in the tractor's frame; default 0
///
/// Names of files are relative to the session's folder. Targets stand still while the vehicle moves
/// between the shots; pictures of one moment have the same file stem in each camera's folder.
struct HitchSession {
    RigCalibration rig{};
    HitchProblem problem{};               ///< without sightings
    std::vector<std::string> pictures{};  ///< of each camera: pattern of the shell
};

/// A session, or what is wrong with its file: one line `file:line: key is VALUE, must be ...` for
/// each mistake.
struct LoadedHitchSession {
    std::optional<HitchSession> session{};
    std::string error{};  ///< empty when there is a session
};

/// Strict; reads the calibration and the boards, too. Throws nothing.
LoadedHitchSession LoadHitchSession(const std::filesystem::path& file);

}  // namespace hitchview::calib

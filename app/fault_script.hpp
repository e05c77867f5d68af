#pragma once

#include <array>
#include <climits>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/config.hpp"
#include "hal/result.hpp"

/// Faults that happen to cameras at stated frames, so that what the program does about them can be
/// tried on any rig, simulated or real. docs/faults.md shows every key.
namespace hitchview::app {

enum class FaultKind : std::uint8_t {
    kDead,          ///< the device is gone
    kOtherFormat,   ///< the device gives another size or format
    kSilent,        ///< it is there, and gives nothing
    kDamaged,       ///< its frames come damaged
    kLate,          ///< its frames come four periods after their exposure
    kSwappedStamps, ///< the time stamps of each two frames are exchanged
    kStuckNumbers,  ///< the number of its frames does not step
    kFrozen,        ///< the same picture in each frame, with new stamps
    kBlack,
    kBlinded,       ///< all of the picture is white or nearly
    kBlurred,       ///< all of the picture is out of focus
    kDirty,         ///< about a third of the picture is behind smears
};
inline constexpr std::array kFaultKinds{
    FaultKind::kDead,         FaultKind::kOtherFormat, FaultKind::kSilent,  FaultKind::kDamaged,
    FaultKind::kLate,         FaultKind::kSwappedStamps, FaultKind::kStuckNumbers,
    FaultKind::kFrozen,       FaultKind::kBlack,       FaultKind::kBlinded, FaultKind::kBlurred,
    FaultKind::kDirty};

/// As in fault scripts.
const char* ToString(FaultKind kind);

/// What happens to one camera.
struct CameraFault {
    static constexpr int kForEver = INT_MAX;

    FaultKind does = FaultKind::kDead;
    int from = 0;           ///< first frame that it befalls; frames count from the program's start
    int until = kForEver;   ///< first frame that is sound again

    [[nodiscard]] bool Befalls(int frame) const { return from <= frame && frame < until; }
};

/// One line of the script.
struct ScriptedFault {
    std::vector<std::string> cameras{};  ///< empty: all
    CameraFault fault{};
};

struct FaultScript {
    std::string file{};  ///< for messages
    std::optional<std::string> scenario{};  ///< of the simulation, in place of the rig's
    std::optional<int> frames{};            ///< of the drive, in place of the rig's
    std::vector<ScriptedFault> faults{};

    /// In the order of the script.
    [[nodiscard]] std::vector<CameraFault> Of(const std::string& camera) const;
};

/// The error has one line for each mistake, as those of LoadRigConfig. Throws nothing.
hal::Checked<FaultScript> LoadFaultScript(const std::filesystem::path& file);
hal::Checked<FaultScript> ParseFaultScript(const NamedText& script);

/// Done, or the camera of the script that the rig does not have.
hal::Checked<hal::Done> CheckCameras(const FaultScript& script, const RigConfig& rig);

/// The drive of the script in place of the rig's.
void TakeDrive(const FaultScript& script, RigConfig& rig);

}  // namespace hitchview::app

#pragma once

#include <array>
#include <cstdint>

namespace hitchview::hal {

/// How one camera does. Of several that apply, the first of this list is told. The numbers stand on
/// the wire: see lcmtypes/hitchview_camera_health_t.lcm.
enum class CameraState : std::uint8_t {
    kGood = 0,
    kLost = 1,        ///< gives no frames
    kLate = 2,        ///< its frames come too late for their sets
    kDisordered = 3,  ///< its time stamps go back
    kBlack = 4,       ///< nothing but darkness: covered, or its sensor is dead
    kBlinded = 5,     ///< most of the picture is white
    kFrozen = 6,      ///< the same picture over and over, as if it were new
    kStuck = 7,       ///< the numbers of its frames do not step
    kBlurred = 8,     ///< no fine detail anywhere: dirty, wet or out of focus
    kDirty = 9,       ///< parts of the picture have lost their detail
};

inline constexpr std::array kCameraStates{
    CameraState::kGood,       CameraState::kLost,    CameraState::kLate,   CameraState::kDisordered,
    CameraState::kBlack,      CameraState::kBlinded, CameraState::kFrozen, CameraState::kStuck,
    CameraState::kBlurred,    CameraState::kDirty};

constexpr const char* ToString(CameraState state) {
    switch (state) {
        case CameraState::kGood:
            return "good";
        case CameraState::kLost:
            return "lost";
        case CameraState::kLate:
            return "late";
        case CameraState::kDisordered:
            return "disordered";
        case CameraState::kBlack:
            return "black";
        case CameraState::kBlinded:
            return "blinded";
        case CameraState::kFrozen:
            return "frozen";
        case CameraState::kStuck:
            return "stuck";
        case CameraState::kBlurred:
            return "blurred";
        case CameraState::kDirty:
            return "dirty";
    }
    return "unknown";
}

/// A picture that may be old, or shows nothing, is never shown as if it were live.
constexpr bool IsShown(CameraState state) {
    return state == CameraState::kGood || state == CameraState::kBlinded ||
           state == CameraState::kStuck || state == CameraState::kBlurred ||
           state == CameraState::kDirty;
}

}  // namespace hitchview::hal

#pragma once

#include "app/fault_script.hpp"
#include "hal/camera_state.hpp"

namespace hitchview::tests {

/// What a camera that this befalls is to be called.
inline hal::CameraState StateOf(app::FaultKind kind) {
    switch (kind) {
        case app::FaultKind::kDead:
        case app::FaultKind::kOtherFormat:
        case app::FaultKind::kSilent:
        case app::FaultKind::kDamaged:
            return hal::CameraState::kLost;
        case app::FaultKind::kLate:
            return hal::CameraState::kLate;
        case app::FaultKind::kSwappedStamps:
            return hal::CameraState::kDisordered;
        case app::FaultKind::kStuckNumbers:
            return hal::CameraState::kStuck;
        case app::FaultKind::kFrozen:
            return hal::CameraState::kFrozen;
        case app::FaultKind::kBlack:
            return hal::CameraState::kBlack;
        case app::FaultKind::kBlinded:
            return hal::CameraState::kBlinded;
        case app::FaultKind::kBlurred:
            return hal::CameraState::kBlurred;
        case app::FaultKind::kDirty:
            return hal::CameraState::kDirty;
    }
    return hal::CameraState::kGood;
}

}  // namespace hitchview::tests

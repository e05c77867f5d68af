#pragma once

#include <functional>
#include <vector>

#include "drivers/simulated_options.hpp"

namespace hitchview::drivers {

/// Automatic exposure of cameras that lags behind the light: the logarithm of the gain nears its
/// target with a time constant of half a second. Thread-safe.
class AutoExposure {
 public:
    /// `light_at(camera, frame)`: light around the camera relative to daylight, > 0.
    AutoExposure(const SimulationOptions& options, int cameras,
                 const std::function<double(int, int)>& light_at);

    [[nodiscard]] double GainAt(int camera, int frame) const;

 private:
    int frames_;
    std::vector<float> gains_;
};

}  // namespace hitchview::drivers

#include "drivers/simulated_exposure.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::drivers {
namespace {

constexpr double kTimeConstant_s = 0.5;
constexpr double kLargestGain = 4;
constexpr double kZeal = 0.85;  // dark places stay a little darker

}  // namespace

AutoExposure::AutoExposure(const SimulationOptions& options, int cameras,
                           const std::function<double(int, int)>& light_at)
    : frames_(options.frames) {
    const double period_s = std::chrono::duration<double>(options.period).count();
    const double step = 1 - std::exp(-period_s / kTimeConstant_s);
    gains_.reserve(static_cast<std::size_t>(cameras) * static_cast<std::size_t>(frames_));
    for (int camera = 0; camera < cameras; ++camera) {
        double log_gain = 0;
        for (int frame = 0; frame < frames_; ++frame) {
            const double wanted =
                std::min(-kZeal * std::log(light_at(camera, frame)), std::log(kLargestGain));
            log_gain += (frame == 0 ? 1 : step) * (wanted - log_gain);
            gains_.push_back(static_cast<float>(std::exp(log_gain)));
        }
    }
}

double AutoExposure::GainAt(int camera, int frame) const {
    return gains_[static_cast<std::size_t>(camera * frames_ + frame)];
}

}  // namespace hitchview::drivers

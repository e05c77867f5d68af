#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulated_options.hpp"
#include "drivers/simulated_road.hpp"
#include "drivers/simulated_solids.hpp"

namespace hitchview::drivers {

/// Trucks on the road, each at constant speed. Thread-safe.
class Traffic {
 public:
    /// From bumper to bumper.
    static constexpr double kTruckLength_m = 16;

    /// `road` must outlive the traffic.
    Traffic(const std::vector<SceneOptions::Truck>& trucks, const Road& road, std::uint32_t seed);

    /// What they consist of, where it stands at `time_s` of the drive. Replaces `out`.
    void PlaceAt(double time_s, std::vector<Solid>& out) const;

 private:
    struct Truck {
        SceneOptions::Truck course;
        std::vector<Solid> parts;  // from the middle of the truck on the ground, x forward
    };

    const Road& road_;
    std::vector<Truck> trucks_;
};

}  // namespace hitchview::drivers

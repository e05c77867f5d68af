#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "algo/composed_map.hpp"
#include "app/rig_geometry.hpp"

namespace hitchview::app {

/// What the calibration lets the cameras cover, and what of it a rendered map covers. Borrows the
/// geometry.
class TruthCoverage {
 public:
    explicit TruthCoverage(const RigGeometry& geometry);

    struct Reference {
        std::vector<std::uint8_t> covered;             ///< by any camera, per corner of the map
        algo::PerOverlap<bool> there{{false, false}};  ///< wide enough to be stitched
    };
    /// With nothing moved but the trailer turned by this angle about the hitch, to the degree.
    /// `missing`: see HasData.
    const Reference& At(double articulation_rad, std::uint32_t missing);

    /// Share of the reference's corners where `map` has data.
    [[nodiscard]] double ShareOf(const algo::ComposedMap& map, const Reference& reference,
                                 std::uint32_t missing) const;

 private:
    [[nodiscard]] Reference Make(double articulation_rad, std::uint32_t missing);
    [[nodiscard]] bool Overlaps(int from_col, int to_col, std::uint32_t missing) const;

    const RigGeometry& geometry_;
    algo::ComposedMap map_;
    std::map<std::pair<int, std::uint32_t>, Reference> references_;
};

}  // namespace hitchview::app

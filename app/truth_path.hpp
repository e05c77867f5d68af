#pragma once

#include <array>
#include <vector>

#include "app/truth_sight.hpp"
#include "app/truth_spectrum.hpp"

namespace hitchview::app {

/// How steadily the canvas shows far landmarks all round: their paths in each unit's view as it was
/// taken, and on the canvas. Frames are observed in order; those dropped in between count as if
/// they had never been taken.
class TruthPath {
 public:
    /// Vibration of a vehicle on its springs and tyres; steering is slower.
    static constexpr FrequencyBand kShake{1, 15};

    TruthPath(TruthSight& sight, double rate_hz);

    void Observe(int frame, const algo::Composition& composition);

    /// Root mean squares over landmarks and time, both axes together, canvas px.
    struct Shake {
        double input_px = 0;    ///< in the unit's view
        double output_px = 0;   ///< on the canvas
        double largest_px = 0;  ///< largest second difference on the canvas
        int samples = 0;
    };
    [[nodiscard]] Shake ShakeOf(algo::Unit unit) const;

 private:
    static constexpr int kLandmarks = 36;
    /// Shorter paths cannot tell the band from what is slower.
    static constexpr std::size_t kShortest = 45;  // frames

    /// Path of a landmark while one camera shows it: another one sees from another place, and that
    /// step is parallax of the rig, not shake.
    /// Its path on the canvas is that of the pose and, on top, what the stitching field adds. While
    /// something hides it for a moment nobody sees what the field adds: that goes straight then.
    struct Segment {
        int camera = -1;
        std::vector<Eigen::Vector2d> view_px;  ///< unrolled: no step where a ring closes
        std::vector<Eigen::Vector2d> posed_px;
        std::vector<Eigen::Vector2d> field_px;  ///< shorter while it is hidden
    };
    static constexpr std::size_t kLongestHidden = 15;  // frames

    [[nodiscard]] Sighting Look(algo::Unit unit, std::size_t landmark, int frame,
                                const algo::Composition& composition) const;
    void Extend(algo::Unit unit, std::size_t landmark, int frame, const Sighting& sighting,
                const algo::Composition& pose);
    void AddTo(Shake& shake, const Segment& segment) const;

    TruthSight& sight_;
    double rate_hz_;
    std::array<Eigen::Vector3d, kLandmarks> landmarks_;
    algo::PerUnit<std::array<Segment, kLandmarks>> open_;
    algo::PerUnit<std::vector<Segment>> closed_;
};

}  // namespace hitchview::app

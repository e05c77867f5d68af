#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "app/pipeline.hpp"
#include "app/truth_sight.hpp"

namespace hitchview::app {

/// One scene point that both units show.
struct OverlapSample {
    algo::Overlap overlap;
    int frame;
    Eigen::Vector2d canvas_px;        ///< where the tractor's part shows it
    Eigen::Vector2d misalignment_px;  ///< from there to where the trailer's part shows it
    double distance_m;                ///< from the tractor's camera
    bool in_strip;                    ///< both units have a part in the picture there
    bool on_grid;                     ///< one of the even sample of the whole overlap
    bool locked;                      ///< the seam of this overlap says so
    double oracle_px = 0;             ///< misalignment left by the best field; on_grid only
};

/// Misalignment of the two units against the scene's geometry, in the strip where they are blended
/// and over the whole overlap, there beside an oracle: what the field of the same mesh that fits
/// the true misalignments of the same frame best would leave of them.
class TruthOverlap {
 public:
    explicit TruthOverlap(TruthSight& sight) : sight_(sight) {}

    /// Rays into the scene are dear: call it for some of the frames. `used`: the composition as
    /// `map` shows it.
    void Observe(const ShownPanorama& shown, const algo::Composition& used,
                 const algo::ComposedMap& map);

    [[nodiscard]] const std::vector<OverlapSample>& samples() const { return samples_; }
    /// Mean misalignment in the strip of points beyond 10 m in the newest frame; 0 without points.
    [[nodiscard]] double NewestStripError_px(algo::Overlap overlap) const;

 private:
    void ObserveCorner(const ShownPanorama& shown, const algo::Composition& used,
                       const algo::ComposedMap& map, int row, int col);
    void AskOracle(std::size_t first);

    TruthSight& sight_;
    std::vector<OverlapSample> samples_;
};

/// Medians and 95 percentiles by distance, overlap and seam state.
nlohmann::json ToJson(const std::vector<OverlapSample>& samples);

}  // namespace hitchview::app

#pragma once

#include <Eigen/Core>
#include <array>

#include "algo/corner_grid.hpp"
#include "algo/corner_samples.hpp"
#include "algo/detail_past.hpp"
#include "algo/mesh.hpp"
#include "algo/scanline_fit.hpp"
#include "algo/stitching_motion_field.hpp"
#include "algo/unit.hpp"

namespace hitchview::algo {

struct DetailFieldOptions {
    double kappa = 0.5;         ///< as of the stitching field
    double reach_px = 14;       ///< a sample this far from a corner tells nothing of it
    double outlier_px = 2;      ///< a sample this far off its corner's value counts a quarter
    double smoothness = 0.05;   ///< of the membrane, against a corner with one full sample
    int sweeps = 6;             ///< of the membrane
    double most_doubt_px = 20;  ///< of a single sample
    double unknown_px = 8;      ///< doubt where there is no sample
    ScanlineFitOptions scanlines{};
    DetailPastOptions past{};
};

/// What the mesh of the stitching field is too coarse for: things with edges in depth. The rest of
/// the discrepancy, fitted to a dense set of pairs at the corners of the composed map. Where near
/// and far things meet on one place, the field follows what it can follow without a fold
/// (ScanlineFit); FadeFromSeams then bounds what is left of its slopes. What is in doubt is held to
/// what it was in the fit before (DetailPast). Ring only: an overlap in each half of the canvas.
/// Memory is taken at construction; the two overlaps may be handled at once on two threads, each
/// call for one.
class DetailField {
 public:
    DetailField(const Projection& canvas, const DetailFieldOptions& options);

    /// Forgets what was fitted before.
    void Reset();
    /// Starts a fit.
    void Clear(Overlap overlap);
    /// Takes a pair; `weight` 0..1: how well it is known. What lies in the other half, or does not
    /// fit any more, is left out.
    void Add(Overlap overlap, const CanvasPair& pair, float weight);
    /// Fits to what was added; `discrepancy`: what the mesh says of it.
    void Fit(Overlap overlap, const VertexField& discrepancy);

    /// To be added to the discrepancy of the mesh, px. Zero outside the overlaps.
    [[nodiscard]] const CornerField& detail() const { return detail_; }
    /// How far the samples round a corner are off the result on average, px; unknown_px without.
    [[nodiscard]] const CornerScalars& doubt_px() const { return doubt_px_; }

    /// Samples of a corner and of the eight round it, and a block of nothing.
    struct Neighbours {
        static constexpr int kMost = 108;
        static constexpr std::size_t kBlock = CornerSamples::kBlock;  ///< handled at once
        using List = std::array<float, kMost + 2 * kBlock>;
        List x_px;  ///< discrepancy
        List y_px;
        List weight;  ///< less where far from the corner
        int count;
    };

 private:
    [[nodiscard]] CornerColumns HalfOf(Overlap overlap) const;
    [[nodiscard]] CornerColumns FindRange(Overlap overlap) const;
    void FitSamples(Overlap overlap, const CornerColumns& range);
    void LookUpMesh(const VertexField& discrepancy, const CornerColumns& range);
    void Vote(const CornerSamples& samples, const CornerColumns& range, float sign,
              ScanlineFit& fit) const;
    void Settle(const Neighbours& around, int row, int col, float start_px);
    void Subtract(const CornerColumns& range);
    void Smooth(const CornerColumns& range);
    void Sweep(const CornerColumns& range);
    void Doubt(const CornerSamples& samples, const CornerColumns& range);
    [[nodiscard]] Eigen::Vector2f MissesAt(const CornerSamples& samples, int row, int col) const;
    void Gather(const CornerSamples& samples, int row, int col, const CornerColumns& range,
                Neighbours& around) const;

    Projection canvas_;
    Mesh mesh_;
    float spacing_px_;  // of the corners
    DetailFieldOptions options_;
    PerOverlap<CornerSamples> samples_;
    PerOverlap<ScanlineFit> scanlines_;
    CornerField wanted_;              // the discrepancy, then its rest, then its share
    CornerScalars support_;           // weight of the samples that agree with it
    CornerScalars neighbours_share_;  // of each of four, in the membrane
    CornerField smooth_;              // the mesh's part of the discrepancy
    CornerField misses_;              // weighted sum and weight of each corner
    CornerField detail_;
    CornerScalars doubt_px_;
    DetailPast past_;
};

}  // namespace hitchview::algo

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "algo/census.hpp"
#include "algo/feature_matcher.hpp"
#include "algo/label_reach.hpp"
#include "algo/semi_global_matching.hpp"
#include "algo/semi_surround_view.hpp"
#include "algo/unit.hpp"

namespace hitchview::algo {

struct OverlapParallaxOptions {
    double nearest_m = 3.0;      ///< distance of the nearest thing that is found
    double beyond_per_m = 0.04;  ///< how far behind the alignment surface things may seem, 1 / m:
                                 ///< the ground of a unit that pitches
    int labels = 96;             ///< distances tried
    double surface_bias = 0.1;   ///< cost per label off the alignment surface
    int clear_lead = 40;         ///< of a distance over the others, in summed cost
    SemiGlobalOptions matching{};
};

/// What a node of the tractor's view shows, found in the trailer's.
struct ParallaxMatch {
    ViewPair pair;  ///< analysis px
    float weight;   ///< how well its texture tells where it is, 0..1
    bool clear;     ///< no other distance fits as well
};

/// Parallax between the two units' views of a ring at every node of a grid over one overlap. A
/// pixel of the tractor's view shows something on a line; where the trailer's view shows that lies
/// on a curve (the epipolar curve, bent by the alignment surface), by its inverse distance.
/// Census signatures along the curves are compared by semi-global matching, so that smooth things
/// help their neighbours and edges in depth stay sharp; then each match is refined. Memory is taken
/// at construction; an object belongs to one thread at a time.
class OverlapParallax {
 public:
    /// Trailer px by label k: start + k linear + k^2 square.
    struct Curve {
        Eigen::Vector2f start = Eigen::Vector2f::Zero();
        Eigen::Vector2f linear = Eigen::Vector2f::Zero();
        Eigen::Vector2f square = Eigen::Vector2f::Zero();
        bool known = false;
        [[nodiscard]] Eigen::Vector2f At(float k) const {
            return start + k * (linear + k * square);
        }
    };
    static constexpr int kPitch_px = 2;     ///< of the nodes in a row, analysis px
    static constexpr int kRowPitch_px = 3;  ///< of the rows of nodes

    /// Borrows the views.
    OverlapParallax(const PerUnit<UnitGeometry>& geometry,
                    const PerUnit<const SemiSurroundView*>& views, Overlap overlap,
                    const OverlapParallaxOptions& options);

    /// `R_tractor_trailer` takes rays of the trailer's view to the tractor's.
    void Match(const PerUnit<MatchView>& views, const Eigen::Matrix3d& R_tractor_trailer);
    /// Forgets what was found.
    void Reset() { reach_.Reset(); }

    [[nodiscard]] int rows() const { return matching_.rows(); }
    [[nodiscard]] int cols() const { return matching_.cols(); }  ///< 0: nothing overlaps
    [[nodiscard]] const std::optional<ParallaxMatch>& At(int row, int col) const {
        return matches_[Index(row, col)];
    }

 private:
    static constexpr int kCurvePitch_px = 8;
    /// What the tractor sees at a node of the curves, wherever the trailer is.
    struct Sight {
        Eigen::Vector3d ray;
        SightLine line;
        double surface_m = 0;  ///< distance of the alignment surface on the line
        bool known = false;
    };

    void LookOut();
    void LayCurves(const Eigen::Matrix3d& R_tractor_trailer);
    [[nodiscard]] std::optional<SightLine> OtherSight(const Eigen::Vector3d& ray) const;
    [[nodiscard]] Curve CurveOf(const Sight& sight, const Eigen::Matrix3d& R_tractor_trailer) const;
    [[nodiscard]] Curve CurveAt(int x, int y) const;
    [[nodiscard]] Curve& NodeCurve(int row, int col) { return node_curves_[Index(row, col)]; }
    bool ChooseColumns();
    [[nodiscard]] std::pair<int, int> TrailerColumns() const;
    void Compare(const PerUnit<MatchView>& views);
    void CompareNode(int row, int col);
    [[nodiscard]] bool HasSignature(int x, int y) const {
        return (census_[Unit::kTractor].At(x, y) & Census::kNone) == 0;
    }
    void TakeAnswers(const PerUnit<MatchView>& views);
    [[nodiscard]] std::optional<ParallaxMatch> MatchOf(const PerUnit<MatchView>& views, int row,
                                                       int col);
    [[nodiscard]] double Span_per_m() const {
        return options_.beyond_per_m + 1 / options_.nearest_m;
    }
    [[nodiscard]] int NodeX(int col) const { return left_px_ + kPitch_px * col; }
    /// Of the column in a grid over the whole half of the view.
    [[nodiscard]] int ColumnOf(int col) const { return col + (left_px_ - first_px_) / kPitch_px; }
    static int NodeY(int row) { return kRowPitch_px * row; }
    [[nodiscard]] std::size_t Index(int row, int col) const {
        return static_cast<std::size_t>(row * max_cols_ + col);
    }

    PerUnit<UnitGeometry> geometry_;
    PerUnit<const SemiSurroundView*> views_;
    OverlapParallaxOptions options_;
    int first_px_;  // columns of the tractor's analysis view that may lie in the overlap
    int end_px_;
    int curve_rows_;
    int curve_cols_;
    std::vector<Sight> sights_;
    std::vector<Curve> curves_;
    PerUnit<Census> census_;
    std::vector<SemiGlobalMatching::Cost> bias_;  // of each label, towards the alignment surface
    std::vector<int> places_;  // of the labels of one node in the trailer's census
    int max_cols_;
    LabelReach reach_;
    int left_px_ = 0;  // of the first column of nodes
    SemiGlobalMatching matching_;
    std::vector<Curve> node_curves_;  // of the nodes; not known where there is no signature, too
    std::vector<std::optional<ParallaxMatch>> matches_;
};

}  // namespace hitchview::algo

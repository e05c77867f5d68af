#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "algo/unit_geometry.hpp"

namespace hitchview::algo {

/// UnitGeometry::See for pixels of the unit's view, from a table: exact at the nodes of a grid over
/// the view and a little above and below it, bilinear between them; beyond, and next to the edge of
/// what a lens sees, nothing is seen. A hundred times cheaper than lens models. Memory is taken at
/// construction; thread-safe afterwards.
class SightTable {
 public:
    explicit SightTable(const UnitGeometry& geometry);

    /// Cameras that have a pixel for this pixel of the view, on a ring also whole turns off; those
    /// that give no picture (not `present`) have no share.
    void See(const Eigen::Vector2d& view_px, const CameraMask& present,
             UnitGeometry::Sights& sights) const;

 private:
    static constexpr int kCols = 512;  ///< of nodes all round, whatever the view's size

    struct Node {
        float x_px = 0;
        float y_px = 0;
        bool sees = false;
    };
    /// The columns of nodes that one camera sees: from `first`, perhaps across the view's edge.
    struct Camera {
        int width_px = 0;
        int height_px = 0;
        int first = 0;
        int cols = 0;
        std::vector<Node> nodes;
    };

    void Fill(const UnitGeometry& geometry);
    void Crop(const std::vector<Node>& whole, Camera& camera) const;
    [[nodiscard]] bool SeesColumn(const std::vector<Node>& whole, int col) const;

    bool ring_;
    double pitch_px_;   ///< of the nodes
    double edge_px_;    ///< row of the view where the alignment surface has an edge
    int rows_to_edge_;  ///< so that nodes lie on it
    int rows_;
    std::vector<Camera> cameras_;
    std::array<CameraMask, kCols> seeing_;  ///< from a column of nodes to the next
};

}  // namespace hitchview::algo

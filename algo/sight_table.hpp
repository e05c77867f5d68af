#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "algo/unit_geometry.hpp"

namespace hitchview::algo {

/// Pixels of a view that are handled together.
struct PixelRun {
    static constexpr int kMost = 64;
    template <typename T>
    using Of = std::array<T, kMost>;

    alignas(64) Of<float> x_px;
    alignas(64) Of<float> y_px;
    int count = 0;
};

/// What one camera has for the pixels of a run from `first` up to `end`; elsewhere it has nothing.
struct CameraSightRun {
    int camera;  ///< index within the unit
    int first;
    int end;
    alignas(64) PixelRun::Of<float> x_px;  ///< of its picture, perhaps outside; NaN: it has none
    alignas(64) PixelRun::Of<float> y_px;
    alignas(64) PixelRun::Of<float> share;  ///< in the view, 0..1
};

/// A list that is not cleared before it is filled.
struct SightRuns {
    SightRuns() {}  // NOLINT(modernize-use-equals-default)

    [[nodiscard]] std::span<CameraSightRun> cameras() {
        return {camera.data(), static_cast<std::size_t>(count)};
    }

    std::array<CameraSightRun, kMaxCameras> camera;
    int count = 0;
};

/// UnitGeometry::See for pixels of the unit's view, from a table: exact at the nodes of a grid over
/// the view and, above and below, what tilts bring into it; bilinear between them; beyond, and next
/// to the edge of what a lens sees, nothing. Hundreds of times cheaper than lens models. Memory is
/// taken at construction; thread-safe afterwards.
class SightTable {
 public:
    explicit SightTable(const UnitGeometry& geometry);

    /// Cameras that have a pixel for pixels of the view, on a ring also whole turns off; those that
    /// give no picture (not `present`) have no share.
    void See(const PixelRun& view, const CameraMask& present, SightRuns& sights) const;

 private:
    static constexpr int kCols = 512;     ///< of nodes all round, whatever the view's size
    static constexpr int kBandRows = 16;  ///< of nodes, for which it is known who sees any

    using Node = Eigen::Array2f;  ///< pixel; NaN where the camera has none, which spreads
    /// The columns of nodes that one camera sees: from `first`, perhaps across the view's edge.
    struct Camera {
        float width_px = 0;
        float height_px = 0;
        int first = 0;
        int cols = 0;
        std::vector<Node> nodes;
    };
    /// Where the pixels of a run lie among the nodes.
    struct Places {
        alignas(64) PixelRun::Of<std::int32_t> row;  ///< of the top left one of four nodes
        alignas(64) PixelRun::Of<std::int32_t> col;
        alignas(64) PixelRun::Of<float> s;  ///< to the right of it, 0..1
        alignas(64) PixelRun::Of<float> t;  ///< down from it, 0..1; else beyond the nodes
    };

    void Fill(const UnitGeometry& geometry);
    void NoteSeeing(const std::vector<Node>& whole, std::uint8_t camera_bit);
    /// Index into seeing_ of the field between four nodes whose top left one this is.
    [[nodiscard]] static std::size_t Band(int row, int col) {
        return static_cast<std::size_t>(row / kBandRows * kCols + col);
    }
    void Crop(const std::vector<Node>& whole, Camera& camera) const;
    [[nodiscard]] static bool Sees(const std::vector<Node>& whole, int row, int col);
    [[nodiscard]] bool SeesColumn(const std::vector<Node>& whole, int col) const;
    void Place(const PixelRun& view, Places& places) const;
    void FindCameras(const Places& places, int count, SightRuns& sights) const;
    void ReadPixels(const Places& places, CameraSightRun& sights) const;

    bool ring_;
    double pitch_px_;       ///< of the nodes
    double edge_px_;        ///< row of the view where the alignment surface has an edge
    int rows_to_edge_ = 0;  ///< so that nodes lie on it
    int rows_ = 0;
    std::vector<Camera> cameras_;
    std::vector<std::uint8_t> seeing_;  ///< bit per camera; by bands of rows and by columns
};

}  // namespace hitchview::algo

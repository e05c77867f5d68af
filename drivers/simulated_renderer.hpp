#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "algo/camera_model.hpp"
#include "drivers/simulated_world.hpp"

namespace hitchview::drivers {

/// Makes images of a world through one lens by casting a ray for each pixel, four at edges.
/// Tiles of the image look only at what can lie in them.
class Renderer {
 public:
    /// Memory that a rendering thread keeps from image to image.
    class Workspace {
        friend class Renderer;
        struct Strip {  // of one thread, reused for each strip of tiles
            std::vector<std::uint32_t> nearby;
            std::vector<std::size_t> tile_ends;
            std::vector<Hit> hits;
            std::vector<Colour> colours;
        };
        Surroundings around;
        std::vector<std::vector<std::uint32_t>> blocks;
        std::vector<Strip> strips;
    };

    /// What the sensor adds to the light.
    struct Exposure {
        float gain = 1;
        float noise_sigma = 0;  ///< grey levels
        std::uint32_t noise_seed = 0;
    };

    /// `world` must outlive the renderer.
    Renderer(const World& world, const algo::CameraModel& lens);

    /// Writes full-range NV12, tightly packed, to `out_nv12`. `threads` >= 1 share the work; the
    /// image does not depend on their number. Thread-safe, given one workspace for each thread.
    void Render(const Eigen::Isometry3d& T_world_camera, const Moment& moment,
                const Exposure& exposure, int threads, Workspace& workspace,
                std::span<std::uint8_t> out_nv12) const;

 private:
    /// Planes through the eye that bound a rectangle of the image; normals point inwards.
    using Wedge = std::array<Eigen::Vector3f, 4>;
    struct Frame;
    struct StripView;

    [[nodiscard]] Wedge WedgeOf(int column, int row, int side_px) const;
    [[nodiscard]] Wedge TileWedge(int column, int row) const;
    void FillBlocks(const Frame& frame, Workspace& workspace) const;
    void RenderStrip(const Frame& frame, int row, Workspace::Strip& strip) const;
    void FillTiles(const Frame& frame, int row, Workspace::Strip& strip) const;
    void CastRow(const StripView& view, int y_px) const;
    void ShadeRow(const StripView& view, int y_px) const;
    [[nodiscard]] Colour Supersampled(const StripView& view, int x_px, int y_px) const;
    void WriteLuma(const StripView& view, int y_px) const;
    void WriteChroma(const StripView& view, int y_px) const;
    [[nodiscard]] const Eigen::Vector3f& RayAt(int x_px, int y_px) const {
        return rays_camera_[static_cast<std::size_t>(y_px * lens_.width_px + x_px)];
    }

    const World& world_;
    algo::CameraModel lens_;
    float pixel_rad_;
    int tile_columns_, tile_rows_, block_columns_, block_rows_;
    std::vector<Eigen::Vector3f> rays_camera_;  // of each pixel, unit length
    std::vector<Wedge> tiles_, blocks_;         // camera frame
};

}  // namespace hitchview::drivers

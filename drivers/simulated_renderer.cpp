#include "drivers/simulated_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "drivers/simulated_noise.hpp"
#include "hal/expect.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;

constexpr int kTile_px = 16;
constexpr int kBlockTiles = 4;            // a block is this many tiles wide and high
constexpr float kSmallest_px = 0.5F;      // solids that fill less are not drawn
constexpr float kNoiseUnit = 1 / 147.8F;  // standard deviation of the sum of four random bytes

int DivideUp(int a, int b) {
    return (a + b - 1) / b;
}

std::uint8_t Byte(float value) {
    return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

/// About normal, of variance one.
float Noise(std::uint32_t hash) {
    const std::uint32_t sum =
        (hash & 255U) + ((hash >> 8) & 255U) + ((hash >> 16) & 255U) + (hash >> 24);
    return (static_cast<float>(sum) - 510) * kNoiseUnit;
}

/// False only if all of the solid's box lies outside one of the planes.
template <typename Wedge>
bool MayTouch(const VisibleSolid& solid, const Wedge& wedge_world) {
    return std::all_of(wedge_world.begin(), wedge_world.end(), [&](const Vector3f& normal) {
        const float reach = solid.ToLocal(normal).cwiseAbs().dot(solid.half_m);
        return normal.dot(solid.centre_m) + reach >= 0;
    });
}

template <typename Wedge>
Wedge Turned(const Eigen::Matrix3f& R_world_camera, const Wedge& wedge) {
    Wedge turned;
    for (std::size_t i = 0; i < wedge.size(); ++i) turned[i] = R_world_camera * wedge[i];
    return turned;
}

}  // namespace

/// What is constant while one image is made.
struct Renderer::Frame {
    Eigen::Matrix3f R_world_camera;
    Exposure exposure;
    const Surroundings& around;
    const std::vector<std::vector<std::uint32_t>>& blocks;
    std::span<std::uint8_t> out;
};

/// One row of tiles with a row of pixels above and below it.
struct Renderer::StripView {
    const Frame& frame;
    Workspace::Strip& strip;
    int width_px, first_y_px;

    [[nodiscard]] std::size_t Index(int x_px, int y_px) const {
        return static_cast<std::size_t>((y_px - first_y_px + 1) * width_px + x_px);
    }
    [[nodiscard]] std::span<const std::uint32_t> Nearby(int x_px) const {
        const auto tile = static_cast<std::size_t>(x_px / kTile_px);
        const std::size_t begin = tile == 0 ? 0 : strip.tile_ends[tile - 1];
        return {strip.nearby.data() + begin, strip.tile_ends[tile] - begin};
    }
};

Renderer::Renderer(const World& world, const algo::CameraModel& lens)
    : world_(world),
      lens_(lens),
      pixel_rad_(static_cast<float>(1 / lens.fx_px)),
      tile_columns_(DivideUp(lens.width_px, kTile_px)),
      tile_rows_(DivideUp(lens.height_px, kTile_px)),
      block_columns_(DivideUp(tile_columns_, kBlockTiles)),
      block_rows_(DivideUp(tile_rows_, kBlockTiles)) {
    rays_camera_.reserve(static_cast<std::size_t>(lens.width_px * lens.height_px));
    for (int y = 0; y < lens.height_px; ++y) {
        for (int x = 0; x < lens.width_px; ++x) {
            const auto ray = lens.Unproject({x, y});
            HV_EXPECT(ray.has_value());
            rays_camera_.emplace_back(ray->cast<float>());
        }
    }
    for (int i = 0; i < tile_columns_ * tile_rows_; ++i) {
        tiles_.push_back(WedgeOf(i % tile_columns_, i / tile_columns_, kTile_px));
    }
    for (int i = 0; i < block_columns_ * block_rows_; ++i) {
        blocks_.push_back(WedgeOf(i % block_columns_, i / block_columns_, kTile_px * kBlockTiles));
    }
}

/// The margin covers the bend that a straight edge has in a wide-angle image. Where no ray leads
/// through a corner, nothing is ruled out.
Renderer::Wedge Renderer::WedgeOf(int column, int row, int side_px) const {
    const double margin_px = 2 + side_px * side_px / (6 * lens_.fx_px);
    const Vector2d low = Vector2d(column * side_px, row * side_px).array() - margin_px;
    const Vector2d high = low.array() + side_px + 2 * margin_px;
    const std::array<Vector2d, 4> corners{low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    std::array<Vector3f, 4> rays;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto ray = lens_.Unproject(corners[i]);
        if (!ray) return {Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero()};
        rays[i] = ray->cast<float>();
    }
    Wedge wedge;
    for (std::size_t i = 0; i < 4; ++i) wedge[i] = rays[i].cross(rays[(i + 1) % 4]).normalized();
    return wedge;
}

void Renderer::Render(const Eigen::Isometry3d& T_world_camera, const Moment& moment,
                      const Exposure& exposure, int threads, Workspace& workspace,
                      std::span<std::uint8_t> out_nv12) const {
    HV_EXPECT(threads >= 1);
    HV_EXPECT(out_nv12.size() == rays_camera_.size() * 3 / 2);
    world_.Look(T_world_camera.translation(), moment, kSmallest_px * pixel_rad_, workspace.around);
    workspace.blocks.resize(blocks_.size());
    workspace.strips.resize(static_cast<std::size_t>(threads));
    const Frame frame{T_world_camera.linear().cast<float>(), exposure, workspace.around,
                      workspace.blocks, out_nv12};
    FillBlocks(frame, workspace);

    const auto render_share = [&](int share) {
        Workspace::Strip& strip = workspace.strips[static_cast<std::size_t>(share)];
        for (int row = share; row < tile_rows_; row += threads) RenderStrip(frame, row, strip);
    };
    std::vector<std::thread> others;
    for (int share = 1; share < threads; ++share) others.emplace_back(render_share, share);
    render_share(0);
    for (std::thread& other : others) other.join();
}

void Renderer::FillBlocks(const Frame& frame, Workspace& workspace) const {
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
        const Wedge wedge = Turned(frame.R_world_camera, blocks_[block]);
        std::vector<std::uint32_t>& nearby = workspace.blocks[block];
        nearby.clear();
        for (std::size_t i = 0; i < frame.around.solids.size(); ++i) {
            if (MayTouch(frame.around.solids[i], wedge))
                nearby.push_back(static_cast<std::uint32_t>(i));
        }
    }
}

void Renderer::FillTiles(const Frame& frame, int row, Workspace::Strip& strip) const {
    strip.nearby.clear();
    strip.tile_ends.clear();
    for (int column = 0; column < tile_columns_; ++column) {
        const auto tile = static_cast<std::size_t>(row * tile_columns_ + column);
        const auto block =
            static_cast<std::size_t>(row / kBlockTiles * block_columns_ + column / kBlockTiles);
        const Wedge wedge = Turned(frame.R_world_camera, tiles_[tile]);
        for (const std::uint32_t i : frame.blocks[block]) {
            if (MayTouch(frame.around.solids[i], wedge)) strip.nearby.push_back(i);
        }
        strip.tile_ends.push_back(strip.nearby.size());
    }
}

void Renderer::RenderStrip(const Frame& frame, int row, Workspace::Strip& strip) const {
    const int begin_px = row * kTile_px;
    const int end_px = std::min(begin_px + kTile_px, lens_.height_px);
    const auto pixels = static_cast<std::size_t>(lens_.width_px * (kTile_px + 2));
    strip.hits.resize(pixels);
    strip.colours.resize(pixels);
    FillTiles(frame, row, strip);

    const StripView view{frame, strip, lens_.width_px, begin_px};
    const int first_px = std::max(begin_px - 1, 0);
    const int last_px = std::min(end_px, lens_.height_px - 1);
    for (int y = first_px; y <= last_px; ++y) CastRow(view, y);
    for (int y = begin_px; y < end_px; ++y) ShadeRow(view, y);
    for (int y = begin_px; y < end_px; ++y) WriteLuma(view, y);
    for (int y = begin_px; y < end_px; y += 2) WriteChroma(view, y);
}

void Renderer::CastRow(const StripView& view, int y_px) const {
    for (int x = 0; x < view.width_px; ++x) {
        const Vector3f direction = view.frame.R_world_camera * RayAt(x, y_px);
        view.strip.hits[view.Index(x, y_px)] =
            World::Cast(view.frame.around, view.Nearby(x), direction);
    }
}

void Renderer::ShadeRow(const StripView& view, int y_px) const {
    const auto surface = [&](int x, int y) {
        x = std::clamp(x, 0, lens_.width_px - 1);
        y = std::clamp(y, 0, lens_.height_px - 1);
        return view.strip.hits[view.Index(x, y)].surface();
    };
    for (int x = 0; x < view.width_px; ++x) {
        const Hit& hit = view.strip.hits[view.Index(x, y_px)];
        const std::int32_t own = hit.surface();
        const bool edge = surface(x - 1, y_px) != own || surface(x + 1, y_px) != own ||
                          surface(x, y_px - 1) != own || surface(x, y_px + 1) != own;
        view.strip.colours[view.Index(x, y_px)] =
            edge ? Supersampled(view, x, y_px)
                 : world_.ColourOf(view.frame.around, view.Nearby(x),
                                   view.frame.R_world_camera * RayAt(x, y_px), hit, pixel_rad_);
    }
}

Colour Renderer::Supersampled(const StripView& view, int x_px, int y_px) const {
    const int x_step = x_px + 1 < lens_.width_px ? 1 : -1;
    const int y_step = y_px + 1 < lens_.height_px ? 1 : -1;
    const Vector3f& ray = RayAt(x_px, y_px);
    const Vector3f right = 0.25F * (RayAt(x_px + x_step, y_px) - ray);
    const Vector3f down = 0.25F * (RayAt(x_px, y_px + y_step) - ray);
    Colour sum;
    for (const Vector3f& shift : {Vector3f(right + down), Vector3f(right - down),
                                  Vector3f(down - right), Vector3f(-right - down)}) {
        const Vector3f direction = view.frame.R_world_camera * (ray + shift).normalized();
        const Hit hit = World::Cast(view.frame.around, view.Nearby(x_px), direction);
        sum += world_.ColourOf(view.frame.around, view.Nearby(x_px), direction, hit, pixel_rad_);
    }
    return sum * 0.25F;
}

void Renderer::WriteLuma(const StripView& view, int y_px) const {
    const Exposure& exposure = view.frame.exposure;
    const std::uint32_t row_seed = Hash(exposure.noise_seed, static_cast<std::uint32_t>(y_px));
    std::uint8_t* out = view.frame.out.data() + y_px * view.width_px;
    for (int x = 0; x < view.width_px; ++x) {
        const float noise =
            exposure.noise_sigma * Noise(Hash(row_seed + static_cast<std::uint32_t>(x)));
        out[x] = Byte(view.strip.colours[view.Index(x, y_px)].y * exposure.gain + noise);
    }
}

void Renderer::WriteChroma(const StripView& view, int y_px) const {
    const std::ptrdiff_t luma = static_cast<std::ptrdiff_t>(lens_.height_px) * view.width_px;
    std::uint8_t* out = view.frame.out.data() + luma + y_px / 2 * view.width_px;
    const auto at = [&](int x, int y) { return view.strip.colours[view.Index(x, y)]; };
    for (int x = 0; x < view.width_px; x += 2) {
        const Colour mean =
            (at(x, y_px) + at(x + 1, y_px) + at(x, y_px + 1) + at(x + 1, y_px + 1)) *
            (0.25F * view.frame.exposure.gain);
        out[x] = Byte(mean.u + 128);
        out[x + 1] = Byte(mean.v + 128);
    }
}

}  // namespace hitchview::drivers

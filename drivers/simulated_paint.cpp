#include "drivers/simulated_paint.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/simulated_noise.hpp"

namespace hitchview::drivers {
namespace {

/// Position inside one cell of a regular pattern, and which cell it is.
struct Cell {
    float x, y;  // in [0, 1)
    std::uint32_t column, row;
};

Cell CellOf(float u, float v, int columns, int rows) {
    const float x = u * static_cast<float>(columns);
    const float y = v * static_cast<float>(rows);
    return {x - std::floor(x), y - std::floor(y), static_cast<std::uint32_t>(x),
            static_cast<std::uint32_t>(y)};
}

bool Inside(float x, float low, float high) {
    return x >= low && x < high;
}

float Noise(float u, float v, int cells, int octaves, std::uint32_t seed) {
    const auto scale = static_cast<float>(cells);
    return FractalNoise(u * scale, v * scale, cells, octaves, seed);
}

/// 0 on the border between random cells, growing inwards: a web of cracks.
float Crack(float u, float v, int cells, std::uint32_t seed) {
    return std::abs(Noise(u, v, cells, 4, seed) - 0.5F);
}

Colour Asphalt(float u, float v, std::uint32_t seed) {
    const float grain = Noise(u, v, 128, 2, seed);
    const float stain = Noise(u, v, 6, 4, seed + 7);
    const float crack = SmoothStep(0.0F, 0.012F, Crack(u, v, 4, seed + 9));
    const float stone = Noise(u, v, 90, 1, seed + 3) > 0.86F ? 34.0F : 0.0F;
    const float y = (52 + 64 * grain + 56 * (stain - 0.5F) + stone) * (0.55F + 0.45F * crack);
    return FromRgb(y, y * 1.01F, y * 1.04F);
}

Colour Grass(float u, float v, std::uint32_t seed) {
    const float blade = Noise(u, v, 110, 2, seed);
    const float tuft = Noise(u, v, 18, 3, seed + 5);
    const float dry = SmoothStep(0.5F, 0.8F, Noise(u, v, 7, 3, seed + 6));
    const float light = 0.35F + 0.6F * blade + 0.7F * (tuft - 0.4F);
    const Colour green = FromRgb(88, 132, 52) * light;
    const Colour straw = FromRgb(164, 150, 88) * light;
    const bool flower = Noise(u, v, 70, 1, seed + 8) > 0.93F;
    return flower ? FromRgb(232, 220, 130) : Mix(green, straw, dry * 0.7F);
}

Colour Gravel(float u, float v, std::uint32_t seed) {
    const float stones = Noise(u, v, 40, 3, seed);
    const float dust = Noise(u, v, 5, 3, seed + 2);
    const float y = 60 + 110 * stones + 50 * (dust - 0.5F);
    return FromRgb(y * 1.03F, y, y * 0.9F);
}

Colour Variation(float u, float v, std::uint32_t seed) {
    return {48 + 160 * Noise(u, v, 5, 5, seed), 0, 0};
}

struct Facade {
    Colour wall, frame;
    int columns, rows;
    float left, right, bottom, top;  // the window within its cell
    int bricks;                      // rows of bricks in the texture; 0: plain wall
};

Colour Wall(const Facade& f, float u, float v, std::uint32_t seed) {
    const float dirt = 0.8F + 0.4F * Noise(u, v, 8, 5, seed);
    if (f.bricks == 0) return f.wall * dirt;
    const float shift = static_cast<int>(v * static_cast<float>(f.bricks)) % 2 == 0 ? 0.0F : 0.5F;
    const float columns = static_cast<float>(f.bricks) / 3;
    const Cell brick = CellOf(u + shift / columns, v, static_cast<int>(columns), f.bricks);
    if (brick.x < 0.05F || brick.y < 0.14F) return FromRgb(176, 168, 158) * dirt;
    return f.wall * (dirt * (0.75F + 0.5F * Unit01(Hash(seed, brick.column, brick.row))));
}

/// What one sees in the pane: sky above, the house opposite below, a curtain at times.
Colour Pane(const Cell& cell, float x, float y, std::uint32_t seed) {
    const std::uint32_t dice = Hash(seed, cell.column, cell.row);
    const float slope = 0.35F + 0.3F * Unit01(dice);
    const bool curtain = Unit01(Hash(dice)) < 0.35F && std::abs(x - 0.5F) > 0.28F;
    if (curtain) return FromRgb(214, 206, 190);
    const Colour sky = FromRgb(150, 178, 204) * (0.6F + 0.4F * y);
    const Colour inside = FromRgb(38, 44, 52) * (0.7F + Unit01(Hash(dice, 3)));
    return y > slope + 0.25F * x ? sky : inside;
}

Colour PaintFacade(const Facade& f, float u, float v, std::uint32_t seed) {
    const Cell cell = CellOf(u, v, f.columns, f.rows);
    const float border = 0.035F;
    const bool framed = Inside(cell.x, f.left - border, f.right + border) &&
                        Inside(cell.y, f.bottom - 2 * border, f.top + border);
    if (!framed) return Wall(f, u, v, seed);
    const float x = (cell.x - f.left) / (f.right - f.left);
    const float y = (cell.y - f.bottom) / (f.top - f.bottom);
    const bool pane = Inside(x, 0, 1) && Inside(y, 0, 1) && std::abs(x - 0.5F) > 0.03F;
    return pane ? Pane(cell, x, y, seed) : f.frame;
}

Colour BrickHouse(float u, float v, std::uint32_t seed) {
    return PaintFacade(
        {FromRgb(150, 82, 62), FromRgb(226, 222, 212), 4, 4, 0.28F, 0.72F, 0.3F, 0.78F, 96}, u, v,
        seed);
}

Colour PlasterHouse(float u, float v, std::uint32_t seed) {
    return PaintFacade(
        {FromRgb(206, 190, 156), FromRgb(120, 84, 58), 4, 4, 0.33F, 0.67F, 0.25F, 0.8F, 0}, u, v,
        seed);
}

Colour Office(float u, float v, std::uint32_t seed) {
    return PaintFacade(
        {FromRgb(138, 142, 148), FromRgb(84, 88, 94), 6, 4, 0.08F, 0.92F, 0.25F, 0.9F, 0}, u, v,
        seed);
}

Colour Warehouse(float u, float v, std::uint32_t seed) {
    const float ribs = 0.85F + 0.15F * std::sin(u * 2 * std::numbers::pi_v<float> * 24);
    const float rust = SmoothStep(0.55F, 0.75F, Noise(u, v, 9, 5, seed));
    const Cell door = CellOf(u, v, 2, 1);
    const bool is_door = Inside(door.x, 0.3F, 0.7F) && door.y < 0.55F;
    const Colour base = is_door ? FromRgb(92, 112, 138) : FromRgb(176, 182, 180);
    const float panel = is_door && std::fmod(door.y * 8, 1.0F) < 0.12F ? 0.6F : 1.0F;
    return Mix(base, FromRgb(128, 84, 60), rust * 0.7F) * (is_door ? panel : ribs);
}

Colour Roof(float u, float v, std::uint32_t seed) {
    const Cell tile = CellOf(u, v, 24, 24);
    const float light = (tile.y < 0.15F ? 0.6F : 1.0F) * (0.7F + 0.5F * Noise(u, v, 24, 3, seed));
    return FromRgb(126, 74, 60) * light;
}

bool Wheel(float u, float v, float centre_u, float& radius) {
    radius = std::hypot((u - centre_u) * 3.4F, v - 0.16F) / 0.27F;
    return radius < 1;
}

Colour CarSide(float u, float v, std::uint32_t seed) {
    for (const float centre : {0.2F, 0.8F}) {
        float radius = 0;
        if (Wheel(u, v, centre, radius)) {
            return radius > 0.62F ? FromRgb(28, 28, 30) : FromRgb(170, 172, 176) * (1.2F - radius);
        }
    }
    if (v < 0.14F) return FromRgb(34, 34, 36);
    const bool seam = std::abs(u - 0.36F) < 0.006F || std::abs(u - 0.64F) < 0.006F;
    const bool handle =
        Inside(v, 0.7F, 0.75F) && (Inside(u, 0.4F, 0.44F) || Inside(u, 0.67F, 0.71F));
    if (seam || handle) return FromRgb(44, 44, 46);
    const float shine = 0.75F + 0.35F * v + 0.12F * (Noise(u, v, 16, 3, seed) - 0.5F);
    return FromRgb(235, 235, 235) * shine;
}

Colour CarEnd(float u, float v, std::uint32_t seed) {
    if (v < 0.2F) return FromRgb(34, 34, 36);
    const bool lamp = Inside(v, 0.5F, 0.72F) && (u < 0.18F || u > 0.82F);
    if (lamp) return FromRgb(236, 190, 150);
    const bool plate = Inside(u, 0.36F, 0.64F) && Inside(v, 0.34F, 0.46F);
    if (plate)
        return Noise(u, v, 48, 1, seed) > 0.6F ? FromRgb(30, 30, 34) : FromRgb(240, 240, 232);
    const bool grille = Inside(u, 0.25F, 0.75F) && Inside(v, 0.54F, 0.7F);
    if (grille) return FromRgb(60, 60, 64) * (std::fmod(v * 40, 1.0F) < 0.5F ? 0.5F : 1.2F);
    return FromRgb(228, 228, 228) * (0.75F + 0.3F * v);
}

Colour CarCabin(float u, float v, std::uint32_t seed) {
    const bool pillar =
        u < 0.05F || u > 0.95F || std::abs(u - 0.5F) < 0.03F || v > 0.86F || v < 0.1F;
    if (pillar) return FromRgb(220, 220, 220) * (0.8F + 0.2F * v);
    const float reflection = Noise(u, v, 6, 3, seed);
    return Mix(FromRgb(30, 36, 42), FromRgb(168, 190, 208),
               SmoothStep(0.45F, 0.6F, reflection) * 0.7F);
}

Colour Crate(float u, float v, std::uint32_t seed) {
    const Cell board = CellOf(u, v, 1, 7);
    const bool frame = u < 0.1F || u > 0.9F || v < 0.1F || v > 0.9F || std::abs(u - v) < 0.06F;
    const float grain = Noise(u, v * 6, 12, 4, seed + (frame ? 1 : 0));
    const float gap = !frame && board.y < 0.1F ? 0.35F : 1.0F;
    const float board_light = 0.8F + 0.3F * Unit01(Hash(seed, board.row));
    return FromRgb(196, 152, 100) * (gap * (frame ? 1.1F : board_light) * (0.6F + 0.6F * grain));
}

Colour Container(float u, float v, std::uint32_t seed) {
    const float ribs = 0.82F + 0.18F * std::sin(u * 2 * std::numbers::pi_v<float> * 20);
    const Cell letter = CellOf(u, v, 16, 8);
    const bool written =
        Inside(v, 0.5F, 0.75F) && Inside(u, 0.2F, 0.7F) && letter.x > 0.2F &&
        Hash(seed, static_cast<std::uint32_t>(u * 64), static_cast<std::uint32_t>(v * 40)) % 2 == 0;
    const float rust = SmoothStep(0.58F, 0.75F, Noise(u, v, 10, 4, seed));
    const Colour base = written ? FromRgb(250, 250, 245) : FromRgb(190, 190, 190);
    return Mix(base * ribs, FromRgb(120, 78, 54), rust * 0.6F);
}

Colour Barrier(float u, float v, std::uint32_t seed) {
    const float dirt = 0.75F + 0.4F * Noise(u, v, 12, 4, seed);
    const bool band = Inside(v, 0.45F, 0.85F);
    const bool red = std::fmod(u * 4 + v, 1.0F) < 0.5F;
    if (!band) return FromRgb(188, 184, 176) * dirt;
    return (red ? FromRgb(196, 48, 40) : FromRgb(238, 236, 230)) * dirt;
}

Colour Bark(float u, float v, std::uint32_t seed) {
    const float grooves = FractalNoise(u * 16, v * 6, 2, 1, seed) + Noise(u, v * 0.5F, 32, 3, seed);
    return FromRgb(112, 88, 66) * (0.35F + 0.5F * grooves);
}

Colour Leaves(float u, float v, std::uint32_t seed) {
    const float leaf = Noise(u, v, 40, 2, seed);
    const float bough = Noise(u, v, 8, 3, seed + 4);
    const float light = 0.4F + 0.85F * leaf + 1.1F * (bough - 0.45F);
    return Mix(FromRgb(62, 104, 40), FromRgb(150, 160, 70), leaf * bough) * std::max(light, 0.15F);
}

Colour Metal(float u, float v, std::uint32_t seed) {
    const float light = 0.75F + 0.3F * Noise(u, v, 10, 4, seed);
    const bool band = std::fmod(v * 4, 1.0F) < 0.12F;
    const bool poster = Inside(v, 0.28F, 0.42F) && Noise(u, v, 20, 2, seed + 1) > 0.5F;
    return (band || poster ? FromRgb(82, 84, 88) : FromRgb(176, 180, 184)) * light;
}

Colour Sign(float u, float v, std::uint32_t seed) {
    const float edge = std::min({u, 1 - u, v, 1 - v});
    if (edge < 0.03F) return FromRgb(30, 70, 150);
    if (edge < 0.06F) return FromRgb(245, 245, 245);
    const Cell letter = CellOf(u, v, 24, 10);
    const bool line = letter.row % 3 == 1 && letter.column > 2 && letter.column < 20;
    const bool ink =
        line && letter.x > 0.15F &&
        Hash(seed, static_cast<std::uint32_t>(u * 96), static_cast<std::uint32_t>(v * 40)) % 3 != 0;
    return ink ? FromRgb(245, 245, 245) : FromRgb(30, 84, 168);
}

using Painter = Colour (*)(float, float, std::uint32_t);

struct Recipe {
    Painter paint;
    int reduction;  // of the side of the texture
};

/// In the order of Paint.
constexpr std::array<Recipe, static_cast<std::size_t>(Paint::kCount)> kRecipes{{
    {Asphalt, 1},      {Grass, 1},    {Gravel, 2},    {Variation, 2}, {BrickHouse, 1},
    {PlasterHouse, 1}, {Office, 1},   {Warehouse, 1}, {Roof, 2},      {CarSide, 2},
    {CarEnd, 2},       {CarCabin, 4}, {Crate, 2},     {Container, 2}, {Barrier, 2},
    {Bark, 4},         {Leaves, 2},   {Metal, 4},     {Sign, 2},
}};

}  // namespace

Palette::Palette(std::uint32_t seed, int texels) {
    textures_.reserve(kRecipes.size());
    for (const Recipe& recipe : kRecipes) {
        const std::uint32_t own_seed = Hash(seed, static_cast<std::uint32_t>(textures_.size()));
        const int side = texels / recipe.reduction;
        textures_.emplace_back(side, side,
                               [&](float u, float v) { return recipe.paint(u, v, own_seed); });
    }
}

}  // namespace hitchview::drivers

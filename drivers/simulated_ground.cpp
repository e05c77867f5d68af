#include "drivers/simulated_ground.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/simulated_noise.hpp"

namespace hitchview::drivers {
namespace {

constexpr int kMaxTaps = 4;
constexpr float kAsphaltRepeat_m = 4.7F;
constexpr float kGrassRepeat_m = 6.3F;
constexpr float kGravelRepeat_m = 2.3F;
constexpr float kNearVariation_m = 31;
constexpr float kFarVariation_m = 290;
constexpr double kDash_m = 4;
constexpr double kDashPeriod_m = 9;
constexpr float kLineHalfWidth_m = 0.07F;
constexpr double kCrossing_m = 47;  // between pedestrian crossings
constexpr double kCrossingDepth_m = 3;
constexpr double kTrack_m = 1.5;  // between the wheels of one axle
constexpr double kTrackHalfWidth_m = 0.2;
constexpr double kRepair_m = 6.5;  // between repaired places

/// Share of the interval of width `extent` around `x` that lies within `low`..`high`.
float Cover(double x, double low, double high, float extent) {
    const double half = 0.5 * std::max(extent, 1e-3F);
    const double inside = std::min(high, x + half) - std::max(low, x - half);
    return static_cast<float>(std::clamp(inside / (2 * half), 0.0, 1.0));
}

/// Same for an interval that repeats every `period`.
float PeriodicCover(double x, double length, double period, float extent) {
    if (extent > period) return static_cast<float>(length / period);
    const double at = x - period * std::floor(x / period);
    return Cover(at, 0, length, extent) + Cover(at, period, period + length, extent) +
           Cover(at, -period, length - period, extent);
}

float Line(double across_m, double centre_m, float extent) {
    return Cover(across_m, centre_m - kLineHalfWidth_m, centre_m + kLineHalfWidth_m, extent);
}

float Wrapped(double x) {
    return static_cast<float>(x - std::floor(x));
}

}  // namespace

Ground::Ground(const Palette& palette, const Road& road, SceneOptions::Ground kind,
               std::uint32_t seed)
    : palette_(palette), road_(road), kind_(kind), seed_(seed) {}

Ground::OnRoad Ground::ToRoad(const Patch& patch) const {
    const RoadPoint at = road_.FromWorld(patch.p_world);
    const auto cosine = static_cast<float>(at.cos_heading);
    const auto sine = static_cast<float>(at.sin_heading);
    const float parallel = std::abs(patch.sight.x() * cosine + patch.sight.y() * sine);
    const float square = std::abs(patch.sight.y() * cosine - patch.sight.x() * sine);
    return {at, patch.along_m * parallel + patch.across_m * square,
            patch.along_m * square + patch.across_m * parallel};
}

/// Mean of up to four samples along the line of sight: far ground stays sharp across it.
Colour Ground::Sampled(Paint paint, double repeat_m, const Patch& patch) const {
    const float ratio = patch.along_m / patch.across_m;
    const int taps = ratio < 2 ? 1 : ratio < 6 ? 2 : kMaxTaps;
    const auto repeat = static_cast<float>(repeat_m);
    const float step_m = patch.along_m / static_cast<float>(taps);
    const float footprint = std::max(patch.across_m, step_m) / repeat;
    const float u = Wrapped(patch.p_world.x() / repeat_m);
    const float v = Wrapped(patch.p_world.y() / repeat_m);
    Colour sum;
    for (int i = 0; i < taps; ++i) {
        const float shift =
            (static_cast<float>(i) - 0.5F * static_cast<float>(taps - 1)) * step_m / repeat;
        sum += palette_[paint].Sample(u + patch.sight.x() * shift, v + patch.sight.y() * shift,
                                      footprint);
    }
    return sum * (1.0F / static_cast<float>(taps));
}

/// Around 1. It changes slowly: one sample will do.
float Ground::VariationAt(double repeat_m, const Patch& patch) const {
    const float footprint_m = std::max(patch.across_m, patch.along_m / 2);
    const Colour sample = palette_[Paint::kVariation].Sample(
        Wrapped(patch.p_world.x() / repeat_m), Wrapped(patch.p_world.y() / repeat_m),
        footprint_m / static_cast<float>(repeat_m));
    return sample.y / 128.0F;
}

float Ground::LineCover(const OnRoad& road) const {
    const double across = road.at.across_m;
    const float edges = Line(across, RoadProfile::kRightLine, road.across_m) +
                        Line(across, RoadProfile::kLeftLine, road.across_m);
    const float middle = Line(across, RoadProfile::kMiddleLine, road.across_m) *
                         PeriodicCover(road.at.along_m, kDash_m, kDashPeriod_m, road.along_m);
    const float crossing =
        PeriodicCover(road.at.along_m + kCrossing_m / 2, kCrossingDepth_m, kCrossing_m,
                      road.along_m) *
        PeriodicCover(across, 0.5, 1.0, road.across_m) *
        Cover(across, RoadProfile::kRightLine, RoadProfile::kLeftLine, road.across_m);
    return std::min(edges + middle + crossing, 1.0F);
}

/// Rectangles of newer asphalt.
float Ground::RepairCover(const OnRoad& road) const {
    const double cell = std::floor(road.at.along_m / kRepair_m);
    Dice dice(Hash(seed_, static_cast<std::uint32_t>(static_cast<std::int64_t>(cell))));
    const double left = dice.Between(-1.5, 4.5);
    const double width = dice.Between(0.5, 2.2);
    const double start = dice.Between(0.2, 2);
    const double length = dice.Between(0.8, 4);
    return Cover(road.at.across_m, left - width, left, road.across_m) *
           Cover(road.at.along_m - cell * kRepair_m, start, start + length, road.along_m);
}

Colour Ground::Pavement(const Patch& patch, const OnRoad& road) const {
    const Colour asphalt = Sampled(Paint::kAsphalt, kAsphaltRepeat_m, patch);
    const Colour repaired = asphalt * (1 - 0.32F * RepairCover(road));
    const float wear = 0.65F + 0.3F * asphalt.y / 128.0F;  // lines are worn where the stones show
    return Mix(repaired, FromRgb(232, 232, 226), std::min(LineCover(road) * wear, 1.0F));
}

Colour Ground::Meadow(const Patch& patch) const {
    const Colour grass = Sampled(Paint::kGrass, kGrassRepeat_m, patch);
    const float far = VariationAt(kFarVariation_m, patch);
    return Mix(grass, FromRgb(170, 156, 96) * (grass.y / 110.0F),
               SmoothStep(0.95F, 1.25F, far) * 0.7F);
}

Colour Ground::Plain(const Patch& patch) const {
    const float grain = Sampled(Paint::kAsphalt, kAsphaltRepeat_m, patch).y / 100.0F;
    const float light = 0.94F + 0.02F * grain + 0.04F * VariationAt(kFarVariation_m, patch);
    return FromRgb(122, 122, 119) * light;
}

/// Thin where wheels pass, thick beside the road.
Colour Ground::UnderSnow(const Colour& ground, const Patch& patch, const OnRoad& road) const {
    const float grain = Sampled(Paint::kGravel, kGravelRepeat_m, patch).y / 115.0F;
    const float drift = VariationAt(kNearVariation_m, patch);
    float tracks = 0;
    for (const double lane : {0.0, RoadProfile::kMiddleLine + RoadProfile::kMiddleLine}) {
        for (const double wheel : {-kTrack_m / 2, kTrack_m / 2}) {
            tracks += Cover(road.at.across_m, lane + wheel - kTrackHalfWidth_m,
                            lane + wheel + kTrackHalfWidth_m, road.across_m + 0.2F);
        }
    }
    const float worn = std::min(tracks * (0.5F + 0.4F * grain), 0.9F);
    const Colour snow = FromRgb(216, 221, 228) * (0.66F + 0.14F * grain + 0.2F * drift);
    return Mix(ground, snow, 0.97F * (1 - worn));
}

Colour Ground::ColourOf(const Patch& patch) const {
    if (kind_ == SceneOptions::Ground::kPlain) return Plain(patch);
    const OnRoad road = ToRoad(patch);
    const float variation = VariationAt(kNearVariation_m, patch);
    const double across = road.at.across_m;
    const float ragged = (variation - 1) * 0.9F;
    const float paved = Cover(across, RoadProfile::kRightLine - RoadProfile::kPavement,
                              RoadProfile::kLeftLine + RoadProfile::kPavement, road.across_m);
    const float cleared = Cover(across, RoadProfile::kRightEdge + ragged,
                                RoadProfile::kLeftEdge - ragged, road.across_m + 0.25F);
    Colour colour;
    if (paved > 0) colour += Pavement(patch, road) * paved;
    if (cleared > paved) {
        colour += Sampled(Paint::kGravel, kGravelRepeat_m, patch) * (cleared - paved);
    }
    const float rest = 1 - std::max(cleared, paved);
    if (rest > 0) colour += Meadow(patch) * rest;
    if (kind_ == SceneOptions::Ground::kSnow) return UnderSnow(colour, patch, road);
    return colour * (0.72F + 0.34F * variation);
}

}  // namespace hitchview::drivers

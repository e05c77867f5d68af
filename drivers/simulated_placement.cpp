#include "drivers/simulated_placement.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/simulated_ground.hpp"
#include "drivers/simulated_noise.hpp"
#include "drivers/simulated_structures.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kBefore_m = 260;  // the world goes on before and behind the route
constexpr int kLumps = 8;          // of the crown of a tree, the first in its middle
constexpr double kMargin_m = 0.8;  // between two things
constexpr double kDriven_m = 5;    // around the vehicle

/// Where a thing may stand: a free place, the heading of the road, and dice for its looks.
struct Site {
    Vector2d p_m;
    double heading_rad;
    Dice dice;
};

Colour RandomTint(Dice& dice) {
    static constexpr std::array kTints{
        FromRgb(196, 40, 36), FromRgb(38, 74, 150),  FromRgb(236, 236, 232), FromRgb(60, 64, 70),
        FromRgb(44, 110, 74), FromRgb(214, 150, 40), FromRgb(150, 160, 170), FromRgb(120, 60, 110)};
    const Colour c = kTints[static_cast<std::size_t>(dice.Choose(kTints.size()))];
    return {std::max(c.y, 80.0F) / 220.0F, c.u, c.v};
}

Coat Repeating(Paint paint, float repeat_m, Dice& dice) {
    return {.paint = paint,
            .repeat_u_m = repeat_m,
            .repeat_v_m = repeat_m,
            .offset_u = Unit01(dice.Next()),
            .offset_v = 0,
            .tint = {static_cast<float>(dice.Between(0.8, 1.15)), 0, 0}};
}

/// One picture over the whole face.
Coat Stretched(Paint paint, float width_m, float height_m, const Colour& tint) {
    return {paint, width_m, height_m, 0.5F, 0, tint};
}

/// Smooth paint with soft reflections.
Coat Polished(const Colour& tint) {
    return {Paint::kVariation, 7, 7, 0, 0, {1.5F * tint.y, 1.5F * tint.u, 1.5F * tint.v}};
}

/// Gathers the solids of the world.
class Builder {
 public:
    void Add(Shape shape, const Vector3d& centre_m, const Vector3f& half_m, double yaw_rad,
             const std::array<Coat, 3>& coats) {
        solids_.push_back({shape, centre_m, half_m, yaw_rad, coats});
    }

    /// Shadow of something `height_m` tall and `radius_m` wide whose lower end is `lift_m` high.
    void AddShadow(const Vector2d& p_m, double radius_m, double lift_m, double height_m) {
        const Eigen::Vector2d reach = -(kToSun.head<2>() / kToSun.z()).cast<double>();
        const Vector2d middle_m = p_m + reach * (lift_m + height_m / 2);
        const auto along_m = static_cast<float>(radius_m + reach.norm() * height_m / 2);
        solids_.push_back({Shape::kShadow,
                           {middle_m.x(), middle_m.y(), 0},
                           {along_m, static_cast<float>(radius_m), 0.01F},
                           std::atan2(reach.y(), reach.x()),
                           {}});
    }

    std::vector<Solid> Take() { return std::move(solids_); }

 private:
    std::vector<Solid> solids_;
};

Vector3d At(const Site& site, double z_m) {
    return {site.p_m.x(), site.p_m.y(), z_m};
}

void AddCar(Builder& builder, Site& site) {
    const auto length = static_cast<float>(site.dice.Between(3.8, 4.7));
    const auto width = static_cast<float>(site.dice.Between(1.65, 1.85));
    const auto body = static_cast<float>(site.dice.Between(0.85, 1.0));
    const auto cabin = static_cast<float>(site.dice.Between(0.5, 0.75));
    const double yaw = site.heading_rad + site.dice.Between(-0.04, 0.04);
    const Colour tint = RandomTint(site.dice);
    builder.AddShadow(site.p_m, width * 0.75, 0, body + cabin * 0.5);
    builder.Add(Shape::kBox, At(site, body / 2), {length / 2, width / 2, body / 2}, yaw,
                {Stretched(Paint::kCarEnd, width, body, tint),
                 Stretched(Paint::kCarSide, length, body, tint), Polished(tint)});
    const float roof = length * 0.52F;
    builder.Add(Shape::kBox, At(site, body + cabin / 2), {roof / 2, width * 0.46F, cabin / 2}, yaw,
                {Stretched(Paint::kCarCabin, width, cabin, tint),
                 Stretched(Paint::kCarCabin, roof, cabin, tint), Polished(tint)});
}

void AddBox(Builder& builder, Site& site, Paint paint, const Vector3f& size_m, const Colour& tint) {
    const double yaw = site.heading_rad + site.dice.Between(-0.15, 0.15);
    builder.AddShadow(site.p_m, size_m.head<2>().minCoeff() * 0.6, 0, size_m.z());
    builder.Add(Shape::kBox, At(site, size_m.z() / 2), size_m / 2, yaw,
                {Stretched(paint, size_m.y(), size_m.z(), tint),
                 Stretched(paint, size_m.x(), size_m.z(), tint),
                 Stretched(paint, size_m.x(), size_m.y(), tint)});
}

void AddCrates(Builder& builder, Site& site) {
    const auto side = static_cast<float>(site.dice.Between(0.9, 1.4));
    AddBox(builder, site, Paint::kCrate, {side, side, side}, {1, 0, 0});
    if (!site.dice.Says(0.5)) return;
    const float small = side * 0.7F;
    const Coat coat = Stretched(Paint::kCrate, small, small, {0.9F, 0, 0});
    builder.Add(Shape::kBox, At(site, side + small / 2), Vector3f::Constant(small / 2),
                site.heading_rad + site.dice.Between(0, 1.5), {coat, coat, coat});
}

void AddBarrier(Builder& builder, Site& site) {
    AddBox(builder, site, Paint::kBarrier, {3.2F, 0.45F, 0.95F}, {1, 0, 0});
}

void AddContainer(Builder& builder, Site& site) {
    AddBox(builder, site, Paint::kContainer, {6.1F, 2.4F, 2.6F}, RandomTint(site.dice));
}

void AddPole(Builder& builder, Site& site) {
    const auto height = static_cast<float>(site.dice.Between(4.5, 8.0));
    const auto radius = static_cast<float>(site.dice.Between(0.07, 0.13));
    const Coat coat = Repeating(Paint::kMetal, 2.2F, site.dice);
    builder.AddShadow(site.p_m, 0.12, 0, height);
    builder.Add(Shape::kCylinder, At(site, height / 2), {radius, radius, height / 2}, 0,
                {coat, coat, coat});
    if (!site.dice.Says(0.5)) return;
    const Coat sign = Stretched(Paint::kSign, 1.5F, 1.0F, {1, 0, 0});
    const Coat edge = Repeating(Paint::kMetal, 1, site.dice);
    builder.Add(Shape::kBox, At(site, 2.9), {0.14F, 0.75F, 0.5F}, site.heading_rad,
                {sign, edge, edge});
}

void AddTree(Builder& builder, Site& site) {
    const auto trunk = static_cast<float>(site.dice.Between(1.8, 3.4));
    const auto crown = static_cast<float>(site.dice.Between(1.3, 2.6));
    const Coat bark = Repeating(Paint::kBark, 1.4F, site.dice);
    builder.AddShadow(site.p_m, 0.2, 0, trunk);
    builder.AddShadow(site.p_m, crown, trunk * 0.8, crown);
    builder.Add(Shape::kCylinder, At(site, trunk / 2 + 0.4), {0.16F, 0.16F, trunk / 2 + 0.4F}, 0,
                {bark, bark, bark});
    Coat leaves = Repeating(Paint::kLeaves, 3.2F, site.dice);
    for (int i = 0; i < kLumps; ++i) {
        const double angle =
            site.heading_rad + 6.283 * (i + site.dice.Between(0, 0.5)) / (kLumps - 1);
        const double out = i == 0 ? 0 : crown * site.dice.Between(0.4, 0.65);
        const double size = crown * (i == 0 ? 0.8 : site.dice.Between(0.35, 0.6));
        const Vector3d lump{out * std::cos(angle), out * std::sin(angle),
                            trunk + crown * (i == 0 ? 0.75 : site.dice.Between(0.2, 1.35))};
        leaves.tint.y = static_cast<float>(site.dice.Between(0.75, 1.2));
        leaves.offset_u = Unit01(site.dice.Next());
        const auto half_m = static_cast<float>(size);
        builder.Add(Shape::kEllipsoid, At(site, 0) + lump, {half_m, half_m, half_m * 0.85F}, angle,
                    {leaves, leaves, leaves});
    }
}

void AddHouse(Builder& builder, Site& site) {
    static constexpr std::array kWalls{Paint::kBrickHouse, Paint::kPlasterHouse, Paint::kOffice,
                                       Paint::kWarehouse};
    const Paint paint = kWalls[static_cast<std::size_t>(site.dice.Choose(kWalls.size()))];
    const bool low = paint == Paint::kWarehouse;
    const auto length = static_cast<float>(site.dice.Between(10, 22));
    const auto width = static_cast<float>(site.dice.Between(8, 12));
    const float height = low ? 6.0F : 3.0F * static_cast<float>(2 + site.dice.Choose(4));
    const Coat wall = Repeating(paint, low ? 10.0F : 12.0F, site.dice);
    const Coat roof = Repeating(Paint::kRoof, 6, site.dice);
    builder.AddShadow(site.p_m, width * 0.5, 0, height);
    const double yaw = site.heading_rad + site.dice.Between(-0.2, 0.2);
    builder.Add(Shape::kBox, At(site, height / 2), {length / 2, width / 2, height / 2}, yaw,
                {wall, wall, roof});
    builder.Add(Shape::kBox, At(site, height + 0.2), {length / 2 + 0.3F, width / 2 + 0.3F, 0.2F},
                yaw, {roof, roof, roof});
}

void AddRoadside(Builder& builder, Site& site) {
    switch (site.dice.Choose(6)) {
        case 0:
            return AddBarrier(builder, site);
        case 1:
            return AddCrates(builder, site);
        case 2:
            return AddPole(builder, site);
        default:
            return AddCar(builder, site);
    }
}

void AddBackground(Builder& builder, Site& site) {
    return site.dice.Says(0.2) ? AddContainer(builder, site) : AddTree(builder, site);
}

/// Things of one kind, spread over a strip along the road.
struct Strip {
    double nearest_m, farthest_m;  // across, left positive
    double spacing_m, radius_m;
    void (*add)(Builder&, Site&);
};

constexpr std::array kStrips{
    Strip{-5.2, -4.7, 6.5, 2.6, AddRoadside}, Strip{8.2, 8.8, 7, 2.6, AddRoadside},
    Strip{-10, -7, 8, 0.5, AddPole},          Strip{10, 13, 9, 0.5, AddPole},
    Strip{-19, -10, 9, 3.2, AddBackground},   Strip{12, 21, 9, 3.2, AddBackground},
    Strip{-80, -22, 28, 12, AddHouse},        Strip{24, 84, 28, 12, AddHouse},
    Strip{-90, -20, 17, 3.0, AddTree},        Strip{22, 94, 17, 3.0, AddTree},
};

/// The circles of ground that are taken.
class Occupancy {
 public:
    bool Take(const Vector2d& p_m, double radius_m) {
        const bool is_free = std::none_of(taken_.begin(), taken_.end(), [&](const Circle& c) {
            const double apart_m = c.radius_m + radius_m + kMargin_m;
            return (c.p_m - p_m).squaredNorm() < apart_m * apart_m;
        });
        if (is_free) Block(p_m, radius_m);
        return is_free;
    }
    void Block(const Vector2d& p_m, double radius_m) { taken_.push_back({p_m, radius_m}); }

 private:
    struct Circle {
        Vector2d p_m;
        double radius_m;
    };
    std::vector<Circle> taken_;
};

bool ClearOfTunnel(const SceneOptions& scene, const Vector2d& p_m, double radius_m) {
    return !scene.tunnel || p_m.x() < scene.tunnel->from_m - radius_m ||
           p_m.x() > scene.tunnel->to_m + radius_m;
}

bool ClearOfRoad(const Road& road, const Vector2d& p_m, const Strip& strip) {
    const double across_m = road.FromWorld(p_m).across_m;
    const double keep_m = std::min(strip.radius_m, 1.2);
    return across_m < RoadProfile::kRightEdge - keep_m ||
           across_m > RoadProfile::kLeftEdge + keep_m;
}

class Town {
 public:
    Town(const Road& road, const Stage& stage, std::uint32_t seed)
        : road_(road),
          scene_(stage.scene),
          dice_(seed),
          first_m_(-kBefore_m),
          last_m_(stage.route_m + kBefore_m) {
        for (const Vector2d& p_m : stage.driven) occupancy_.Block(p_m, kDriven_m);
        if (const auto round_m = road.Circumference()) {
            first_m_ = 0;
            last_m_ = *round_m;
        }
    }

    void Fill(const Strip& strip) {
        const double width_m = strip.farthest_m - strip.nearest_m;
        const int rows = std::max(1, static_cast<int>(width_m / strip.spacing_m));
        for (int row = 0; row < rows; ++row) {
            FillRow(strip, strip.nearest_m + width_m * row / rows, width_m / rows);
        }
    }

    std::vector<Solid> Take() {
        std::vector<Solid> solids = builder_.Take();
        if (scene_.ground == SceneOptions::Ground::kSnow) CoverWithSnow(solids);
        if (scene_.tunnel) AppendTunnel(*scene_.tunnel, solids);
        if (scene_.night) AppendStreetLamps(road_, first_m_, last_m_, solids);
        return solids;
    }

 private:
    void FillRow(const Strip& strip, double across_m, double width_m) {
        const double stretch = road_.Stretch(across_m + width_m / 2);
        if (stretch < 0.1) return;
        const double step_m = strip.spacing_m / stretch;
        for (double along_m = first_m_; along_m < last_m_; along_m += step_m) {
            const Vector2d p_m = road_.ToWorld(along_m + dice_.Between(0, 0.7) * step_m,
                                               across_m + dice_.Between(0, 1) * width_m);
            if (ClearOfRoad(road_, p_m, strip) && ClearOfTunnel(scene_, p_m, strip.radius_m) &&
                occupancy_.Take(p_m, strip.radius_m)) {
                Build(strip, p_m);
            }
        }
    }

    void Build(const Strip& strip, const Vector2d& p_m) {
        const RoadPoint road = road_.FromWorld(p_m);
        Site site{p_m, std::atan2(road.sin_heading, road.cos_heading), Dice(dice_.Next())};
        if (scene_.density < 1 && !Dice(site.dice).Says(scene_.density)) return;
        strip.add(builder_, site);
    }

    const Road& road_;
    const SceneOptions& scene_;
    Dice dice_;
    double first_m_, last_m_;
    Occupancy occupancy_;
    Builder builder_;
};

}  // namespace

std::vector<Solid> PlaceSolids(const Road& road, const Stage& stage, std::uint32_t seed) {
    Town town(road, stage, seed);
    for (const Strip& strip : kStrips) town.Fill(strip);
    return town.Take();
}

}  // namespace hitchview::drivers

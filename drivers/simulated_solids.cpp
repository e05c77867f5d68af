#include "drivers/simulated_solids.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::drivers {
namespace {

using Eigen::Vector3f;

constexpr int kTop = 5;
constexpr int kRound = 6;
constexpr float kAmbient = 0.5F;
constexpr float kSunlight = 0.62F;
constexpr float kShadowDepth = 0.5F;
constexpr float kMaxStretch = 4;  // of a pixel's footprint on a face seen at a flat angle

Entry IntersectBox(const VisibleSolid& s, const Vector3f& d) {
    const Vector3f inverse = d.cwiseInverse();
    const Vector3f a = (-s.half_m - s.eye_m).cwiseProduct(inverse);
    const Vector3f b = (s.half_m - s.eye_m).cwiseProduct(inverse);
    const Vector3f in = a.cwiseMin(b);
    int axis = in.x() > in.y() ? 0 : 1;
    if (in.z() > in[axis]) axis = 2;
    const float enter = in[axis];
    if (!(enter > 0 && enter <= a.cwiseMax(b).minCoeff())) return {};
    return {enter, 2 * axis + (d[axis] < 0 ? 1 : 0)};
}

/// Nearer root of a t^2 + 2 b t + c = 0; infinite without one in front of the eye.
float NearRoot(float a, float b, float c) {
    const float discriminant = b * b - a * c;
    if (!(discriminant > 0)) return kNoHit;
    const float root = (-b - std::sqrt(discriminant)) / a;
    return root > 0 ? root : kNoHit;
}

Entry IntersectCylinder(const VisibleSolid& s, const Vector3f& d) {
    const auto o = s.eye_m.head<2>();
    const auto across = d.head<2>();
    const float radius = s.half_m.x();
    const float side =
        NearRoot(across.squaredNorm(), o.dot(across), o.squaredNorm() - radius * radius);
    if (side < kNoHit && std::abs(s.eye_m.z() + side * d.z()) <= s.half_m.z())
        return {side, kRound};
    const float top = (s.half_m.z() - s.eye_m.z()) / d.z();
    if (d.z() < 0 && top > 0 && (o + top * across).squaredNorm() <= radius * radius) {
        return {top, kTop};
    }
    return {};
}

Entry IntersectEllipsoid(const VisibleSolid& s, const Vector3f& d) {
    const Vector3f o = s.eye_m.cwiseQuotient(s.half_m);
    const Vector3f scaled = d.cwiseQuotient(s.half_m);
    return {NearRoot(scaled.squaredNorm(), o.dot(scaled), o.squaredNorm() - 1), kRound};
}

Vector3f LocalNormal(const VisibleSolid& s, const Vector3f& p, int face) {
    if (face < kRound) {
        Vector3f normal = Vector3f::Zero();
        normal[face / 2] = face % 2 == 0 ? -1.0F : 1.0F;
        return normal;
    }
    if (s.shape == Shape::kCylinder) return Vector3f{p.x(), p.y(), 0} / s.half_m.x();
    return p.cwiseQuotient(s.half_m.cwiseProduct(s.half_m)).normalized();
}

/// Metres along the face, from its middle and from its lower edge.
Eigen::Vector2f OnFace(const VisibleSolid& s, const Vector3f& p, int face) {
    switch (face / 2) {
        case 0:
            return {p.y(), p.z() + s.half_m.z()};
        case 1:
            return {p.x(), p.z() + s.half_m.z()};
        case 2:
            return {p.x(), p.y()};
        default:
            return {s.half_m.x() * std::atan2(p.y(), p.x()), p.z() + s.half_m.z()};
    }
}

const Coat& CoatOf(const Solid& solid, int face) {
    if (face == kTop) return solid.coats[2];
    return solid.coats[face == 2 || face == 3 ? 1 : 0];
}

Colour Tinted(const Colour& c, const Colour& tint) {
    const float light = c.y / 255.0F;
    return {c.y * tint.y, c.u * tint.y + light * tint.u, c.v * tint.y + light * tint.v};
}

}  // namespace

VisibleSolid::VisibleSolid(const Solid& solid, std::uint32_t solid_index,
                           const Eigen::Vector3d& eye_world)
    : index(solid_index),
      shape(solid.shape),
      cos_yaw(static_cast<float>(std::cos(solid.yaw_rad))),
      sin_yaw(static_cast<float>(std::sin(solid.yaw_rad))),
      centre_m((solid.centre_m - eye_world).cast<float>()),
      half_m(solid.half_m),
      eye_m(ToLocal(-centre_m)),
      nearest_m((eye_m.cwiseAbs() - half_m).cwiseMax(0).norm()) {}

Entry Intersect(const VisibleSolid& solid, const Vector3f& direction) {
    const Vector3f local = solid.ToLocal(direction);
    switch (solid.shape) {
        case Shape::kBox:
            return IntersectBox(solid, local);
        case Shape::kCylinder:
            return IntersectCylinder(solid, local);
        case Shape::kEllipsoid:
            return IntersectEllipsoid(solid, local);
        case Shape::kShadow:
            break;
    }
    return {};
}

Colour ShadeSolid(const Palette& palette, const Solid& solid, const VisibleSolid& visible,
                  const Vector3f& direction, const Entry& entry, float pixel_rad) {
    const Vector3f local = visible.ToLocal(direction);
    const Vector3f p = visible.eye_m + entry.distance_m * local;
    const Vector3f normal = LocalNormal(visible, p, entry.face);
    const Eigen::Vector2f on_face = OnFace(visible, p, entry.face);
    const Coat& coat = CoatOf(solid, entry.face);

    const float flatness = std::max(-normal.dot(local), 1 / kMaxStretch);
    const float footprint_m = entry.distance_m * pixel_rad / flatness;
    const Colour paint =
        palette[coat.paint].Sample(on_face.x() / coat.repeat_u_m + coat.offset_u,
                                   on_face.y() / coat.repeat_v_m + coat.offset_v,
                                   footprint_m / std::min(coat.repeat_u_m, coat.repeat_v_m));
    const float sun = std::max(visible.ToWorld(normal).dot(kToSun), 0.0F);
    return Tinted(paint, coat.tint) * (kAmbient + kSunlight * sun);
}

float ShadowAt(const VisibleSolid& shadow, const Vector3f& p_m) {
    const Vector3f local = shadow.ToLocal(p_m - shadow.centre_m).cwiseAbs();
    const float softness = std::min(0.35F * std::min(shadow.half_m.x(), shadow.half_m.y()), 1.5F);
    const Eigen::Vector2f outside =
        (local.head<2>() - shadow.half_m.head<2>()).array() + 2 * softness;
    const float distance = outside.cwiseMax(0).norm() - 2 * softness;
    return kShadowDepth * std::clamp(-distance / softness, 0.0F, 1.0F);
}

}  // namespace hitchview::drivers

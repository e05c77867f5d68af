#include "drivers/simulated_road.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/simulated_motion.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Vector2d;

constexpr int kCourses = 1024;     // of one wave
constexpr int kFineSteps = 16384;  // of one wave, to integrate it

/// Largest multiple of `step` that is not above x, in steps.
double Wraps(double x, double step) {
    return std::floor(x / step);
}

}  // namespace

Road::Road(const SimulationOptions& o) {
    switch (o.profile) {
        case DriveProfile::kStraight:
            return;
        case DriveProfile::kSlalom:
            LayWaves(o, o.speed_mps * o.slalom_period_s);
            return;
        case DriveProfile::kTurnLeft:
            side_ = 1;
            break;
        case DriveProfile::kTurnRight:
            side_ = -1;
            break;
    }
    radius_m_ = 1 / o.curvature_per_m;
}

void Road::LayWaves(const SimulationOptions& o, double length_m) {
    if (length_m <= 0) return;
    wave_along_m_ = length_m;
    const double step_m = length_m / kFineSteps;
    std::vector<Vector2d> fine{Vector2d::Zero()};
    for (int i = 0; i < kFineSteps; ++i) {
        const double heading = HeadingAt(o, (i + 0.5) * step_m);
        fine.emplace_back(fine.back() + step_m * Vector2d{std::cos(heading), std::sin(heading)});
    }
    wave_x_m_ = fine.back().x();
    std::size_t j = 0;
    for (int i = 0; i <= kCourses; ++i) {
        const double x_m = wave_x_m_ * i / kCourses;
        while (j + 2 < fine.size() && fine[j + 1].x() < x_m) ++j;
        const double part = (x_m - fine[j].x()) / (fine[j + 1].x() - fine[j].x());
        const double along_m = (static_cast<double>(j) + part) * step_m;
        const double heading = HeadingAt(o, along_m);
        courses_.push_back({along_m, fine[j].y() + part * (fine[j + 1].y() - fine[j].y()),
                            std::cos(heading), std::sin(heading)});
    }
}

Road::Course Road::CourseAt(double x_m) const {
    const double wraps = Wraps(x_m, wave_x_m_);
    const double at = (x_m / wave_x_m_ - wraps) * kCourses;
    const auto i = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(i);
    const Course& a = courses_[i];
    const Course& b = courses_[std::min<std::size_t>(i + 1, kCourses)];
    const auto between = [&](double Course::*m) { return a.*m + part * (b.*m - a.*m); };
    return {between(&Course::along_m) + wraps * wave_along_m_, between(&Course::y_m),
            between(&Course::cos_heading), between(&Course::sin_heading)};
}

RoadPoint Road::FromCircle(const Vector2d& p_world) const {
    const double toward_start = radius_m_ - side_ * p_world.y();
    const double distance = std::hypot(p_world.x(), toward_start);
    if (distance <= 0) return {.along_m = 0, .across_m = side_ * radius_m_};
    return {.along_m = radius_m_ * std::atan2(p_world.x(), toward_start),
            .across_m = side_ * (radius_m_ - distance),
            .cos_heading = toward_start / distance,
            .sin_heading = side_ * p_world.x() / distance};
}

RoadPoint Road::FromWorld(const Vector2d& p_world) const {
    if (side_ != 0) return FromCircle(p_world);
    if (wave_x_m_ <= 0) return {.along_m = p_world.x(), .across_m = p_world.y()};
    const Course course = CourseAt(p_world.x());
    const double beside = p_world.y() - course.y_m;
    return {.along_m = course.along_m + beside * course.sin_heading,
            .across_m = beside * course.cos_heading,
            .cos_heading = course.cos_heading,
            .sin_heading = course.sin_heading};
}

double Road::XAt(double along_m) const {
    const double wraps = Wraps(along_m, wave_along_m_);
    const double within = along_m - wraps * wave_along_m_;
    const auto after =
        std::upper_bound(courses_.begin(), courses_.end() - 1, within,
                         [](double value, const Course& c) { return value < c.along_m; });
    const auto i = static_cast<double>(after - courses_.begin()) - 1;
    const Course& a = *(after - 1);
    const double part = (within - a.along_m) / (after->along_m - a.along_m);
    return wave_x_m_ * (wraps + (i + part) / kCourses);
}

Vector2d Road::ToWorld(double along_m, double across_m) const {
    if (side_ != 0) {
        const double angle = along_m / radius_m_;
        const double distance = radius_m_ - side_ * across_m;
        return {distance * std::sin(angle), side_ * (radius_m_ - distance * std::cos(angle))};
    }
    if (wave_x_m_ <= 0) return {along_m, across_m};
    const double x_m = XAt(along_m);
    const Course course = CourseAt(x_m);
    return {x_m - across_m * course.sin_heading, course.y_m + across_m * course.cos_heading};
}

double Road::Stretch(double across_m) const {
    return side_ == 0 ? 1 : 1 - side_ * across_m / radius_m_;
}

std::optional<double> Road::Circumference() const {
    if (side_ == 0) return std::nullopt;
    return 2 * std::numbers::pi * radius_m_;
}

}  // namespace hitchview::drivers

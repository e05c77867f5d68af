#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "drivers/simulated_options.hpp"

namespace hitchview::drivers {

/// A place of the ground in coordinates of the road: `along` the driven lane, `across` it to the
/// left, and the heading of the road there.
struct RoadPoint {
    double along_m = 0, across_m = 0;
    double cos_heading = 1, sin_heading = 0;
};

/// The course of the road that the tractor follows: a line, a circle, or waves. Thread-safe.
class Road {
 public:
    explicit Road(const SimulationOptions& options);

    [[nodiscard]] RoadPoint FromWorld(const Eigen::Vector2d& p_world) const;
    /// Inverse of FromWorld near the road.
    [[nodiscard]] Eigen::Vector2d ToWorld(double along_m, double across_m) const;
    /// Metres on the ground per metre of `along`, `across_m` beside the driven lane; <= 0 past the
    /// centre of a circle.
    [[nodiscard]] double Stretch(double across_m) const;
    /// Length after which the road meets itself; empty for a road that never does.
    [[nodiscard]] std::optional<double> Circumference() const;

 private:
    struct Course {  // of the waves, at regular x
        double along_m, y_m, cos_heading, sin_heading;
    };
    void LayWaves(const SimulationOptions& options, double length_m);
    [[nodiscard]] Course CourseAt(double x_m) const;
    [[nodiscard]] RoadPoint FromCircle(const Eigen::Vector2d& p_world) const;
    [[nodiscard]] double XAt(double along_m) const;

    double side_ = 0;      // of the centre of a circle: +1 left, -1 right, 0 no circle
    double radius_m_ = 0;  // of a circle
    double wave_x_m_ = 0;  // one wave, measured along x; 0: straight
    double wave_along_m_ = 0;
    std::vector<Course> courses_;
};

}  // namespace hitchview::drivers

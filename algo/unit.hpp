#pragma once

#include <array>

namespace hitchview::algo {

/// A rigid body that carries cameras. In equations tractor is A and trailer is B.
enum class Unit { kTractor = 0, kTrailer = 1 };

inline constexpr std::array kUnits{Unit::kTractor, Unit::kTrailer};

constexpr const char* ToString(Unit unit) {
    return unit == Unit::kTractor ? "tractor" : "trailer";
}
constexpr Unit Other(Unit unit) {
    return unit == Unit::kTractor ? Unit::kTrailer : Unit::kTractor;
}

/// One T for each unit.
template <typename T>
struct PerUnit {
    std::array<T, 2> of{};

    T& operator[](Unit unit) { return of[static_cast<std::size_t>(unit)]; }
    const T& operator[](Unit unit) const { return of[static_cast<std::size_t>(unit)]; }
};

/// Where the two views see the same scene. A ring has both; a plane rig has kRight only.
enum class Overlap { kLeft = 0, kRight = 1 };

inline constexpr std::array kOverlaps{Overlap::kLeft, Overlap::kRight};

constexpr const char* ToString(Overlap overlap) {
    return overlap == Overlap::kLeft ? "left" : "right";
}

template <typename T>
struct PerOverlap {
    std::array<T, 2> of{};

    T& operator[](Overlap overlap) { return of[static_cast<std::size_t>(overlap)]; }
    const T& operator[](Overlap overlap) const { return of[static_cast<std::size_t>(overlap)]; }
};

}  // namespace hitchview::algo

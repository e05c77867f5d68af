#include "drivers/simulated_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/simulated_noise.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInk = 28;
constexpr double kPaper = 215;
constexpr int kTexels = 1600;  // along the longer side

double Share(double low, double high, int texel) {
    return std::max(0.0, std::min(high, texel + 1.0) - std::max<double>(low, texel));
}

std::uint8_t Mixed(std::uint8_t behind, double before, double share) {
    return static_cast<std::uint8_t>(
        std::clamp(std::lround((1 - share) * behind + share * before), 0L, 255L));
}

}  // namespace

HeldSheet::HeldSheet(const SheetOptions& options, const algo::CameraModel& lens, std::uint32_t seed)
    : options_(options), lens_(lens), seed_(seed) {
    const Vector2d size_m = options.paper.to_m - options.paper.from_m;
    texels_per_m_ = kTexels / size_m.maxCoeff();
    texel_columns_ = static_cast<int>(std::ceil(texels_per_m_ * size_m.x())) + 1;
    texel_rows_ = static_cast<int>(std::ceil(texels_per_m_ * size_m.y())) + 1;
    white_.assign(static_cast<std::size_t>(texel_columns_ * texel_rows_), 1.0F);
    for (const SheetOptions::Rectangle& dark : options.dark) Print(dark);
    for (int y = 0; y <= lens.height_px; ++y) {
        for (int x = 0; x <= lens.width_px; ++x)
            rays_.push_back(lens.Unproject({x - 0.5, y - 0.5}).value_or(Vector3d::Zero()));
    }
}

void HeldSheet::Print(const SheetOptions::Rectangle& dark) {
    const Vector2d from = texels_per_m_ * (dark.from_m - options_.paper.from_m);
    const Vector2d to = texels_per_m_ * (dark.to_m - options_.paper.from_m);
    for (int y = static_cast<int>(from.y()); y < std::min<double>(to.y(), texel_rows_); ++y) {
        for (int x = static_cast<int>(from.x()); x < std::min<double>(to.x(), texel_columns_); ++x)
            white_[static_cast<std::size_t>(y * texel_columns_ + x)] -=
                static_cast<float>(Share(from.y(), to.y(), y) * Share(from.x(), to.x(), x));
    }
}

Isometry3d HeldSheet::PoseAt(int camera_index, int frame) const {
    Dice dice(Hash(seed_, static_cast<std::uint32_t>(camera_index),
                   static_cast<std::uint32_t>(frame / kHeldFrames)));
    const Vector2d at(lens_.width_px * dice.Between(0.04, 0.96),
                      lens_.height_px * dice.Between(0.04, 0.96));
    const Vector3d direction = lens_.Unproject(at).value_or(Vector3d::UnitZ());
    const Vector2d size_m = options_.paper.to_m - options_.paper.from_m;
    const Vector2d middle_m = (options_.paper.from_m + options_.paper.to_m) / 2;
    const double axis_rad = dice.Between(0, 6.28);
    const Vector3d axis(std::cos(axis_rad), std::sin(axis_rad), 0);
    Isometry3d T = Isometry3d::Identity();
    T.linear() = (Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), direction) *
                  Eigen::AngleAxisd(dice.Between(-0.75, 0.75), axis) *
                  Eigen::AngleAxisd(dice.Between(-0.3, 0.3), Vector3d::UnitZ()))
                     .toRotationMatrix();
    T.translation() = dice.Between(0.5, 1.5) * size_m.maxCoeff() * direction -
                      T.linear() * Vector3d(middle_m.x(), middle_m.y(), 0);
    return T;
}

/// Between texels, bilinear. Empty beside the sheet.
std::optional<double> HeldSheet::WhiteAt(const Vector2d& at_m) const {
    if ((at_m.array() < options_.paper.from_m.array()).any() ||
        (at_m.array() > options_.paper.to_m.array()).any())
        return std::nullopt;
    const Vector2d at = texels_per_m_ * (at_m - options_.paper.from_m) - Vector2d(0.5, 0.5);
    const int x = std::clamp(static_cast<int>(at.x()), 0, texel_columns_ - 2);
    const int y = std::clamp(static_cast<int>(at.y()), 0, texel_rows_ - 2);
    const double u = std::clamp(at.x() - x, 0.0, 1.0);
    const double v = std::clamp(at.y() - y, 0.0, 1.0);
    const float* upper = white_.data() + y * texel_columns_ + x;
    const float* lower = upper + texel_columns_;
    return (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
}

HeldSheet::Pixel HeldSheet::Look(const Isometry3d& T_camera_sheet, int x_px, int y_px) const {
    constexpr int kRays = 3;  // along a pixel's side
    const Vector3d* upper = rays_.data() + y_px * (lens_.width_px + 1) + x_px;
    const Vector3d* lower = upper + lens_.width_px + 1;
    const Vector3d normal = T_camera_sheet.linear().col(2);
    const double distance = normal.dot(T_camera_sheet.translation());
    Pixel seen;
    for (int i = 0; i < kRays * kRays; ++i) {
        const double u = (i % kRays + 0.5) / kRays;
        const double v = (i / kRays + 0.5) / kRays;
        const Vector3d ray =
            (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
        const double slope = normal.dot(ray);
        if (slope <= 0) continue;
        const Vector3d at = T_camera_sheet.linear().transpose() *
                            (distance / slope * ray - T_camera_sheet.translation());
        const auto white = WhiteAt(at.head<2>());
        if (!white) continue;
        seen.share += 1;
        seen.white += *white;
    }
    if (seen.share > 0) seen.white /= seen.share;
    seen.share /= kRays * kRays;
    return seen;
}

void HeldSheet::DrawOver(int camera_index, int frame, double gain,
                         std::span<std::uint8_t> nv12) const {
    constexpr double kNoColour = 128;
    const Isometry3d T_camera_sheet = PoseAt(camera_index, frame);
    const int width = lens_.width_px;
    std::uint8_t* const chroma = nv12.data() + width * lens_.height_px;
    for (int y = 0; y < lens_.height_px; ++y) {
        for (int x = 0; x < width; ++x) {
            const Pixel seen = Look(T_camera_sheet, x, y);
            if (seen.share == 0) continue;
            std::uint8_t& luma = nv12[static_cast<std::size_t>(y * width + x)];
            luma = Mixed(luma, gain * (kInk + (kPaper - kInk) * seen.white), seen.share);
            std::uint8_t& colour = chroma[y / 2 * width + x];
            colour = Mixed(colour, kNoColour, seen.share);
        }
    }
}

}  // namespace hitchview::drivers

#include "app/picture_fault.hpp"

#include <algorithm>
#include <array>

namespace hitchview::app {
namespace {

/// In shares of width and height.
struct Smear {
    float x, y, radius_x, radius_y;
};
constexpr std::array kSmears{Smear{0.22F, 0.55F, 0.21F, 0.30F}, Smear{0.66F, 0.48F, 0.20F, 0.24F},
                             Smear{0.50F, 0.88F, 0.30F, 0.16F}};

/// 1 within, 0 outside, in between at the rim.
float SmearedShare(float x, float y) {
    float share = 0;
    for (const Smear& smear : kSmears) {
        const float dx = (x - smear.x) / smear.radius_x;
        const float dy = (y - smear.y) / smear.radius_y;
        constexpr float kRim = 0.2F;
        share = std::max(share, std::clamp((1 - dx * dx - dy * dy) / kRim, 0.0F, 1.0F));
    }
    return share;
}

std::uint8_t Grey(float value) {
    return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

int SideFor(int cols) {
    return std::max(2, cols / 40);
}

}  // namespace

PictureFault::PictureFault(int cols, int rows)
    : side_(SideFor(cols)),
      grid_cols_((cols + side_ - 1) / side_),
      grid_rows_((rows + side_ - 1) / side_),
      grid_(static_cast<std::size_t>(grid_cols_ * grid_rows_)) {}

void PictureFault::Blacken(const WritableLuma& luma) {
    for (int y = 0; y < luma.rows; ++y)
        for (int x = 0; x < luma.cols; ++x)
            luma.at(x, y) = static_cast<std::uint8_t>(2 + Noise());
}

void PictureFault::Blind(const WritableLuma& luma) {
    for (int y = 0; y < luma.rows; ++y)
        for (int x = 0; x < luma.cols; ++x)
            luma.at(x, y) = Grey(242.0F + static_cast<float>(luma.at(x, y)) / 4);
}

void PictureFault::Blur(const WritableLuma& luma) {
    Reduce(luma);
    for (int y = 0; y < luma.rows; ++y)
        for (int x = 0; x < luma.cols; ++x)
            luma.at(x, y) = Grey(Blurred(x, y) + static_cast<float>(Noise()));
}

void PictureFault::Smear(const WritableLuma& luma) {
    Reduce(luma);
    for (int y = 0; y < luma.rows; ++y) {
        for (int x = 0; x < luma.cols; ++x) {
            const float share = SmearedShare(static_cast<float>(x) / static_cast<float>(luma.cols),
                                             static_cast<float>(y) / static_cast<float>(luma.rows));
            if (share == 0) continue;
            const float smeared = 0.6F * Blurred(x, y) + 30 + static_cast<float>(Noise());
            const auto clear = static_cast<float>(luma.at(x, y));
            luma.at(x, y) = Grey(clear + share * (smeared - clear));
        }
    }
}

void PictureFault::Reduce(const WritableLuma& luma) {
    for (int row = 0; row < grid_rows_; ++row) {
        for (int col = 0; col < grid_cols_; ++col) {
            const int x_end = std::min((col + 1) * side_, luma.cols);
            const int y_end = std::min((row + 1) * side_, luma.rows);
            int sum = 0;
            for (int y = row * side_; y < y_end; ++y)
                for (int x = col * side_; x < x_end; ++x) sum += luma.at(x, y);
            const int count = (x_end - col * side_) * (y_end - row * side_);
            grid_[static_cast<std::size_t>(row * grid_cols_ + col)] =
                static_cast<float>(sum) / static_cast<float>(count);
        }
    }
}

/// Between the middles of the squares.
float PictureFault::Blurred(int x, int y) const {
    const auto along = [this](int pixel, int count) {
        const float at = (static_cast<float>(pixel) + 0.5F) / static_cast<float>(side_) - 0.5F;
        return std::clamp(at, 0.0F, static_cast<float>(count - 1));
    };
    const float at_x = along(x, grid_cols_);
    const float at_y = along(y, grid_rows_);
    const int col = std::min(static_cast<int>(at_x), grid_cols_ - 2);
    const int row = std::min(static_cast<int>(at_y), grid_rows_ - 2);
    const float dx = at_x - static_cast<float>(col);
    const float dy = at_y - static_cast<float>(row);
    const float* const upper = &grid_[static_cast<std::size_t>(row * grid_cols_ + col)];
    const float* const lower = upper + grid_cols_;
    return (1 - dy) * ((1 - dx) * upper[0] + dx * upper[1]) +
           dy * ((1 - dx) * lower[0] + dx * lower[1]);
}

int PictureFault::Noise() {
    random_ ^= random_ << 13;
    random_ ^= random_ >> 17;
    random_ ^= random_ << 5;
    return static_cast<int>(random_ & 1U) - static_cast<int>(random_ >> 1 & 1U);
}

}  // namespace hitchview::app

#include "app/evaluation_report_axis.hpp"

#include <algorithm>
#include <cmath>

#include "app/html_report.hpp"

namespace hitchview::app {
namespace {

double RoundStep(double length) {
    constexpr double kMostTicks = 6;
    const double smallest = length / kMostTicks;
    const double power = std::pow(10, std::floor(std::log10(smallest)));
    for (const double digit : {1.0, 2.0, 5.0}) {
        if (digit * power >= smallest) return digit * power;
    }
    return 10 * power;
}

}  // namespace

Axis::Axis(std::pair<double, double> ends, std::pair<double, double> ends_px, Scale scale)
    : low_(ends.first), high_(ends.second), ends_px_(ends_px), scale_(scale) {
    if (scale == Scale::kLogarithmic) {
        low_ = std::log10(low_);
        high_ = std::log10(high_);
    }
    constexpr double kShortest = 1e-9;
    if (high_ - low_ >= kShortest) return;
    const double half = std::max(std::abs(low_) * 0.05, 0.5 * (scale_ == Scale::kLinear ? 0.1 : 1));
    low_ -= half;
    high_ += half;
}

double Axis::Px(double value) const {
    const double v = scale_ == Scale::kLogarithmic ? std::log10(value) : value;
    return std::lerp(ends_px_.first, ends_px_.second, (v - low_) / (high_ - low_));
}

std::vector<Tick> Axis::Ticks() const {
    if (scale_ == Scale::kLogarithmic) return Decades();
    std::vector<Tick> ticks;
    const double step = RoundStep(high_ - low_);
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    for (double k = std::ceil(low_ / step - 1e-9); k * step <= high_ + 1e-9 * step; ++k) {
        ticks.push_back({Px(k * step), Number(k * step, decimals)});
    }
    return ticks;
}

std::vector<Tick> Axis::Decades() const {
    std::vector<Tick> ticks;
    for (double power = std::ceil(low_); power <= high_; ++power) {
        const double value = std::pow(10, power);
        ticks.push_back({Px(value), Number(value, std::max(0, static_cast<int>(-power)))});
    }
    return ticks;
}

}  // namespace hitchview::app

#include "app/jpeg_quality_governor.hpp"

#include <algorithm>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

/// A rise of the quality by one makes a picture up to some 10 % larger: below this share of the
/// budget it is safe, and the band above keeps the quality from going up and down all the time.
constexpr double kCalmShare = 0.8;
constexpr int kCalmPictures = 30;
/// Share of the budget to aim at after an overrun: the next pictures differ a little.
constexpr double kTargetShare = 0.9;

/// Factor on the quantisation tables that the JPEG group's software gives to a quality.
double TableScale(int quality) {
    return quality < 50 ? 50.0 / quality : 2 - quality / 50.0;
}

}  // namespace

JpegQualityGovernor::JpegQualityGovernor(const JpegQualityGovernorOptions& options)
    : budget_bytes_(static_cast<std::size_t>(options.budget_bytes)),
      highest_quality_(options.highest_quality),
      quality_(options.highest_quality) {
    HV_EXPECT(options.budget_bytes > 0);
    HV_EXPECT(highest_quality_ >= kLowestQuality && highest_quality_ <= kHighestQuality);
}

void JpegQualityGovernor::Note(std::size_t bytes) {
    if (!IsWithinBudget(bytes)) {
        Lower(bytes);
    } else if (static_cast<double>(bytes) < kCalmShare * static_cast<double>(budget_bytes_)) {
        MaybeRaise();
    } else {
        calm_pictures_ = 0;
    }
}

void JpegQualityGovernor::Lower(std::size_t bytes) {
    // Bytes fall at least as fast as the square root of the table scale, even for pure noise: the
    // square of the excess as scale is therefore enough.
    const double excess =
        static_cast<double>(bytes) / (kTargetShare * static_cast<double>(budget_bytes_));
    const double scale = TableScale(quality_) * excess * excess;
    while (quality_ > kLowestQuality && TableScale(quality_) < scale) --quality_;
    calm_pictures_ = 0;
}

void JpegQualityGovernor::MaybeRaise() {
    if (++calm_pictures_ < kCalmPictures) return;
    quality_ = std::min(quality_ + 1, highest_quality_);
    calm_pictures_ = 0;
}

}  // namespace hitchview::app

#pragma once

#include <span>

namespace hitchview::app {

struct FrequencyBand {
    double lowest_hz;
    double highest_hz;
};

/// Mean square of what a path does between two frequencies. The path loses its least squares cubic
/// first, then a Hann window stands over it; the spectrum is scaled so that a sine of amplitude a
/// inside the band gives a^2 / 2. At least 8 samples.
double BandPower(std::span<const double> path, double rate_hz, const FrequencyBand& band);

}  // namespace hitchview::app

#include "app/truth_spectrum.hpp"

#include <Eigen/Dense>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What is left of a path beside the cubic that fits it best: slow steering is not shake.
VectorXd WithoutTrend(const Eigen::Map<const VectorXd>& path) {
    constexpr int kCoefficients = 4;
    const VectorXd t = VectorXd::LinSpaced(path.size(), -1, 1);
    MatrixXd powers(path.size(), kCoefficients);
    powers.col(0).setOnes();
    for (int i = 1; i < kCoefficients; ++i) powers.col(i) = powers.col(i - 1).cwiseProduct(t);
    return path - powers * powers.householderQr().solve(path);
}

ArrayXd HannWindow(Eigen::Index size) {
    const double step = 2 * std::numbers::pi / static_cast<double>(size);
    return 0.5 - 0.5 * (step * ArrayXd::LinSpaced(size, 0, static_cast<double>(size - 1))).cos();
}

}  // namespace

double BandPower(std::span<const double> path, double rate_hz, const FrequencyBand& band) {
    const auto n = static_cast<Eigen::Index>(path.size());
    HV_EXPECT(n >= 8);
    const ArrayXd window = HannWindow(n);
    const VectorXd windowed =
        WithoutTrend(Eigen::Map<const VectorXd>(path.data(), n)).array() * window;
    Eigen::FFT<double> fft;
    std::vector<std::complex<double>> spectrum;
    fft.fwd(spectrum, std::vector<double>(windowed.begin(), windowed.end()));
    double power = 0;
    for (Eigen::Index k = 1; 2 * k <= n; ++k) {
        const double frequency_hz = static_cast<double>(k) * rate_hz / static_cast<double>(n);
        if (frequency_hz < band.lowest_hz || frequency_hz > band.highest_hz) continue;
        const double both_sides = 2 * k == n ? 1 : 2;
        power += both_sides * std::norm(spectrum[static_cast<std::size_t>(k)]);
    }
    return power / (static_cast<double>(n) * window.square().sum());
}

}  // namespace hitchview::app

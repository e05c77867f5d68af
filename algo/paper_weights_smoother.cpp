#include "algo/paper_weights_smoother.hpp"

#include <algorithm>

namespace hitchview::algo {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

PaperWeightsSmoother::PaperWeightsSmoother(const ProfileSmoothingOptions& options,
                                           int lookahead_frames)
    : options_(options), lookahead_frames_(lookahead_frames) {
    for (int outputs = 0; outputs <= options.radius_frames; ++outputs) {
        for (int ahead = 0; ahead <= lookahead_frames; ++ahead) {
            taps_.push_back(Solve(outputs, ahead));
        }
    }
}

std::span<const double> PaperWeightsSmoother::Taps(int outputs, int ahead) const {
    return taps_[static_cast<std::size_t>(outputs * (lookahead_frames_ + 1) + ahead)];
}

/// The unknowns are frames 0..ahead, the outputs frames -1..-outputs. The offset of frame 0 is the
/// first row of the inverse times the right-hand side.
std::vector<double> PaperWeightsSmoother::Solve(int outputs, int ahead) const {
    const auto pull = [&](Index i, int d) {  // between unknown i and the output d frames before 0
        return 2 * options_.lambda * TemporalWeight(i + d, options_.radius_frames);
    };
    const Index unknowns = ahead + 1;
    SymmetricBand A = StabilizationMatrix(unknowns, options_);
    VectorXd fixed = VectorXd::Zero(unknowns);
    for (Index i = 0; i < unknowns; ++i) {
        for (int d = 1; d <= outputs; ++d) fixed(i) += pull(i, d);
    }
    A.AddDiagonal(fixed);
    const VectorXd row = BandedCholesky(A).Solve(VectorXd::Unit(unknowns, 0));

    std::vector<double> taps;
    for (int d = 1; d <= outputs; ++d) {
        double tap = 0;
        for (Index i = 0; i < unknowns; ++i) tap += row(i) * pull(i, d);
        taps.push_back(tap);
    }
    taps.insert(taps.end(), row.begin(), row.end());
    return taps;
}

Vector3d PaperWeightsSmoother::Next(const Window& window) const {
    const std::size_t outputs =
        std::min(window.outputs.size(), static_cast<std::size_t>(options_.radius_frames));
    const std::size_t ahead =
        std::min(window.ahead.size(), static_cast<std::size_t>(lookahead_frames_));
    const auto taps = Taps(static_cast<int>(outputs), static_cast<int>(ahead));
    Vector3d offset = Vector3d::Zero();
    for (std::size_t d = 0; d < outputs; ++d) offset += taps[d] * window.outputs[d];
    for (std::size_t j = 0; j < ahead; ++j) offset += taps[outputs + 1 + j] * window.ahead[j];
    return offset;
}

OutputHistory::OutputHistory(int radius_frames)
    : outputs_(static_cast<std::size_t>(radius_frames), Vector3d::Zero()) {}

void OutputHistory::Move(const Vector3d& motion) {
    for (Vector3d& output : outputs_) output -= motion;
}

void OutputHistory::Push(const Vector3d& offset) {
    if (outputs_.empty()) return;
    std::rotate(outputs_.begin(), outputs_.end() - 1, outputs_.end());
    outputs_.front() = offset;
    count_ = std::min(count_ + 1, outputs_.size());
}

}  // namespace hitchview::algo

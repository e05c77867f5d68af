#include "algo/detail_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/hal/intrin.hpp>

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

/// Pull of a corner's neighbours where no sample agrees with what it should be.
constexpr float kLeastSupport = 0.02F;
constexpr float kLeastVote = 0.01F;  // what weighs less has none
constexpr int kRounds = 2;           // of the robust mean

/// What samples that agree say.
struct Agreement {
    Vector2f sum_px = Vector2f::Zero();  ///< weighted
    float weight = 0;
};

/// In a fixed order.
float SumOf(const cv::v_float32x4& lanes) {
    std::array<float, DetailField::Neighbours::kBlock> of;
    cv::v_store(of.data(), lanes);
    return (of[0] + of[1]) + (of[2] + of[3]);
}

/// Weights samples by how near they are to `mean`; `scale`: what a squared pixel counts.
Agreement Agree(const DetailField::Neighbours& around, const Vector2f& mean,
                const Vector2f& scale) {
    const cv::v_float32x4 one = cv::v_setall_f32(1);
    cv::v_float32x4 weight = cv::v_setzero_f32();
    cv::v_float32x4 sum_x = cv::v_setzero_f32();
    cv::v_float32x4 sum_y = cv::v_setzero_f32();
    for (int i = 0; i < around.count; i += DetailField::Neighbours::kBlock) {
        const cv::v_float32x4 x = cv::v_load(around.x_px.data() + i);
        const cv::v_float32x4 y = cv::v_load(around.y_px.data() + i);
        const cv::v_float32x4 off_x = x - cv::v_setall_f32(mean.x());
        const cv::v_float32x4 off_y = y - cv::v_setall_f32(mean.y());
        const cv::v_float32x4 ratio = cv::v_setall_f32(scale.x()) * off_x * off_x +
                                      cv::v_setall_f32(scale.y()) * off_y * off_y;
        const cv::v_float32x4 fitting =
            cv::v_load(around.weight.data() + i) / ((one + ratio) * (one + ratio));
        const cv::v_float32x4 used = fitting & (ratio <= cv::v_setall_f32(4));
        weight = weight + used;
        sum_x = sum_x + used * x;
        sum_y = sum_y + used * y;
    }
    return {{SumOf(sum_x), SumOf(sum_y)}, SumOf(weight)};
}

ScanlineFit ScanlinesOver(const Projection& canvas, const DetailFieldOptions& options) {
    const int spacing_px = CornerSpacing_px(canvas);
    return {CornerField::CornersOver(canvas.height_px, spacing_px),
            CornerField::CornersOver(canvas.width_px, spacing_px) / 2, options.scanlines};
}

}  // namespace

DetailField::DetailField(const Projection& canvas, const DetailFieldOptions& options)
    : canvas_(canvas),
      mesh_(canvas),
      spacing_px_(static_cast<float>(CornerSpacing_px(canvas))),
      options_(options),
      scanlines_{{ScanlinesOver(canvas, options), ScanlinesOver(canvas, options)}},
      wanted_(canvas, Vector2f::Zero()),
      support_(canvas, 0),
      neighbours_share_(canvas, 0),
      smooth_(canvas, Vector2f::Zero()),
      misses_(canvas, Vector2f::Zero()),
      detail_(canvas, Vector2f::Zero()),
      doubt_px_(canvas, static_cast<float>(options.unknown_px)) {
    samples_.resize(static_cast<std::size_t>(detail_.rows() * detail_.cols()));
}

DetailField::Range DetailField::HalfOf(Overlap overlap) const {
    const int half = detail_.cols() / 2;
    const int first = overlap == Overlap::kLeft ? 0 : half;
    return {first, first + half - 1};
}

void DetailField::Clear(Overlap overlap) {
    const Range half = HalfOf(overlap);
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = half.first; col <= half.last; ++col) {
            samples_[Index(row, col)].clear();
            detail_.at(row, col).setZero();
            doubt_px_.at(row, col) = static_cast<float>(options_.unknown_px);
        }
    }
}

void DetailField::Add(Overlap overlap, const CanvasPair& pair, float weight) {
    const auto& [met, e] = DiscrepancyOf(pair, canvas_, options_.kappa);
    const double x = WrapColumn(met.x(), canvas_.width_px);
    const double u = (x + 0.5) / spacing_px_ + 0.5;
    const double v = (met.y() + 0.5) / spacing_px_ + 0.5;
    const auto col = static_cast<int>(u);
    const auto row = static_cast<int>(v);
    const Range half = HalfOf(overlap);
    if (v < 0 || row >= detail_.rows() || col < half.first || col > half.last) return;
    const Vector2d corner = detail_.Pixel(row, col);
    samples_[Index(row, col)].push_back(
        {(Vector2d(x, met.y()) - corner).cast<float>(), e.cast<float>(), weight});
}

void DetailField::Fit(Overlap overlap, const VertexField& discrepancy) {
    const Range range = FindRange(overlap);
    if (range.last <= range.first) return;
    // What is near lies farther forward in the trailer's view: to the right, in the left overlap.
    const float sign = overlap == Overlap::kLeft ? 1.0F : -1.0F;
    ScanlineFit& scanlines = scanlines_[overlap];
    scanlines.Start(range.last - range.first + 1);
    Vote(range, sign, scanlines);
    scanlines.Solve();
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col)
            Settle(row, col, range, sign * scanlines.At(row, col - range.first));
    }
    Subtract(discrepancy, range);
    Smooth(range);
    Doubt(range);
}

/// The columns that have samples.
DetailField::Range DetailField::FindRange(Overlap overlap) const {
    const Range half = HalfOf(overlap);
    Range range{detail_.cols(), -1};
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = half.first; col <= half.last; ++col) {
            if (samples_[Index(row, col)].empty()) continue;
            range.first = std::min(range.first, col);
            range.last = std::max(range.last, col);
        }
    }
    return range;
}

/// Each sample for the four corners round it.
void DetailField::Vote(const Range& range, float sign, ScanlineFit& fit) const {
    const auto vote = [&](int row, int col, const ScanlineFit::Ballot& ballot, float weight) {
        if (row < 0 || row >= detail_.rows() || col < range.first || col > range.last) return;
        fit.Vote(row, col - range.first, ballot, weight);
    };
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col) {
            for (const Sample& s : samples_[Index(row, col)]) {
                if (s.weight < kLeastVote) continue;
                const ScanlineFit::Ballot ballot = fit.BallotFor(sign * s.e_px.x());
                const Vector2f share = s.off_px.cwiseAbs() / spacing_px_;
                const int down = s.off_px.y() > 0 ? 1 : -1;
                const int across = s.off_px.x() > 0 ? 1 : -1;
                const float beside = s.weight * share.x();
                const float here = s.weight - beside;
                vote(row, col, ballot, here * (1 - share.y()));
                vote(row, col + across, ballot, beside * (1 - share.y()));
                vote(row + down, col, ballot, here * share.y());
                vote(row + down, col + across, ballot, beside * share.y());
            }
        }
    }
}

/// Leaves out what is too far from the corner to count.
void DetailField::Gather(int row, int col, const Range& range, Neighbours& around) const {
    const auto reach_px2 = static_cast<float>(options_.reach_px * options_.reach_px);
    around.count = 0;
    for (int r = std::max(0, row - 1); r <= std::min(detail_.rows() - 1, row + 1); ++r) {
        for (int c = std::max(range.first, col - 1); c <= std::min(range.last, col + 1); ++c) {
            const Vector2f from{spacing_px_ * static_cast<float>(c - col),
                                spacing_px_ * static_cast<float>(r - row)};
            for (const Sample& s : samples_[Index(r, c)]) {
                const float nearness = 1 - (s.off_px + from).squaredNorm() / reach_px2;
                if (nearness <= 0) continue;
                const auto i = static_cast<std::size_t>(around.count++);
                around.x_px[i] = s.e_px.x();
                around.y_px[i] = s.e_px.y();
                around.weight[i] = s.weight * nearness * nearness;
            }
        }
    }
    for (std::size_t i = 0; i < Neighbours::kBlock; ++i) {
        const std::size_t beyond = static_cast<std::size_t>(around.count) + i;
        around.x_px[beyond] = around.y_px[beyond] = around.weight[beyond] = 0;
    }
}

/// Robust mean of the samples that agree with the value in x that the scanlines found.
void DetailField::Settle(int row, int col, const Range& range, float start_px) {
    Neighbours around;
    Gather(row, col, range, around);
    Vector2f mean{start_px, 0};
    float support = 0;
    for (int round = 0; round < kRounds; ++round) {
        const auto scale_px =
            static_cast<float>(round == 0 ? options_.scanlines.tolerance_px : options_.outlier_px);
        const float across = 1 / (scale_px * scale_px);
        const float down = round == 0 ? 0.04F * across : across;  // the start says nothing of y
        const Agreement agreement = Agree(around, mean, {across, down});
        support = agreement.weight;
        if (support <= 0) break;
        mean = agreement.sum_px / support;
    }
    wanted_.at(row, col) = mean;
    support_.at(row, col) = std::max(support, kLeastSupport);
}

void DetailField::Subtract(const VertexField& discrepancy, const Range& range) {
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col) {
            Vector2f& smooth = smooth_.at(row, col);
            smooth = algo::Sample(mesh_, discrepancy, detail_.Pixel(row, col)).cast<float>();
            wanted_.at(row, col) -= smooth;
            detail_.at(row, col) = wanted_.at(row, col);
        }
    }
}

/// Minimises sum support |u - wanted|^2 + smoothness |grad u|^2 (Gauss-Seidel).
void DetailField::Smooth(const Range& range) {
    const auto smoothness = static_cast<float>(options_.smoothness);
    for (int row = 1; row + 1 < detail_.rows(); ++row) {
        for (int col = range.first + 1; col < range.last; ++col) {
            const float support = support_.at(row, col);
            const float share = smoothness / (4 * smoothness + support);
            neighbours_share_.at(row, col) = share;
            wanted_.at(row, col) *= 1 - 4 * share;
        }
    }
    for (int sweep = 0; sweep < options_.sweeps; ++sweep) Sweep(range);
}

void DetailField::Sweep(const Range& range) {
    for (int row = 1; row + 1 < detail_.rows(); ++row) {
        for (int col = range.first + 1; col < range.last; ++col) {
            const float share = neighbours_share_.at(row, col);
            const Vector2f rest = wanted_.at(row, col) +
                                  share * (detail_.at(row, col + 1) + detail_.at(row - 1, col) +
                                           detail_.at(row + 1, col));
            detail_.at(row, col) = rest + share * detail_.at(row, col - 1);
        }
    }
}

void DetailField::Doubt(const Range& range) {
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col)
            misses_.at(row, col) = MissesAt(row, col);
    }
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col) {
            Vector2f sum{static_cast<float>(options_.unknown_px), 1};
            for (int r = std::max(0, row - 1); r <= std::min(detail_.rows() - 1, row + 1); ++r) {
                for (int c = std::max(range.first, col - 1); c <= std::min(range.last, col + 1);
                     ++c)
                    sum += misses_.at(r, c);
            }
            doubt_px_.at(row, col) = sum.x() / sum.y();
        }
    }
}

/// How far the samples nearest to a corner are off, weighted, and their weights.
Vector2f DetailField::MissesAt(int row, int col) const {
    constexpr float kLeastWeight = 0.2F;  // what is hard to match is in doubt, too
    const Vector2f e = detail_.at(row, col) + smooth_.at(row, col);
    Vector2f misses = Vector2f::Zero();
    for (const Sample& s : samples_[Index(row, col)]) {
        const float weight = std::max(kLeastWeight, s.weight);
        const float miss_px = (s.e_px - e).norm();
        misses +=
            weight * Vector2f{std::min(miss_px, static_cast<float>(options_.most_doubt_px)), 1};
    }
    return misses;
}

}  // namespace hitchview::algo

#include "algo/detail_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/hal/intrin.hpp>

#include "algo/feature_motion.hpp"

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

/// Weights of samples by how near they are to a place.
class Nearness {
 public:
    Nearness(const Vector2d& place_px, double reach_px)
        : x_px_(cv::v_setall_f32(static_cast<float>(place_px.x()))),
          y_px_(cv::v_setall_f32(static_cast<float>(place_px.y()))),
          per_px2_(cv::v_setall_f32(static_cast<float>(1 / (reach_px * reach_px)))) {}

    /// Of a block of samples.
    [[nodiscard]] cv::v_float32x4 Weigh(const CornerSamples& samples, int place) const {
        const cv::v_float32x4 off_x = cv::v_load(samples.x_px.data() + place) - x_px_;
        const cv::v_float32x4 off_y = cv::v_load(samples.y_px.data() + place) - y_px_;
        const cv::v_float32x4 nearness =
            cv::v_setall_f32(1) - per_px2_ * (off_x * off_x + off_y * off_y);
        const cv::v_float32x4 root = cv::v_max(nearness, cv::v_setzero_f32());
        return cv::v_load(samples.weight.data() + place) * root * root;
    }

 private:
    cv::v_float32x4 x_px_;
    cv::v_float32x4 y_px_;
    cv::v_float32x4 per_px2_;
};

CornerSamples SamplesOver(const Projection& canvas) {
    const int spacing_px = CornerSpacing_px(canvas);
    return {CornerField::CornersOver(canvas.height_px, spacing_px),
            CornerField::CornersOver(canvas.width_px, spacing_px),
            static_cast<int>(kMaxParallaxSamples)};
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
      samples_{{SamplesOver(canvas), SamplesOver(canvas)}},
      scanlines_{{ScanlinesOver(canvas, options), ScanlinesOver(canvas, options)}},
      wanted_(canvas, Vector2f::Zero()),
      support_(canvas, 0),
      neighbours_share_(canvas, 0),
      smooth_(canvas, Vector2f::Zero()),
      misses_(canvas, Vector2f::Zero()),
      detail_(canvas, Vector2f::Zero()),
      doubt_px_(canvas, static_cast<float>(options.unknown_px)),
      past_(canvas, options.past) {}

CornerColumns DetailField::HalfOf(Overlap overlap) const {
    const int half = detail_.cols() / 2;
    const int first = overlap == Overlap::kLeft ? 0 : half;
    return {first, first + half - 1};
}

void DetailField::Reset() {
    for (const Overlap overlap : kOverlaps) {
        Clear(overlap);
        past_.Forget(overlap);
    }
}

void DetailField::Clear(Overlap overlap) {
    samples_[overlap].Clear();
    const CornerColumns half = HalfOf(overlap);
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = half.first; col <= half.last; ++col) {
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
    const CornerColumns half = HalfOf(overlap);
    if (v < 0 || row >= detail_.rows() || col < half.first || col > half.last) return;
    samples_[overlap].Add(row, col, {Vector2d(x, met.y()).cast<float>(), e.cast<float>(), weight});
}

void DetailField::Fit(Overlap overlap, const VertexField& discrepancy) {
    samples_[overlap].Sort();
    CornerColumns range = FindRange(overlap);
    if (range.last <= range.first) range = {};
    const CornerColumns both = CornerColumns::Together(range, past_.columns(overlap));
    LookUpMesh(discrepancy, both);
    if (!range.empty()) FitSamples(overlap, range);
    past_.Hold(overlap, smooth_, doubt_px_, detail_);
    past_.Remember(overlap, both, smooth_, detail_);
}

void DetailField::FitSamples(Overlap overlap, const CornerColumns& range) {
    const CornerSamples& samples = samples_[overlap];
    // What is near lies farther forward in the trailer's view: to the right, in the left overlap.
    const float sign = overlap == Overlap::kLeft ? 1.0F : -1.0F;
    ScanlineFit& scanlines = scanlines_[overlap];
    scanlines.Start(range.last - range.first + 1);
    Vote(samples, range, sign, scanlines);
    scanlines.Solve();
    Neighbours around;
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col) {
            Gather(samples, row, col, range, around);
            Settle(around, row, col, sign * scanlines.At(row, col - range.first));
        }
    }
    Subtract(range);
    Smooth(range);
    Doubt(samples, range);
}

/// The columns that have samples.
CornerColumns DetailField::FindRange(Overlap overlap) const {
    const CornerColumns half = HalfOf(overlap);
    CornerColumns range{detail_.cols(), -1};
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = half.first; col <= half.last; ++col) {
            const CornerSamples::Run run = samples_[overlap].Of(row, col, col);
            if (run.first == run.end) continue;
            range.first = std::min(range.first, col);
            range.last = std::max(range.last, col);
        }
    }
    return range;
}

/// Each sample for the four corners round it.
void DetailField::Vote(const CornerSamples& samples, const CornerColumns& range, float sign,
                       ScanlineFit& fit) const {
    const auto vote = [&](int row, int col, const ScanlineFit::Ballot& ballot, float weight) {
        if (row < 0 || row >= detail_.rows() || col < range.first || col > range.last) return;
        fit.Vote(row, col - range.first, ballot, weight);
    };
    for (int row = 0; row < detail_.rows(); ++row) {
        const auto [first, end] = samples.Of(row, range.first, range.last);
        for (int place = first; place < end; ++place) {
            const CornerSamples::Sample s = samples.At(place);
            if (s.weight < kLeastVote) continue;
            const ScanlineFit::Ballot ballot = fit.BallotFor(sign * s.e_px.x());
            const Vector2f at = (s.at_px.array() + 0.5F) / spacing_px_;
            const auto left = static_cast<int>(at.x());
            const int above = static_cast<int>(at.y() + 1) - 1;
            const float right_part = s.weight * (at.x() - static_cast<float>(left));
            const float left_part = s.weight - right_part;
            const float down = at.y() - static_cast<float>(above);
            vote(above, left, ballot, left_part * (1 - down));
            vote(above, left + 1, ballot, right_part * (1 - down));
            vote(above + 1, left, ballot, left_part * down);
            vote(above + 1, left + 1, ballot, right_part * down);
        }
    }
}

/// Leaves out what is too far from the corner to count.
void DetailField::Gather(const CornerSamples& samples, int row, int col, const CornerColumns& range,
                         Neighbours& around) const {
    const Nearness nearness(detail_.Pixel(row, col), options_.reach_px);
    constexpr int kBlock = CornerSamples::kBlock;
    around.count = 0;
    for (int r = std::max(0, row - 1); r <= std::min(detail_.rows() - 1, row + 1); ++r) {
        const auto [first, end] =
            samples.Of(r, std::max(range.first, col - 1), std::min(range.last, col + 1));
        const int count = std::min(end - first, Neighbours::kMost - around.count);
        for (int i = 0; i < count; i += kBlock) {
            const int to = around.count + i;
            cv::v_store(around.x_px.data() + to, cv::v_load(samples.e_x_px.data() + first + i));
            cv::v_store(around.y_px.data() + to, cv::v_load(samples.e_y_px.data() + first + i));
            cv::v_store(around.weight.data() + to, nearness.Weigh(samples, first + i));
        }
        around.count += count;
    }
    for (float* list : {around.x_px.data(), around.y_px.data(), around.weight.data()})
        cv::v_store(list + around.count, cv::v_setzero_f32());
}

/// Robust mean of the samples that agree with the value in x that the scanlines found.
void DetailField::Settle(const Neighbours& around, int row, int col, float start_px) {
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

void DetailField::LookUpMesh(const VertexField& discrepancy, const CornerColumns& range) {
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col) {
            smooth_.at(row, col) =
                algo::Sample(mesh_, discrepancy, detail_.Pixel(row, col)).cast<float>();
        }
    }
}

void DetailField::Subtract(const CornerColumns& range) {
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col) {
            wanted_.at(row, col) -= smooth_.at(row, col);
            detail_.at(row, col) = wanted_.at(row, col);
        }
    }
}

/// Minimises sum support |u - wanted|^2 + smoothness |grad u|^2 (Gauss-Seidel).
void DetailField::Smooth(const CornerColumns& range) {
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

void DetailField::Sweep(const CornerColumns& range) {
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

void DetailField::Doubt(const CornerSamples& samples, const CornerColumns& range) {
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col)
            misses_.at(row, col) = MissesAt(samples, row, col);
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
Vector2f DetailField::MissesAt(const CornerSamples& samples, int row, int col) const {
    constexpr float kLeastWeight = 0.2F;  // what is hard to match is in doubt, too
    const Vector2f e = detail_.at(row, col) + smooth_.at(row, col);
    Vector2f misses = Vector2f::Zero();
    const auto [first, end] = samples.Of(row, col, col);
    for (int place = first; place < end; ++place) {
        const CornerSamples::Sample s = samples.At(place);
        const float weight = std::max(kLeastWeight, s.weight);
        const float miss_px = (s.e_px - e).norm();
        misses +=
            weight * Vector2f{std::min(miss_px, static_cast<float>(options_.most_doubt_px)), 1};
    }
    return misses;
}

}  // namespace hitchview::algo

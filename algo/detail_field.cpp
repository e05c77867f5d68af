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
      fitted_before_(canvas, Vector2f::Zero()) {}

DetailField::Range DetailField::HalfOf(Overlap overlap) const {
    const int half = detail_.cols() / 2;
    const int first = overlap == Overlap::kLeft ? 0 : half;
    return {first, first + half - 1};
}

void DetailField::Reset() {
    for (const Overlap overlap : kOverlaps) {
        Clear(overlap);
        fitted_before_range_[overlap] = {};
    }
}

void DetailField::Clear(Overlap overlap) {
    samples_[overlap].Clear();
    const Range half = HalfOf(overlap);
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
    const Range half = HalfOf(overlap);
    if (v < 0 || row >= detail_.rows() || col < half.first || col > half.last) return;
    samples_[overlap].Add(row, col, {Vector2d(x, met.y()).cast<float>(), e.cast<float>(), weight});
}

void DetailField::Fit(Overlap overlap, const VertexField& discrepancy) {
    samples_[overlap].Sort();
    Range range = FindRange(overlap);
    if (range.last <= range.first) range = Range{};
    const Range before = fitted_before_range_[overlap];
    const Range both = Together(range, before);
    LookUpMesh(discrepancy, both);
    if (!range.empty()) FitSamples(overlap, range);
    KeepInDoubt(before);
    Remember(overlap, both);
}

void DetailField::FitSamples(Overlap overlap, const Range& range) {
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

DetailField::Range DetailField::Together(const Range& a, const Range& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {std::min(a.first, b.first), std::max(a.last, b.last)};
}

/// The columns that have samples.
DetailField::Range DetailField::FindRange(Overlap overlap) const {
    const Range half = HalfOf(overlap);
    Range range{detail_.cols(), -1};
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
void DetailField::Vote(const CornerSamples& samples, const Range& range, float sign,
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
void DetailField::Gather(const CornerSamples& samples, int row, int col, const Range& range,
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

void DetailField::LookUpMesh(const VertexField& discrepancy, const Range& range) {
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col) {
            smooth_.at(row, col) =
                algo::Sample(mesh_, discrepancy, detail_.Pixel(row, col)).cast<float>();
        }
    }
}

void DetailField::Subtract(const Range& range) {
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = range.first; col <= range.last; ++col) {
            wanted_.at(row, col) -= smooth_.at(row, col);
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

/// What the samples do not bear out leaves what it was before by and by, moved as what is sure in
/// its row: so it goes along when the units shake. `range`: where something was fitted before.
void DetailField::KeepInDoubt(const Range& range) {
    for (int row = 0; row < detail_.rows(); ++row) {
        const Vector2f moved = SureChange(row, range);
        for (int col = range.first; col <= range.last; ++col) {
            const Vector2f before = fitted_before_.at(row, col) + moved - smooth_.at(row, col);
            detail_.at(row, col) =
                before + Step(detail_.at(row, col) - before, SurenessAt(row, col));
        }
    }
}

/// What a corner takes of a change, per axis.
Vector2f DetailField::Step(const Vector2f& change_px, float sureness) const {
    if (sureness >= 1) return change_px;
    const auto least = static_cast<float>(options_.least_gain);
    const Vector2f most =
        Vector2f::Constant(static_cast<float>(options_.unsure_step_px) / (1 - sureness));
    const float gain = least + (1 - least) * sureness;
    return (gain * change_px).cwiseMax(-most).cwiseMin(most);
}

/// How much the whole discrepancy of a row changed, the mean over its corners by their sureness.
Vector2f DetailField::SureChange(int row, const Range& range) const {
    constexpr float kStill = 1;  // sure corner that did not change is added
    Vector2f sum = Vector2f::Zero();
    float weight = kStill;
    for (int col = range.first; col <= range.last; ++col) {
        const float sureness = SurenessAt(row, col);
        sum +=
            sureness * (detail_.at(row, col) + smooth_.at(row, col) - fitted_before_.at(row, col));
        weight += sureness;
    }
    return sum / weight;
}

/// 1 where the samples agree, 0 where they do not, or are none.
float DetailField::SurenessAt(int row, int col) const {
    const double share =
        (options_.unsure_px - doubt_px_.at(row, col)) / (options_.unsure_px - options_.sure_px);
    return static_cast<float>(std::clamp(share, 0.0, 1.0));
}

bool DetailField::HasDetail(int col) const {
    constexpr float kLeast_px = 0.25F;
    for (int row = 0; row < detail_.rows(); ++row)
        if (detail_.at(row, col).cwiseAbs().maxCoeff() > kLeast_px) return true;
    return false;
}

/// Columns at the rims that have no detail any more are forgotten.
void DetailField::Remember(Overlap overlap, const Range& range) {
    Range kept = range;
    while (!kept.empty() && !HasDetail(kept.first)) ++kept.first;
    while (!kept.empty() && !HasDetail(kept.last)) --kept.last;
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = kept.first; col <= kept.last; ++col)
            fitted_before_.at(row, col) = detail_.at(row, col) + smooth_.at(row, col);
    }
    fitted_before_range_[overlap] = kept.empty() ? Range{} : kept;
}

void DetailField::Doubt(const CornerSamples& samples, const Range& range) {
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

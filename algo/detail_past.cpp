#include "algo/detail_past.hpp"

#include <algorithm>

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

bool HasDetail(const CornerField& detail, int col) {
    constexpr float kLeast_px = 0.25F;
    for (int row = 0; row < detail.rows(); ++row)
        if (detail.at(row, col).cwiseAbs().maxCoeff() > kLeast_px) return true;
    return false;
}

}  // namespace

CornerColumns CornerColumns::Together(const CornerColumns& a, const CornerColumns& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {std::min(a.first, b.first), std::max(a.last, b.last)};
}

DetailPast::DetailPast(const Projection& canvas, const DetailPastOptions& options)
    : options_(options), discrepancy_(canvas, Vector2f::Zero()), sureness_(canvas, 0) {}

/// Moved as what is sure in its row: so it goes along when the units shake.
void DetailPast::Hold(Overlap overlap, const CornerField& mesh_part, const CornerScalars& doubt_px,
                      CornerField& detail) {
    const CornerColumns& columns = columns_[overlap];
    JudgeSureness(columns, doubt_px);
    for (int row = 0; row < detail.rows(); ++row) {
        const Vector2f moved = SureChange(row, columns, mesh_part, detail);
        for (int col = columns.first; col <= columns.last; ++col) {
            const Vector2f before = discrepancy_.at(row, col) + moved - mesh_part.at(row, col);
            detail.at(row, col) =
                before + Step(detail.at(row, col) - before, sureness_.at(row, col));
        }
    }
}

void DetailPast::JudgeSureness(const CornerColumns& columns, const CornerScalars& doubt_px) {
    for (int row = 0; row < doubt_px.rows(); ++row) {
        for (int col = columns.first; col <= columns.last; ++col) {
            const double share = (options_.unsure_px - doubt_px.at(row, col)) /
                                 (options_.unsure_px - options_.sure_px);
            sureness_.at(row, col) = static_cast<float>(std::clamp(share, 0.0, 1.0));
        }
    }
}

/// How much the discrepancy of a row changed, the mean over its corners by their sureness.
Vector2f DetailPast::SureChange(int row, const CornerColumns& columns, const CornerField& mesh_part,
                                const CornerField& detail) const {
    constexpr float kStill = 1;  // sure corner that did not change is added
    Vector2f sum = Vector2f::Zero();
    float weight = kStill;
    for (int col = columns.first; col <= columns.last; ++col) {
        const float sureness = sureness_.at(row, col);
        sum +=
            sureness * (detail.at(row, col) + mesh_part.at(row, col) - discrepancy_.at(row, col));
        weight += sureness;
    }
    return sum / weight;
}

/// What a corner takes of a change, per axis.
Vector2f DetailPast::Step(const Vector2f& change_px, float sureness) const {
    if (sureness >= 1) return change_px;
    const auto least = static_cast<float>(options_.least_gain);
    const Vector2f most =
        Vector2f::Constant(static_cast<float>(options_.most_step_px) / (1 - sureness));
    const float gain = least + (1 - least) * sureness;
    return (gain * change_px).cwiseMax(-most).cwiseMin(most);
}

void DetailPast::Remember(Overlap overlap, CornerColumns columns, const CornerField& mesh_part,
                          const CornerField& detail) {
    while (!columns.empty() && !HasDetail(detail, columns.first)) ++columns.first;
    while (!columns.empty() && !HasDetail(detail, columns.last)) --columns.last;
    for (int row = 0; row < detail.rows(); ++row) {
        for (int col = columns.first; col <= columns.last; ++col)
            discrepancy_.at(row, col) = detail.at(row, col) + mesh_part.at(row, col);
    }
    columns_[overlap] = columns.empty() ? CornerColumns{} : columns;
}

}  // namespace hitchview::algo

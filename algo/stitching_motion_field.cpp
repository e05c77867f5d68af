#include "algo/stitching_motion_field.hpp"

#include <algorithm>

namespace hitchview::algo {

using Eigen::Vector2d;
using Eigen::Vector2f;

namespace {

/// Rounds of easing steep edges one by one; what is left after them scales the whole field.
constexpr int kEasingRounds = 12;

}  // namespace

StitchingMotionField::StitchingMotionField(const Projection& canvas,
                                           const StitchingMotionFieldOptions& options)
    : canvas_(canvas), mesh_(canvas), options_(options), fit_(mesh_, options.fit) {}

void StitchingMotionField::Reset() {
    samples_.clear();
    field_.setZero();
    confidence_.setZero();
}

void StitchingMotionField::Carry(const Eigen::Matrix3d& M_early_late) {
    const VertexField early = field_;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const Vector2d at = canvas_.Pixel(M_early_late * canvas_.Ray(mesh_.Vertex(row, col)));
            field_.col(Mesh::Index(row, col)) = Sample(mesh_, early, at).cast<float>();
        }
    }
}

void StitchingMotionField::Update(const CanvasPairs& pairs) {
    for (const CanvasPair& pair : pairs)
        samples_.push_back(DiscrepancyOf(pair, canvas_, options_.kappa));
}

void StitchingMotionField::Extend() {
    predicted_ = field_;
    fit_.Fit({samples_.data(), samples_.size()}, predicted_, confidence_, field_, support_);
    confidence_ = (static_cast<float>(options_.forgetting) * confidence_ + support_).cwiseMin(1.0F);
    samples_.clear();
    GuardFolds();
}

void StitchingMotionField::GuardFolds() {
    for (int round = 0; round < kEasingRounds; ++round) {
        if (!Ease()) break;
        CloseRing(mesh_, field_);
    }
    float steepest = 0;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            if (col < Mesh::kCols) {
                const Vector2f across = field_.col(i + 1) - field_.col(i);
                steepest = std::max(
                    steepest, across.cwiseAbs().maxCoeff() / static_cast<float>(mesh_.cell_px.x()));
            }
            if (row < Mesh::kRows) {
                const Vector2f down = field_.col(i + Mesh::kVertexCols) - field_.col(i);
                steepest = std::max(
                    steepest, down.cwiseAbs().maxCoeff() / static_cast<float>(mesh_.cell_px.y()));
            }
        }
    }
    const auto limit = static_cast<float>(options_.max_stretch);
    if (steepest > limit) field_ *= limit / steepest;
}

/// Draws the ends of steep edges together; false if there were none.
bool StitchingMotionField::Ease() {
    bool any = false;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            if (col < Mesh::kCols) {
                any = EaseEdge(i, i + 1, static_cast<float>(mesh_.cell_px.x())) || any;
            }
            if (row < Mesh::kRows) {
                const int below = i + Mesh::kVertexCols;
                any = EaseEdge(i, below, static_cast<float>(mesh_.cell_px.y())) || any;
            }
        }
    }
    return any;
}

bool StitchingMotionField::EaseEdge(int a, int b, float cell_px) {
    const float limit = static_cast<float>(options_.max_stretch) * cell_px;
    const Vector2f difference = field_.col(b) - field_.col(a);
    const Vector2f excess = difference - difference.cwiseMin(limit).cwiseMax(-limit);
    if (excess.cwiseAbs().maxCoeff() <= 0.02F * limit) return false;
    field_.col(a) += 0.5F * excess;
    field_.col(b) -= 0.5F * excess;
    return true;
}

}  // namespace hitchview::algo

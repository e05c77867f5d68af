#include "algo/stitching_motion_field.hpp"

#include "algo/fold_guard.hpp"

namespace hitchview::algo {

using Eigen::Vector2d;

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
    const auto most_px = static_cast<float>(options_.most_px);
    field_ = field_.cwiseMax(-most_px).cwiseMin(most_px);
    GuardFolds(mesh_, options_.max_stretch, field_);
}

}  // namespace hitchview::algo

#include "algo/placement_path.hpp"

#include <algorithm>
#include <cmath>

#include "algo/paper_stages.hpp"

namespace hitchview::algo {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::RowVector4d;

namespace {

RowVector4d ToRow(const Projection& view, const Matrix3d& pose) {
    RowVector4d row;
    row << ToOffset(view, pose).value.transpose(), std::log(ScaleOf(view, pose));
    return row;
}

Matrix3d FromRow(const Projection& view, const RowVector4d& row) {
    const Matrix3d rigid = ToPose(view, {row.head<3>().transpose()});
    return view.IsRing() ? rigid : Matrix3d(rigid * ZoomAbout(view.Centre(), std::exp(row(3))));
}

}  // namespace

std::vector<Matrix3d> SmoothPlacements(const Projection& view,
                                       const std::vector<PlacementSample>& samples, double mu,
                                       int radius_frames) {
    const auto first = std::find_if(samples.begin(), samples.end(),
                                    [](const PlacementSample& s) { return s.confidence > 0; });
    if (first == samples.end()) return {};
    const Matrix3d& reference = first->pose;
    const auto frames = static_cast<Index>(samples.size());
    Profiles path = Profiles::Zero(frames, 4);
    Profiles confidence(frames, 4);
    for (Index i = 0; i < frames; ++i) {
        const PlacementSample& sample = samples[static_cast<std::size_t>(i)];
        if (sample.confidence > 0) path.row(i) = ToRow(view, sample.pose * reference.inverse());
        confidence.row(i).setConstant(sample.confidence);
    }
    const Profiles smooth = SmoothByConfidence(path, confidence, mu, radius_frames);
    std::vector<Matrix3d> poses;
    for (Index i = 0; i < frames; ++i) poses.push_back(FromRow(view, smooth.row(i)) * reference);
    return poses;
}

}  // namespace hitchview::algo

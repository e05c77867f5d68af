#include "algo/grey_reduction.hpp"

namespace hitchview::algo {

GreyReduction::GreyReduction(int side, int max_width_px)
    : side_(side), means_(max_width_px * side) {}

void GreyReduction::Reduce(const SamplePlane& plane, const cv::Rect& used, cv::Mat1b& reduced) {
    for (int y = used.y; y < used.br().y; ++y) {
        const BoxMean::Rows rows{plane.row(y * side_) + used.x * side_ * plane.step_bytes,
                                 plane.stride_bytes, plane.step_bytes};
        means_.Take(rows, {side_, side_}, used.width, reduced[y] + used.x);
    }
}

}  // namespace hitchview::algo

#include "app/truth_seam.hpp"

#include <algorithm>

namespace hitchview::app {

void TruthSeam::Observe(bool there, algo::SeamState state) {
    const bool locked = state == algo::SeamState::kLocked;
    if (there && !was_there_) {
        ++figures_.appearances;
        waiting_ = true;
        wait_ = 0;
    }
    was_there_ = there;
    figures_.frames_locked_away += !there && locked ? 1 : 0;
    if (!there) return;
    ++figures_.frames_there;
    figures_.frames_locked += locked ? 1 : 0;
    waiting_ = waiting_ && !locked;
    if (waiting_) figures_.longest_wait = std::max(figures_.longest_wait, ++wait_);
}

void FieldJump::Observe(algo::Overlap overlap, const algo::Composition& composition) {
    const bool locked = composition.seams[overlap] == algo::SeamState::kLocked;
    const algo::VertexField& late = composition.discrepancy;
    if (locked && early_locked_) {
        const int first = overlap == algo::Overlap::kLeft ? 0 : algo::Mesh::kCols / 2;
        for (int row = 0; row < algo::Mesh::kVertexRows; ++row) {
            for (int col = first; col < first + algo::Mesh::kCols / 2; ++col) {
                const int i = algo::Mesh::Index(row, col);
                largest_px_ = std::max<double>(largest_px_, (late.col(i) - early_.col(i)).norm());
            }
        }
    }
    early_ = late;
    early_locked_ = locked;
}

}  // namespace hitchview::app

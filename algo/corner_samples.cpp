#include "algo/corner_samples.hpp"

#include <algorithm>
#include <numeric>

namespace hitchview::algo {

CornerSamples::CornerSamples(int rows, int cols, int most)
    : cols_(cols),
      most_(static_cast<std::size_t>(most)),
      begin_(static_cast<std::size_t>(rows * cols + 1), 0),
      next_(begin_.size(), 0) {
    added_.reserve(most_);
    for (std::vector<float>* values : {&x_px, &y_px, &e_x_px, &e_y_px, &weight})
        values->resize(most_ + kBlock, 0.0F);
}

void CornerSamples::Clear() {
    added_.clear();
    std::fill(begin_.begin(), begin_.end(), 0);
}

void CornerSamples::Add(int row, int col, const Sample& sample) {
    if (added_.size() < most_) added_.push_back({row * cols_ + col, sample});
}

void CornerSamples::Sort() {
    std::fill(begin_.begin(), begin_.end(), 0);
    for (const Added& added : added_) ++begin_[static_cast<std::size_t>(added.corner) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::copy(begin_.begin(), begin_.end(), next_.begin());
    for (const auto& [corner, sample] : added_) {
        const auto i = static_cast<std::size_t>(next_[static_cast<std::size_t>(corner)]++);
        x_px[i] = sample.at_px.x();
        y_px[i] = sample.at_px.y();
        e_x_px[i] = sample.e_px.x();
        e_y_px[i] = sample.e_px.y();
        weight[i] = sample.weight;
    }
}

}  // namespace hitchview::algo

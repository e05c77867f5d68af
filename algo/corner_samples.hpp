#pragma once

#include <Eigen/Core>
#include <vector>

namespace hitchview::algo {

/// Samples of a discrepancy on a canvas, beside each other in memory as the corners that they are
/// nearest to. Memory is taken at construction; not thread-safe.
class CornerSamples {
 public:
    struct Sample {
        Eigen::Vector2f at_px;
        Eigen::Vector2f e_px;  ///< discrepancy
        float weight;
    };
    /// Places of samples, the last one not included.
    struct Run {
        int first;
        int end;
    };
    static constexpr int kBlock = 4;  ///< so many beyond a run may be read

    CornerSamples(int rows, int cols, int most);

    void Clear();
    /// Near this corner. What is more than `most` is left out.
    void Add(int row, int col, const Sample& sample);
    /// To be called after the last Add and before what follows. Samples of one corner stay in their
    /// order.
    void Sort();

    /// Those of a row of corners from `first` to `last`, both included.
    [[nodiscard]] Run Of(int row, int first, int last) const {
        const int left = row * cols_;
        return {begin_[static_cast<std::size_t>(left + first)],
                begin_[static_cast<std::size_t>(left + last + 1)]};
    }
    [[nodiscard]] Sample At(int place) const {
        const auto i = static_cast<std::size_t>(place);
        return {{x_px[i], y_px[i]}, {e_x_px[i], e_y_px[i]}, weight[i]};
    }

    /// By place.
    std::vector<float> x_px;
    std::vector<float> y_px;
    std::vector<float> e_x_px;
    std::vector<float> e_y_px;
    std::vector<float> weight;

 private:
    struct Added {
        int corner;
        Sample sample;
    };

    int cols_;
    std::size_t most_;
    std::vector<Added> added_;
    std::vector<int> begin_;  // place of the first sample of each corner, and of one more
    std::vector<int> next_;   // likewise, while they are sorted
};

}  // namespace hitchview::algo

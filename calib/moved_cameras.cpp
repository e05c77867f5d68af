#include "calib/moved_cameras.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>

namespace hitchview::calib {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kMostMoved = 3;

/// A set of cameras, one bit each.
using Cameras = std::uint32_t;

/// Turns of those cameras that suit the pairs best, others stay; three numbers each, by index.
class Hypothesis {
 public:
    Hypothesis(std::size_t cameras, const std::vector<PairTurn>& pairs, Cameras moved)
        : pairs_(pairs), turns_(cameras, Vector3d::Zero()) {
        for (std::size_t i = 0; i < cameras; ++i)
            if ((moved >> i & 1U) != 0) free_.push_back(i);
        if (!free_.empty()) Fit();
    }

    [[nodiscard]] bool Explains(double limit_rad) const {
        return std::ranges::all_of(pairs_, [&](const PairTurn& pair) {
            const Vector3d left = turns_[pair.second] - turns_[pair.first] - pair.turn_rad;
            return pair.Shift_rad(left) <= limit_rad;
        });
    }
    [[nodiscard]] std::vector<MovedCamera> Moved() const {
        std::vector<MovedCamera> moved;
        for (const std::size_t i : free_) moved.push_back({i, turns_[i].norm()});
        return moved;
    }

 private:
    /// Place of a camera among the free ones; empty: it stays.
    [[nodiscard]] std::optional<Eigen::Index> Column(std::size_t camera) const {
        const auto at = std::ranges::find(free_, camera);
        if (at == free_.end()) return std::nullopt;
        return 3 * (at - free_.begin());
    }

    void Fit() {
        const auto size = 3 * std::ssize(free_);
        // A turn that no pair shows is none.
        MatrixXd normal = 1e-9 * MatrixXd::Identity(size, size);
        VectorXd right = VectorXd::Zero(size);
        for (const PairTurn& pair : pairs_) Add(pair, normal, right);
        const VectorXd found = normal.ldlt().solve(right);
        for (std::size_t i = 0; i < free_.size(); ++i)
            turns_[free_[i]] = found.segment<3>(3 * static_cast<Eigen::Index>(i));
    }

    void Add(const PairTurn& pair, MatrixXd& normal, VectorXd& right) const {
        const auto first = Column(pair.first);
        const auto second = Column(pair.second);
        if (first) normal.block<3, 3>(*first, *first) += pair.shown;
        if (second) normal.block<3, 3>(*second, *second) += pair.shown;
        if (first && second) {
            normal.block<3, 3>(*first, *second) -= pair.shown;
            normal.block<3, 3>(*second, *first) -= pair.shown;
        }
        if (first) right.segment<3>(*first) -= pair.shown * pair.turn_rad;
        if (second) right.segment<3>(*second) += pair.shown * pair.turn_rad;
    }

    const std::vector<PairTurn>& pairs_;
    std::vector<std::size_t> free_{};
    std::vector<Vector3d> turns_;
};

}  // namespace

std::vector<std::vector<MovedCamera>> ExplainByMoves(std::size_t cameras,
                                                     const std::vector<PairTurn>& pairs,
                                                     double limit_rad) {
    std::vector<std::vector<MovedCamera>> answers;
    for (int count = 0; count <= kMostMoved && answers.empty(); ++count) {
        for (Cameras moved = 0; moved < Cameras{1} << cameras; ++moved) {
            if (std::popcount(moved) != count) continue;
            const Hypothesis hypothesis(cameras, pairs, moved);
            if (hypothesis.Explains(limit_rad)) answers.push_back(hypothesis.Moved());
        }
    }
    return answers;
}

}  // namespace hitchview::calib

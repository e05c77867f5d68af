#include "calib/moved_cameras.hpp"

#include <algorithm>

#include "calib/reprojection_error.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kMostMoved = 3;

/// Looks for the fewest cameras.
class Explanation {
 public:
    Explanation(std::size_t cameras, const std::vector<PairTurn>& pairs, double limit_rad)
        : pairs_(pairs), limit_rad_(limit_rad), turns_(cameras, Vector3d::Zero()) {}

    /// With exactly `count` moved cameras.
    std::vector<std::vector<MovedCamera>> WithCount(std::size_t count) {
        answers_.clear();
        Choose(0, count);
        return answers_;
    }

 private:
    /// Completes the set of moved cameras with `count` from `from` on.
    void Choose(std::size_t from, std::size_t count) {
        if (count == 0) {
            if (TurnFrom(0)) Keep();
            return;
        }
        for (std::size_t camera = from; camera + count <= turns_.size(); ++camera) {
            moved_.push_back(camera);
            Choose(camera + 1, count - 1);
            moved_.pop_back();
        }
    }

    /// Whether turns of the moved cameras from number `i` on explain all pairs; sets the turns.
    bool TurnFrom(std::size_t i) {
        if (i == moved_.size()) return Explains();
        for (const Vector3d& turn : Candidates(moved_[i])) {
            turns_[moved_[i]] = turn;
            if (TurnFrom(i + 1)) return true;
        }
        turns_[moved_[i]] = Vector3d::Zero();
        return false;
    }

    /// What the pairs of a camera suggest while their other camera stays.
    [[nodiscard]] std::vector<Vector3d> Candidates(std::size_t camera) const {
        std::vector<Vector3d> candidates;
        for (const PairTurn& pair : pairs_) {
            if (pair.second == camera) candidates.push_back(pair.turn_rad);
            if (pair.first == camera) candidates.emplace_back(-pair.turn_rad);
        }
        return candidates;
    }

    [[nodiscard]] bool Explains() const {
        return std::ranges::all_of(pairs_, [&](const PairTurn& pair) {
            const Vector3d left = turns_[pair.second] - turns_[pair.first] - pair.turn_rad;
            if (left.norm() <= limit_rad_) return true;
            const double best = pair.OffShare(Matrix3d::Identity(), Rotation(pair.turn_rad));
            return pair.OffShare(Rotation(turns_[pair.first]), Rotation(turns_[pair.second])) <
                   best + PairTurn::kClearly;
        });
    }

    void Keep() {
        std::vector<MovedCamera>& answer = answers_.emplace_back();
        for (const std::size_t camera : moved_) {
            answer.push_back({camera, turns_[camera].norm()});
            turns_[camera] = Vector3d::Zero();
        }
    }

    const std::vector<PairTurn>& pairs_;
    const double limit_rad_;
    std::vector<Vector3d> turns_;
    std::vector<std::size_t> moved_{};
    std::vector<std::vector<MovedCamera>> answers_{};
};

}  // namespace

std::vector<std::vector<MovedCamera>> ExplainByMoves(std::size_t cameras,
                                                     const std::vector<PairTurn>& pairs,
                                                     double limit_rad) {
    Explanation explanation(cameras, pairs, limit_rad);
    for (std::size_t count = 0; count <= std::min(kMostMoved, cameras); ++count) {
        auto answers = explanation.WithCount(count);
        if (!answers.empty()) return answers;
    }
    return {};
}

}  // namespace hitchview::calib

#include "calib/far_consensus.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "calib/far_matches.hpp"
#include "calib/reprojection_error.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Rays of a match that is explained are nearer to each other: about 2.5 px of a 120-degree camera.
constexpr double kAgree_rad = 0.004;
constexpr double kLargestTurn_rad = 0.06;
constexpr std::size_t kFewest = 8;
constexpr std::size_t kPart = 4;  // of all that must agree

/// Directions of a match in the unit frame.
struct RayPair {
    Vector3d first;
    Vector3d second;
};

/// Largest set of pairs that one turn of the second rays explains.
class Consensus {
 public:
    Consensus(const std::vector<RayPair>& pairs, const Vector3d& baseline_m)
        : pairs_(pairs), baseline_m_(baseline_m) {}

    /// Indices.
    [[nodiscard]] std::vector<std::size_t> Find() const {
        constexpr std::size_t kMostTurns = 600;
        std::vector<std::size_t> best;
        std::size_t turns = 0;
        // Partners far apart in the list first: they are far apart in the picture.
        for (std::size_t gap = pairs_.size() / 2; gap > 0; --gap) {
            for (std::size_t i = 0; i + gap < pairs_.size() && turns < kMostTurns; ++i, ++turns)
                Try(i, i + gap, best);
        }
        return best;
    }

 private:
    void Try(std::size_t i, std::size_t j, std::vector<std::size_t>& best) const {
        const auto turn = TurnOf(pairs_[i], pairs_[j]);
        if (!turn) return;
        std::vector<std::size_t> agreeing;
        for (std::size_t k = 0; k < pairs_.size(); ++k)
            if (Agrees(*turn, pairs_[k])) agreeing.push_back(k);
        if (agreeing.size() > best.size()) best = std::move(agreeing);
    }

    /// By small angles: second + turn x second = first, for two pairs.
    static std::optional<Matrix3d> TurnOf(const RayPair& one, const RayPair& other) {
        Matrix3d normal = Matrix3d::Zero();
        Vector3d right = Vector3d::Zero();
        for (const RayPair* pair : {&one, &other}) {
            Matrix3d cross;
            const Vector3d& q = pair->second;
            cross << 0, q.z(), -q.y(), -q.z(), 0, q.x(), q.y(), -q.x(), 0;  // turn x q = cross turn
            normal += cross.transpose() * cross;
            right += cross.transpose() * (pair->first - q);
        }
        constexpr double kLeastDeterminant = 1e-4;
        if (normal.determinant() < kLeastDeterminant) return std::nullopt;
        const Vector3d turn = normal.inverse() * right;
        if (!(turn.norm() < kLargestTurn_rad)) return std::nullopt;
        return Rotation(turn);
    }

    [[nodiscard]] bool Agrees(const Matrix3d& turn, const RayPair& pair) const {
        return AngleAtBestDistance(pair.first, turn * pair.second, baseline_m_).angle_rad <
               kAgree_rad;
    }

    const std::vector<RayPair>& pairs_;
    const Vector3d baseline_m_;
};

}  // namespace

std::vector<FarMatch> AgreeingMatches(const std::vector<FarMatch>& matches,
                                      const std::vector<UnitCamera>& cameras,
                                      std::span<const Isometry3d> T_unit_camera) {
    std::vector<RayPair> pairs;
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < matches.size(); ++i) {
        const FarMatch& match = matches[i];
        const auto first = cameras[match.first].model.Unproject(match.first_px);
        const auto second = cameras[match.second].model.Unproject(match.second_px);
        if (!first || !second) continue;
        pairs.push_back({T_unit_camera[match.first].linear() * *first,
                         T_unit_camera[match.second].linear() * *second});
        indices.push_back(i);
    }
    if (pairs.empty()) return {};
    const Vector3d baseline_m = T_unit_camera[matches[0].first].translation() -
                                T_unit_camera[matches[0].second].translation();
    const std::vector<std::size_t> best = Consensus(pairs, baseline_m).Find();
    if (best.size() < std::max(kFewest, pairs.size() / kPart)) return {};
    std::vector<FarMatch> agreeing;
    for (const std::size_t i : best) agreeing.push_back(matches[indices[i]]);
    return agreeing;
}

}  // namespace hitchview::calib

#pragma once

#include <variant>

#include "algo/paper_weights_smoother.hpp"
#include "algo/path_smoother.hpp"

namespace hitchview::algo {

/// PaperWeightsSmoother behind the window of PathSmoother: keeps the older outputs itself. Of the
/// walls it knows only that it must not go beyond: its offset is cut there.
class WalledPaperWeights {
 public:
    /// Of `options`: lookahead_frames, wall and turn_takes_px.
    explicit WalledPaperWeights(const PathSmootherOptions& options,
                                const ProfileSmoothingOptions& weights = {});

    /// The offset S_t. Frames for which this is not called are left out of the window.
    Eigen::Vector3d Next(const PathSmoother::Window& window);
    void Reset() { history_.Reset(); }

 private:
    [[nodiscard]] Eigen::Vector3d Cut(const Eigen::Vector3d& offset) const;

    PathSmootherOptions options_;
    PaperWeightsSmoother smoother_;
    OutputHistory history_;
    Eigen::Vector3d emitted_ = Eigen::Vector3d::Zero();
};

/// The smoother of a unit's path; which one is chosen once. Takes no memory after construction.
class UnitSmoother {
 public:
    using AnySmoother = std::variant<PathSmoother, WalledPaperWeights>;

    explicit UnitSmoother(AnySmoother smoother) : smoother_(std::move(smoother)) {}

    Eigen::Vector3d Next(const PathSmoother::Window& window) {
        return std::visit([&](auto& smoother) { return smoother.Next(window); }, smoother_);
    }
    void Reset() {
        std::visit([](auto& smoother) { smoother.Reset(); }, smoother_);
    }

 private:
    AnySmoother smoother_;
};

}  // namespace hitchview::algo

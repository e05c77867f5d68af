#pragma once

#include <cstddef>

namespace hitchview::app {

struct JpegQualityGovernorOptions {
    int budget_bytes = 150'000;  ///< most a picture may have. [20000, 8388608]
    int highest_quality = 85;    ///< used while pictures are small enough. [30, 95]
};

/// Chooses the JPEG quality so that pictures stay within a byte budget: down at once, up slowly.
class JpegQualityGovernor {
 public:
    static constexpr int kLowestQuality = 30;
    static constexpr int kHighestQuality = 95;

    explicit JpegQualityGovernor(const JpegQualityGovernorOptions& options);

    /// For the next picture. [30, highest_quality]
    [[nodiscard]] int quality() const { return quality_; }
    [[nodiscard]] bool IsWithinBudget(std::size_t bytes) const { return bytes <= budget_bytes_; }

    /// A picture compressed with quality() had this size. Beyond the budget: the quality falls to
    /// where the same picture is expected to fit. Well below it 30 times in a row: it rises by one.
    void Note(std::size_t bytes);

 private:
    void Lower(std::size_t bytes);
    void MaybeRaise();

    std::size_t budget_bytes_;
    int highest_quality_;
    int quality_;
    int calm_pictures_ = 0;
};

}  // namespace hitchview::app

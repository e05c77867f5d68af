#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "algo/task_runner.hpp"
#include "app/frame_set.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview::app {

/// A few frame sets of the simulated rig in memory, as cameras would deliver them: shown forwards,
/// backwards and so on, without an end and without a jump.
class BenchFrames final : private hal::FrameOwner {
 public:
    static constexpr int kSets = 10;

    /// `format`: kNv12, kUyvy or kYuyv. `cache`: as ScenarioFrames has it.
    BenchFrames(const drivers::SimulatedRig& rig, int cameras, hal::PixelFormat format,
                const std::filesystem::path& cache, algo::TaskRunner& runner);

    /// Set number `index` >= 0, said to be captured at `at`. Must not outlive this.
    FrameSet Set(int index, hal::Instant at);
    [[nodiscard]] std::size_t BytesPerSet() const;
    /// The bytes of all pictures of set 0..kSets - 1, one after another.
    void CopySet(int set, std::span<std::uint8_t> to) const;

 private:
    void DoReturn(int /*slot*/) override {}
    void Keep(const FrameSet& set, const drivers::SimulatedRig& rig, int cameras);

    struct Picture {
        algo::Unit unit;
        std::size_t camera;  ///< of the unit
        std::vector<std::uint8_t> bytes;
    };
    hal::FrameFormat format_;
    std::vector<std::vector<Picture>> sets_;
};

}  // namespace hitchview::app

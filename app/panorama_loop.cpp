#include "app/panorama_loop.hpp"

#include <utility>

#include "app/playback_speed.hpp"

namespace hitchview::app {
namespace {

/// From READY on, which is its construction, memory is watched; until its destruction at most.
class MemoryWatch {
 public:
    explicit MemoryWatch(bool trap) : at_ready_(ReadResources()) {
        StartCountingHeapCalls(trap ? OnHeapCall::kTrap : OnHeapCall::kCount);
    }
    ~MemoryWatch() { StopCountingHeapCalls(); }
    MemoryWatch(const MemoryWatch&) = delete;
    MemoryWatch& operator=(const MemoryWatch&) = delete;

    /// Ends the watch.
    MemorySummary Finish() {
        StopCountingHeapCalls();
        return {CountHeapCalls(), at_ready_, ReadResources()};
    }

 private:
    Resources at_ready_;
};

}  // namespace

std::string CameraFailure(hal::Error error) {
    return std::string("a camera gives no more frames: ") + hal::ToString(error);
}

PanoramaLoop::PanoramaLoop(const Parts& parts, const RunOptions& options, RunSummary& summary)
    : parts_(parts),
      options_(options),
      summary_(summary),
      deadlines_(parts.board.clock().Now(), AtSpeed(parts.board.period(), options.speed)) {}

hal::Checked<hal::Done> PanoramaLoop::Run(const std::atomic<bool>& stop, const ShownHook& hook) {
    const hal::Instant ready = deadlines_.start();
    // Live cameras stamp their frames by the clock, recordings from their start.
    LiveFrameSynchronizer* const live = parts_.board.live();
    if (live != nullptr) live->StartCounting();
    parts_.outputs.Start(live != nullptr ? hal::Instant{} : ready);
    MemoryWatch memory(options_.trap_alloc);
    auto done = ShowSets(stop, hook);
    if (done) done = ShowHeldBack(hook);
    summary_.memory = memory.Finish();
    summary_.times = parts_.pipeline.times();
    summary_.duration_s = std::chrono::duration<double>(parts_.board.clock().Now() - ready).count();
    return done;
}

hal::Checked<hal::Done> PanoramaLoop::ShowSets(const std::atomic<bool>& stop,
                                               const ShownHook& hook) {
    for (std::uint64_t taken = 0; !stop && !Limited(taken); ++taken) {
        const hal::Instant asked = parts_.board.clock().Now();
        auto set = parts_.board.sets().WaitSet();
        if (!set && set.error() == hal::Error::kEndOfStream) break;
        if (!set) return CameraFailure(set.error());
        if (parts_.board.live() != nullptr) {
            CatchUp();
        } else if (options_.realtime && !WaitForTurn(set->sequence, asked)) {
            continue;
        }
        const ShownPanorama* const shown = parts_.pipeline.Process(std::move(*set));
        CountDeadline();
        if (shown == nullptr) continue;
        if (const auto done = Show(*shown, hook); !done) return done;
    }
    return hal::Done{};
}

hal::Checked<hal::Done> PanoramaLoop::ShowHeldBack(const ShownHook& hook) {
    while (const ShownPanorama* const shown = parts_.pipeline.Flush()) {
        if (const auto done = Show(*shown, hook); !done) return done;
    }
    return hal::Done{};
}

/// False when the set's turn is over: it is dropped.
bool PanoramaLoop::WaitForTurn(std::uint32_t sequence, hal::Instant asked) {
    hal::Clock& clock = parts_.board.clock();
    const FrameDeadlines::Turn turn = deadlines_.Judge(sequence, asked, clock.Now());
    summary_.dropped = deadlines_.dropped();
    if (turn.slipped) parts_.outputs.Start(deadlines_.start());
    if (turn.dropped) return false;
    if (turn.hurried && parts_.motion.LightenNextStep()) ++summary_.lightened;
    clock.SleepUntil(turn.due);
    return true;
}

/// Live cameras do not wait: what was missed meanwhile is gone, and this set should take less.
void PanoramaLoop::CatchUp() {
    const std::uint64_t skipped = parts_.board.live()->counts().skipped;
    const bool hurried = skipped > summary_.dropped;
    summary_.dropped = skipped;
    if (hurried && parts_.motion.LightenNextStep()) ++summary_.lightened;
}

void PanoramaLoop::CountDeadline() {
    summary_.newest_total_ms =
        parts_.pipeline.times()[static_cast<std::size_t>(Stage::kTotal)].last_ms();
    deadlines_.Add(std::chrono::duration_cast<hal::Instant>(
        std::chrono::duration<double, std::milli>(summary_.newest_total_ms)));
    summary_.deadline_misses = deadlines_.misses();
}

bool PanoramaLoop::Limited(std::uint64_t taken) const {
    if (options_.frames && taken >= static_cast<std::uint64_t>(*options_.frames)) return true;
    if (!options_.duration) return false;
    Board& board = parts_.board;
    const hal::Instant done = board.live() != nullptr
                                  ? board.clock().Now() - deadlines_.start()
                                  : static_cast<std::int64_t>(taken) * board.period();
    // A period that is written in milliseconds is rounded.
    return done + board.period() / 2 > *options_.duration;
}

hal::Checked<hal::Done> PanoramaLoop::Show(const ShownPanorama& shown, const ShownHook& hook) {
    ++summary_.frames;
    for (const algo::Overlap overlap : algo::kOverlaps) {
        if (shown.composition->seams[overlap] == algo::SeamState::kLocked)
            ++summary_.locked_frames[overlap];
    }
    if (const auto& known = shown.composition->articulation) summary_.articulation.Add(*known);
    if (options_.offline && options_.progress) options_.progress("shown", summary_.frames);
    const auto done = parts_.outputs.Show(shown, parts_.pipeline, summary_);
    if (done && hook) hook(shown, parts_.pipeline);
    return done;
}

}  // namespace hitchview::app

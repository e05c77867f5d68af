#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "hal/can_bus.hpp"

namespace hitchview::drivers {

/// Plays a text log as `candump -L` (can-utils) writes it, one frame per line:
///
///     (1700000000.123456) can0 457#0011223344556677      3 hex digits: standard id, to 7FF
///     (1700000000.124456) can0 18FF7A27#00FF             8 hex digits: extended id, to 1FFFFFFF
///     (1700000000.125456) can0 457##1001122334455667788990011   FD: one digit of flags, then data
///     (1700000000.126456) can0 457#R8                    remote frame
///     (1700000000.127456) can0 20000004#0000000000000000 error frame
///
/// Remote and error frames are counted, and delivered only to those who ask for the whole log.
///
/// Times have 6 or 9 decimals (-N); ` R` or ` T` may end a line (-x). All lines are of one
/// interface. The clock of the log may step back, the frames keep their order.
///
/// It does not pace: WaitFrame answers at once, with a frame or kEndOfStream. The text stays in
/// memory, which is taken once by Open; WaitFrame takes none.
class CandumpCanBus final : public hal::CanBus {
 public:
    static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

    /// Frames that are delivered.
    enum class Kinds { kData, kAll };

    /// Frames in the whole log.
    struct LogCounts {
        std::uint64_t data = 0;
        std::uint64_t remote = 0;
        std::uint64_t error = 0;
    };

    /// Reads and checks the whole file, at most kMaxBytes. The first line is received at `start`,
    /// the others as long after it as the log says. An empty file is a silent bus.
    /// The error reads `file:line: what is wrong`.
    static hal::Checked<std::unique_ptr<CandumpCanBus>> Open(const std::filesystem::path& file,
                                                             hal::Instant start,
                                                             Kinds kinds = Kinds::kData);

    /// The same of a file's content. `name`: what the error calls the file.
    static hal::Checked<std::unique_ptr<CandumpCanBus>> Parse(std::string text,
                                                              const std::string& name,
                                                              hal::Instant start,
                                                              Kinds kinds = Kinds::kData);

    /// Constant; any thread.
    [[nodiscard]] const LogCounts& log_counts() const { return log_counts_; }

 private:
    CandumpCanBus(std::string text, Kinds kinds)
        : text_(std::move(text)), rest_(text_), kinds_(kinds) {}

    hal::Checked<hal::Done> Check(const std::string& file, hal::Instant start);
    hal::Result<hal::CanFrame> DoWaitFrame(std::chrono::milliseconds timeout) override;
    /// `errors`: in the whole log.
    [[nodiscard]] hal::CanCounts DoCounts() const override;

    std::string text_;
    std::string_view rest_;       // what has not been delivered yet
    hal::Instant log_to_ours_{};  // added to the times of the log
    Kinds kinds_;
    LogCounts log_counts_;
    std::atomic<std::uint64_t> delivered_{0};
};

}  // namespace hitchview::drivers

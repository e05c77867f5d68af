#pragma once

#include <memory>
#include <string_view>
#include <utility>

#include "drivers/systemd_socket.hpp"
#include "hal/event_log.hpp"

namespace hitchview::drivers {

/// Events as entries of systemd's journal, by its native protocol, with fields of their own: see
/// docs/lcm.md. Takes no memory.
class SystemdJournal final : public hal::EventLog {
 public:
    static constexpr const char* kSocket = "/run/systemd/journal/socket";

    /// Null where this program does not write to the journal: `stream` is null, or nobody listens
    /// on `socket`. `stream` is what the environment variable JOURNAL_STREAM says: device and inode
    /// of the file that is the journal's.
    static std::unique_ptr<hal::EventLog> Open(const char* stream, const char* socket = kSocket);

 private:
    SystemdJournal(SystemdSocket socket, bool has_stderr)
        : socket_(std::move(socket)), has_stderr_(has_stderr) {}

    void DoAdd(const hal::Event& event) override;
    [[nodiscard]] bool DoHasStderr() const override { return has_stderr_; }

    SystemdSocket socket_;
    bool has_stderr_;
};

}  // namespace hitchview::drivers

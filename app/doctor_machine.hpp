#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/camera_device.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// Who may open what.
struct UserIds {
    uid_t user = 0;
    std::vector<gid_t> groups{};
};

/// A CAN interface as the kernel tells of it.
struct CanLinkFacts {
    enum class State { kUntold, kOnBus, kErrors, kBusOff, kOffBus };

    bool is_can = false;
    bool is_up = false;
    bool has_bit_rate =
        false;  ///< of its own: not a virtual one, nor one whose driver does not tell
    std::uint32_t bit_rate = 0;  ///< 0: not set
    State state = State::kUntold;
    std::uint32_t restart_ms = 0;
};

/// Receive buffers that the kernel gives to sockets.
struct SocketBufferFacts {
    int usual_bytes = 0;
    int largest_bytes = 0;
};

/// What came on a channel.
struct HeardFacts {
    int messages = 0;
    std::chrono::milliseconds within{};
};

/// Everything that the checks learn of a machine goes through here, so that a test may stand in
/// for one. Nothing of it changes anything; each returns within 2 s. Threads: any.
struct DoctorMachine {
    /// What stands below it: /dev, /etc, /opt, /proc, /run, /sys, /usr, /var.
    std::filesystem::path root = "/";

    std::function<std::chrono::system_clock::time_point()> now{};
    /// Whether the kernel's clock follows a reference; empty: not told.
    std::function<std::optional<bool>()> is_clock_synchronised{};
    /// What a program (absolute path first) wrote; empty: it is not there, or failed.
    std::function<std::optional<std::string>(const std::vector<std::string>& command)> output{};
    /// Empty name: the user who asks. Empty: there is no such user.
    std::function<std::optional<UserIds>(const std::string& name)> user{};
    std::function<std::optional<gid_t>(const std::string& name)> group{};
    /// Every video device that captures.
    std::function<std::vector<CameraDevice>(const std::vector<CameraWish>& wishes)> cameras{};
    std::function<hal::Checked<CanLinkFacts>(const std::string& interface)> can_link{};
    std::function<std::optional<SocketBufferFacts>()> socket_buffers{};
    /// Address from which is sent what goes to LCM's group, or errno.
    std::function<hal::Result<std::string, int>()> multicast_source{};
    /// Flags of lo (IFF_UP, ...); empty: it cannot be asked.
    std::function<std::optional<short>()> loopback_flags{};
    /// A message of so many bytes to oneself.
    std::function<hal::Checked<hal::Done>(const std::string& url, int bytes)> send_to_self{};
    /// Messages of a channel until there are some, or time is up.
    std::function<hal::Checked<HeardFacts>(const std::string& url, const std::string& channel)>
        hear{};
    /// What this process may do: a SCHED_FIFO priority; all its memory locked.
    std::function<hal::Checked<hal::Done>(int priority)> take_priority{};
    std::function<hal::Checked<hal::Done>()> lock_memory{};

    /// Where a path of the machine stands.
    [[nodiscard]] std::filesystem::path At(const std::filesystem::path& path) const;
};

/// This one.
DoctorMachine ThisMachine();

/// The start of a small text file without the white space at its end; empty: there is no such
/// ordinary file, or it may not be read. Never blocks.
std::optional<std::string> ReadText(const std::filesystem::path& file);
/// The same as a number.
std::optional<std::int64_t> ReadNumber(const std::filesystem::path& file);

/// Whether `ids` may have `access` (R_OK, W_OK) to a file by its owner, group and mode, on the way
/// down from `root`, which is not looked at itself. False also where something is missing.
bool MayAccess(const UserIds& ids, const std::filesystem::path& root,
               const std::filesystem::path& file, int access);

}  // namespace hitchview::app

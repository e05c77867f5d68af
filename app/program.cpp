#include "app/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>

extern char** environ;

namespace hitchview::app {
namespace {

constexpr int kMachineFailed = 3;

/// A program's path and arguments as the kernel takes them.
class CommandLine {
 public:
    CommandLine(const std::filesystem::path& program, const std::vector<std::string>& arguments)
        : texts_{program.string()} {
        texts_.insert(texts_.end(), arguments.begin(), arguments.end());
        for (std::string& text : texts_) argv_.push_back(text.data());
        argv_.push_back(nullptr);
    }

    [[nodiscard]] const char* path() const { return texts_.front().c_str(); }
    [[nodiscard]] char* const* argv() const { return argv_.data(); }

 private:
    std::vector<std::string> texts_;
    std::vector<char*> argv_{};
};

/// The process, or -1.
int Start(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
    const CommandLine command(program, arguments);
    pid_t process = -1;
    if (posix_spawn(&process, command.path(), nullptr, nullptr, command.argv(), environ) != 0)
        return -1;
    return process;
}

using Moment = std::chrono::steady_clock::time_point;

int MillisecondsLeft(Moment end) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Moment::clock::now());
    return static_cast<int>(std::max<std::int64_t>(0, left.count()));
}

/// Of a process group of its own that writes to `output` and reads nothing; -1: not started.
int StartTo(int output, const CommandLine& command) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t process = -1;
    const int refused =
        posix_spawn(&process, command.path(), &files, &attributes, command.argv(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return refused == 0 ? process : -1;
}

/// Up to the end of what is written, the moment or the limit of bytes.
std::string ReadUntil(Moment end, int input) {
    constexpr std::size_t kMostBytes = 64 << 10;
    std::string text;
    std::array<char, 4096> part{};
    pollfd readable{.fd = input, .events = POLLIN, .revents = 0};
    while (text.size() < kMostBytes && poll(&readable, 1, MillisecondsLeft(end)) > 0) {
        const ssize_t bytes = read(input, part.data(), part.size());
        if (bytes <= 0) break;
        text.append(part.data(), static_cast<std::size_t>(bytes));
    }
    text.resize(std::min(text.size(), kMostBytes));
    return text;
}

/// Whether it ended well before the moment. Afterwards it has ended in any case.
bool EndedWell(int process, Moment end) {
    int status = 0;
    pid_t ended = 0;
    while ((ended = waitpid(process, &status, WNOHANG)) == 0 && MillisecondsLeft(end) > 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (ended == 0) {
        kill(-process, SIGKILL);
        waitpid(process, nullptr, 0);
    }
    return ended == process && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

std::filesystem::path SiblingProgram(const std::string& name) {
    std::error_code failed;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
    return failed ? std::filesystem::path(name) : self.parent_path() / name;
}

int RunProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
    const int process = Start(program, arguments);
    if (process < 0) return kMachineFailed;
    int status = 0;
    while (waitpid(process, &status, 0) < 0) {
        if (errno != EINTR) return kMachineFailed;
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : kMachineFailed;
}

int BecomeProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
    const CommandLine command(program, arguments);
    execv(command.path(), command.argv());
    return kMachineFailed;
}

std::optional<std::string> OutputOf(const std::filesystem::path& program,
                                    const std::vector<std::string>& arguments,
                                    std::chrono::milliseconds limit) {
    const Moment end = Moment::clock::now() + limit;
    std::array<int, 2> pipe{};
    if (pipe2(pipe.data(), O_CLOEXEC) != 0) return std::nullopt;
    const int process = StartTo(pipe[1], CommandLine(program, arguments));
    close(pipe[1]);
    std::string text = process < 0 ? "" : ReadUntil(end, pipe[0]);
    close(pipe[0]);
    if (process < 0 || !EndedWell(process, end)) return std::nullopt;
    return text;
}

BackgroundProgram::BackgroundProgram(const std::filesystem::path& program,
                                     const std::vector<std::string>& arguments)
    : process_(Start(program, arguments)) {}

BackgroundProgram::~BackgroundProgram() {
    if (process_ < 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
}

}  // namespace hitchview::app

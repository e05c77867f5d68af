#include "app/program.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <system_error>

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

BackgroundProgram::BackgroundProgram(const std::filesystem::path& program,
                                     const std::vector<std::string>& arguments)
    : process_(Start(program, arguments)) {}

BackgroundProgram::~BackgroundProgram() {
    if (process_ < 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
}

}  // namespace hitchview::app

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

/// The process, or -1.
int Start(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
    std::string path = program.string();
    std::vector<std::string> owned(arguments);
    std::vector<char*> argv{path.data()};
    for (std::string& argument : owned) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_t process = -1;
    if (posix_spawn(&process, path.c_str(), nullptr, nullptr, argv.data(), environ) != 0) return -1;
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

BackgroundProgram::BackgroundProgram(const std::filesystem::path& program,
                                     const std::vector<std::string>& arguments)
    : process_(Start(program, arguments)) {}

BackgroundProgram::~BackgroundProgram() {
    if (process_ < 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
}

}  // namespace hitchview::app

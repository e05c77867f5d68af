#pragma once

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "hal/expect.hpp"

namespace hitchview::tests {

/// A program in a process of its own, which signals can be sent to. Killed when the test ends.
class ChildProcess {
 public:
    /// `environment`: NAME=VALUE, beside this process's own.
    ChildProcess(std::string program, std::vector<std::string> arguments,
                 std::vector<std::string> environment = {}) {
        std::vector<char*> argv{program.data()};
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        std::vector<char*> variables;
        for (std::string& variable : environment) variables.push_back(variable.data());
        for (char** own = environ; *own != nullptr; ++own) variables.push_back(*own);
        variables.push_back(nullptr);
        HV_EXPECT(posix_spawn(&process_, program.c_str(), nullptr, nullptr, argv.data(),
                              variables.data()) == 0);
    }
    ~ChildProcess() {
        if (process_ <= 0) return;
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    void Signal(int signal) const { kill(process_, signal); }

    [[nodiscard]] bool HasEnded() const {
        siginfo_t info{};
        return waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) ==
                   0 &&
               info.si_pid == process_;
    }

    /// Its exit code; -1 when a signal ended it.
    int Wait() {
        int status = 0;
        waitpid(process_, &status, 0);
        process_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

 private:
    pid_t process_ = -1;
};

}  // namespace hitchview::tests

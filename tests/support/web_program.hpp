#pragma once

#include <fcntl.h>
#include <lcm/lcm.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "hal/expect.hpp"
#include "tests/support/rig_messages.hpp"

namespace hitchview::tests {

/// `hitchview web` in a process of its own.
class WebProgram {
 public:
    explicit WebProgram(const std::string& program, std::vector<std::string> arguments = {}) {
        std::array<int, 2> ends{};
        HV_EXPECT(pipe2(ends.data(), O_CLOEXEC) == 0);
        std::string verb = "web";
        std::string path = program;
        std::vector<char*> argv{path.data(), verb.data()};
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        process_ = fork();
        if (process_ == 0) {
            dup2(ends[1], STDOUT_FILENO);
            execv(path.c_str(), argv.data());
            _exit(127);
        }
        close(ends[1]);
        output_ = ends[0];
        first_line_ = ReadLine();
    }
    ~WebProgram() {
        if (process_ > 0) {
            kill(process_, SIGKILL);
            waitpid(process_, nullptr, 0);
        }
        close(output_);
    }
    WebProgram(const WebProgram&) = delete;
    WebProgram& operator=(const WebProgram&) = delete;

    [[nodiscard]] const std::string& first_line() const { return first_line_; }

    /// As its first line says; 0 when it says none.
    [[nodiscard]] int port() const {
        const std::string before = "http://127.0.0.1:";
        return first_line_.starts_with(before) ? std::stoi(first_line_.substr(before.size())) : 0;
    }

    /// Resident memory.
    [[nodiscard]] std::size_t RssBytes() const {
        std::ifstream file("/proc/" + std::to_string(process_) + "/statm");
        std::size_t pages = 0;
        file >> pages >> pages;
        return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    }

    [[nodiscard]] bool IsRunning() { return waitpid(process_, nullptr, WNOHANG) == 0; }

    /// Asks it to stop. Its exit code.
    int Stop() {
        kill(process_, SIGTERM);
        return Wait();
    }

    /// Its exit code; -1 when a signal ended it.
    int Wait() {
        int status = 0;
        waitpid(process_, &status, 0);
        process_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

 private:
    std::string ReadLine() const {
        std::string line;
        char letter = 0;
        while (read(output_, &letter, 1) == 1 && letter != '\n') line += letter;
        return line;
    }

    pid_t process_ = -1;
    int output_ = -1;
    std::string first_line_{};
};

/// Sends messages as a rig does.
class RigSender {
 public:
    RigSender() : lcm_(lcm_create("udpm://239.255.76.67:7667?ttl=0")) {
        HV_EXPECT(lcm_ != nullptr);
    }
    ~RigSender() { lcm_destroy(lcm_); }
    RigSender(const RigSender&) = delete;
    RigSender& operator=(const RigSender&) = delete;

    void Send(const std::string& channel, const MessageBytes& message) const {
        lcm_publish(lcm_, channel.c_str(), message.data(), static_cast<unsigned>(message.size()));
    }

 private:
    lcm_t* lcm_;
};

/// A JPEG for who does not decode it.
inline MessageBytes JpegOfSize(std::size_t bytes, std::uint8_t filling) {
    MessageBytes jpeg(bytes, filling);
    jpeg.at(0) = 0xFF;
    jpeg.at(1) = 0xD8;
    return jpeg;
}

/// Sends a panorama, and its status, thirty times a second until it is destroyed.
class PanoramaStream {
 public:
    explicit PanoramaStream(std::size_t jpeg_bytes)
        : thread_([this, jpeg_bytes](const std::stop_token& stop) { Run(stop, jpeg_bytes); }) {}

 private:
    static void Run(const std::stop_token& stop, std::size_t jpeg_bytes) {
        const RigSender rig;
        auto next = std::chrono::steady_clock::now();
        for (std::uint32_t i = 1; !stop.stop_requested(); ++i) {
            const auto jpeg = JpegOfSize(jpeg_bytes, static_cast<std::uint8_t>(i));
            rig.Send("PANORAMA", ImageBytes(jpeg, 2048, 360, i, i));
            rig.Send("PANORAMA_STATUS", StatusBytes(i, i, 0));
            next += std::chrono::microseconds(33'333);
            std::this_thread::sleep_until(next);
        }
    }

    std::jthread thread_;
};

}  // namespace hitchview::tests

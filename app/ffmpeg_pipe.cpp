#include "app/ffmpeg_pipe.hpp"

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "hal/expect.hpp"

extern char** environ;

namespace hitchview::app {
namespace {

using hal::Checked;
using hal::Done;

std::vector<std::string> Arguments(const std::filesystem::path& file,
                                   const FfmpegOptions& options) {
    const std::string size =
        std::to_string(options.size_px.width) + "x" + std::to_string(options.size_px.height);
    // H.264 wants even sides; players take BT.709 for granted.
    const std::string filter =
        "pad=ceil(iw/2)*2:ceil(ih/2)*2,"
        "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd,"
        "format=yuv420p";
    return {options.program, "-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo",
            "-pix_fmt", "bgr24", "-video_size", size, "-framerate", std::to_string(options.rate_hz),
            "-i", "pipe:0", "-an", "-vf", filter, "-c:v", "libx264", "-preset", "veryfast", "-crf",
            "20", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709",
            "-movflags", "+faststart", "-f", "mp4",
            // Not taken for an option or a protocol, whatever it is called.
            "file:" + file.string()};
}

/// 0, or what errno says.
int Spawn(std::vector<std::string> arguments, int input, pid_t& process) {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    // In a group of its own: who stops this program from the terminal still gets a whole video.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int refused =
        posix_spawnp(&process, argv[0], &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return refused;
}

}  // namespace

Checked<std::unique_ptr<FfmpegPipe>> FfmpegPipe::Start(const std::filesystem::path& file,
                                                       const FfmpegOptions& options) {
    // A socket instead of a pipe: only its send can do without the signal when the reader ends.
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        return std::string("socketpair: ") + std::strerror(errno);
    pid_t process = -1;
    const int refused = Spawn(Arguments(file, options), ends[1], process);
    close(ends[1]);
    if (refused == 0) return std::unique_ptr<FfmpegPipe>(new FfmpegPipe(file, process, ends[0]));
    close(ends[0]);
    if (refused != ENOENT) return options.program + ": " + std::strerror(refused);
    return options.program +
           ": not installed, and it makes the video: apt install ffmpeg, or export PNG files with "
           "--frames";
}

FfmpegPipe::~FfmpegPipe() {
    if (socket_ >= 0) (void)Finish();
}

hal::Result<Done> FfmpegPipe::Append(const cv::Mat& picture) {
    HV_EXPECT(picture.type() == CV_8UC3 && picture.isContinuous() && socket_ >= 0);
    const std::uint8_t* next = picture.data;
    std::size_t rest = picture.total() * picture.elemSize();
    while (rest > 0) {
        const ssize_t sent = send(socket_, next, rest, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0) return hal::Error::kFailed;
        next += sent;
        rest -= static_cast<std::size_t>(sent);
    }
    return Done{};
}

Checked<Done> FfmpegPipe::Finish() {
    close(std::exchange(socket_, -1));
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return Done{};
    return file_.string() + ": ffmpeg could not make it";
}

}  // namespace hitchview::app

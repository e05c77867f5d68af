#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <poll.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/recorded_events.hpp"
#include "tests/support/small_drive.hpp"

// The program while it records. Runs in a network namespace of its own
// (tests/support/lcm_namespace.sh).
namespace hitchview::app {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;
using tests::TemporaryFolder;

constexpr int kFrames = 210;

/// A program that runs beside the test.
class Child {
 public:
    explicit Child(const std::string& command) : process_(fork()) {
        if (process_ == 0) {
            execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
            _exit(127);
        }
    }
    ~Child() {
        if (process_ > 0) kill(process_, SIGKILL);
        Wait();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    [[nodiscard]] pid_t process() const { return process_; }
    /// Its exit code.
    int Wait() {
        int status = -1;
        if (process_ > 0) waitpid(process_, &status, 0);
        process_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    [[nodiscard]] bool IsRunning() {
        int status = 0;
        if (process_ > 0 && waitpid(process_, &status, WNOHANG) == 0) return true;
        process_ = -1;
        return false;
    }

 private:
    pid_t process_;
};

json ReportIn(const std::filesystem::path& folder) {
    return json::parse(tests::FileText(folder / "report.json"));
}

void ExpectNoHeapCalls(const json& report) {
    if (!tests::kHeapCallsAreCounted) return;
    EXPECT_EQ(report.at("heap_calls_after_ready"), 0) << report.at("heap_calls_by_thread");
}

/// One second of the simulated vehicle.
class RecordSimTest : public testing::Test {
 protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        std::vector<std::string> arguments{"record", "--board",        "sim",
                                           "--out",  folder_->path(),  "--seconds",
                                           "1",      "--camera-width", "320"};
        if (tests::kHeapCallsAreCounted) arguments.emplace_back("--trap-alloc");
        ASSERT_EQ(RunProgram(HITCHVIEW, arguments), 0);
        for (const auto& event : tests::RecordedEvents(folder_->path())) ++channels_[event.channel];
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::unique_ptr<TemporaryFolder> folder_;
    static std::map<std::string, int> channels_;  ///< messages on each
};

std::unique_ptr<TemporaryFolder> RecordSimTest::folder_;
std::map<std::string, int> RecordSimTest::channels_;

TEST_F(RecordSimTest, ItIsAGoodRecordingOfEverything) {
    EXPECT_EQ(RunProgram(HITCHVIEW, {"check", folder_->path()}), 0);
    const json report = ReportIn(folder_->path());
    ExpectNoHeapCalls(report);
    EXPECT_EQ(report.at("recording").at("dropped"), 0);
    EXPECT_EQ(channels_["RIG"], 1);
    EXPECT_EQ(channels_["CLOCK"], 1);
    EXPECT_EQ(channels_["CAM_FRONT"], 30);
    EXPECT_EQ(channels_["CAM_RIGHT_REAR"], 30);
    EXPECT_EQ(channels_["PANORAMA"], 30);
    EXPECT_EQ(channels_["PANORAMA_STATUS"], 30);
    EXPECT_EQ(channels_["PANORAMA_EVENT"], 2);
    EXPECT_EQ(channels_["CAN_RX"], channels_["HITCH_ANGLE"]);
    EXPECT_GE(channels_["CAN_RX"], 48);
}

TEST_F(RecordSimTest, TheStockPlayerSendsEveryMessage) {
    if (std::string(LCM_LOGPLAYER).find('/') == std::string::npos)
        GTEST_SKIP() << "lcm-logplayer is not installed";
    lcm_t* const lcm = lcm_create("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=8388608");
    ASSERT_NE(lcm, nullptr);
    std::map<std::string, int> received;
    const auto count = [](const lcm_recv_buf_t*, const char* channel, void* counts) {
        ++(*static_cast<std::map<std::string, int>*>(counts))[channel];
    };
    lcm_subscription_t* const all = lcm_subscribe(lcm, ".*", count, &received);
    lcm_subscription_set_queue_capacity(all, 2000);
    Child player(std::string(LCM_LOGPLAYER) + " --speed=0.5 " +
                 tests::Segments(folder_->path()).front().string());
    while (lcm_handle_timeout(lcm, 300) > 0 || player.IsRunning()) {
    }
    lcm_destroy(lcm);
    // A busy machine may lose a message.
    for (const auto& [channel, messages] : channels_) {
        EXPECT_LE(received[channel], messages) << channel;
        EXPECT_GE(received[channel], messages - 2) << channel;
    }
}

/// Runs at the pace of the cameras, with raw frames: some 20 MB a second.
class RecordRunTest : public testing::Test {
 protected:
    static void SetUpTestSuite() {
        drive_ = std::make_unique<TemporaryFolder>();
        tests::RecordSmallDrive(*drive_, 12, kFrames);
    }
    static void TearDownTestSuite() { drive_.reset(); }

    /// The command that runs and records into `folder`.
    static std::string Run(const std::string& folder, const std::string& more) {
        const std::string rig = tests::SmallDriveRig(
            *drive_, "{projection: cylinder, size_px: [1024, 180]}",
            "record: {folder: " + folder + ", format: raw, min_free_mb: 0, " + more + "}\n");
        return std::string(HITCHVIEW) + " run --rig " + rig + " --out " + (*drive_ / "out");
    }
    static json Report() { return ReportIn(*drive_ / "out"); }

    static void ExpectPanoramasWentOn(const json& report) {
        const int frames = report.at("frames");
        // Panoramas that were made and not sent in time are dropped, too.
        EXPECT_GE(frames + report.at("dropped").get<int>(), kFrames);
        EXPECT_GT(frames, kFrames / 3);  // a busy machine makes fewer
        ExpectNoHeapCalls(report);
    }

    static std::unique_ptr<TemporaryFolder> drive_;
};

std::unique_ptr<TemporaryFolder> RecordRunTest::drive_;

/// Number of the thread of this name; 0: none.
pid_t ThreadOf(pid_t process, const std::string& name) {
    std::error_code gone;
    const std::filesystem::path tasks = "/proc/" + std::to_string(process) + "/task";
    for (const auto& task : std::filesystem::directory_iterator(tasks, gone))
        if (tests::FileText(task.path() / "comm") == name + "\n")
            return std::stoi(task.path().filename());
    return 0;
}

TEST_F(RecordRunTest, AWriterThatStandsStillCostsMessagesAndNoPanorama) {
    const TemporaryFolder folder;
    Child program(Run(folder.path(), "memory_mb: 8"));
    while (program.IsRunning() && tests::Segments(folder.path()).empty())
        std::this_thread::sleep_for(milliseconds(20));
    const pid_t writer = ThreadOf(program.process(), "record");
    ASSERT_NE(writer, 0);
    if (ptrace(PTRACE_SEIZE, writer, nullptr, nullptr) != 0)
        GTEST_SKIP() << "threads of other programs cannot be stopped here";
    ptrace(PTRACE_INTERRUPT, writer, nullptr, nullptr);
    waitpid(writer, nullptr, __WALL);
    std::this_thread::sleep_for(seconds(2));
    ptrace(PTRACE_DETACH, writer, nullptr, nullptr);
    ASSERT_EQ(program.Wait(), 0);

    const json report = Report();
    ExpectPanoramasWentOn(report);
    EXPECT_GT(report.at("recording").at("dropped"), 50);
    EXPECT_GE(report.at("events").at("recording_dropped"), 1);
    EXPECT_EQ(report.at("events").at("recording_failed"), 0);
    const auto events = tests::RecordedEvents(folder.path());
    EXPECT_EQ(events.size(), report.at("recording").at("events"));
}

/// How a command gets a mount table of its own; empty where it cannot.
std::string OwnMounts() {
    for (const std::string unshare : {"unshare --mount ", "unshare --map-root-user --mount "})
        if (std::system((unshare + "mount -t tmpfs none /mnt 2> /dev/null").c_str()) == 0)
            return unshare;
    return "";
}

TEST_F(RecordRunTest, AFullDiskStopsTheRecordingUntilThereIsSpaceAndNoPanorama) {
    const std::string own_mounts = OwnMounts();
    if (own_mounts.empty()) GTEST_SKIP() << "file systems cannot be mounted here";
    const TemporaryFolder folder;
    const std::string disk = folder / "disk";
    std::filesystem::create_directory(disk);
    const std::string script = folder.Write(
        "fill.sh", "set -e\nmount -t tmpfs -o size=14m none " + disk + "\nhead -c 8M /dev/zero > " +
                       disk + "/ballast\n(until [ $(df --output=avail -k " + disk +
                       " | tail -1) -lt 300 ]; do sleep .05; done; sleep .5; rm " + disk +
                       "/ballast) &\n" + Run(disk, "segment_s: 3600") + "\ncp " + disk + "/*.lcm " +
                       folder.path() + "\n");
    ASSERT_EQ(std::system((own_mounts + "sh " + script).c_str()), 0);

    const json report = Report();
    ExpectPanoramasWentOn(report);
    EXPECT_GE(report.at("events").at("recording_failed"), 1);
    EXPECT_GE(report.at("events").at("recording_started"), 2);
    EXPECT_GE(report.at("recording").at("files"), 2);
    bool has_rig = true;
    std::string last;
    for (const auto& event : tests::RecordedEvents(folder.path())) {
        has_rig = has_rig && (event.file == last || event.channel == "RIG");
        last = event.file;
    }
    EXPECT_TRUE(has_rig);
}

TEST_F(RecordRunTest, ASignalWritesWhatWasKept) {
    const TemporaryFolder folder;
    Child program(Run(folder.path(), "pre_trigger_s: 1"));
    while (program.IsRunning() && ThreadOf(program.process(), "record") == 0)
        std::this_thread::sleep_for(milliseconds(20));
    std::this_thread::sleep_for(seconds(4));
    EXPECT_TRUE(tests::Segments(folder.path()).empty());
    ASSERT_TRUE(program.IsRunning());
    kill(program.process(), SIGUSR1);
    ASSERT_EQ(program.Wait(), 0);
    ExpectPanoramasWentOn(Report());
    EXPECT_FALSE(tests::RecordedEvents(folder.path()).empty());
}

}  // namespace
}  // namespace hitchview::app

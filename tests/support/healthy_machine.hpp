#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <sys/stat.h>
#include <unistd.h>

#include <iomanip>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "app/doctor_answers.hpp"
#include "app/doctor_verb.hpp"
#include "calib/rig_calibration.hpp"
#include "drivers/simulated_rig.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::tests {

/// A vehicle's computer on which everything is as it should be: a tree of its files, and answers of
/// its kernel and of its systemd. A test breaks one thing.
class HealthyMachine {
 public:
    static constexpr uid_t kServiceUser = 64001;

    HealthyMachine() {
        WriteRig();
        WriteCameras();
        WriteKernel();
        WriteSlots();
        MakeFolder("run/systemd/system");
        MakeFolder("var/lib/hitchview/recordings", 0775);
    }

    [[nodiscard]] std::filesystem::path Path(const std::string& path) const {
        return std::filesystem::path(folder_.path()) / path;
    }
    void MakeFolder(const std::string& path, mode_t mode = 0755) const {
        std::filesystem::create_directories(Path(path));
        chmod(Path(path).c_str(), mode);
        for (auto parent = Path(path).parent_path(); parent != folder_.path();
             parent = parent.parent_path())
            chmod(parent.c_str(), 0755);
    }
    void Write(const std::string& path, const std::string& text, mode_t mode = 0644) const {
        MakeFolder(std::filesystem::path(path).parent_path());
        folder_.Write(path, text);
        chmod(Path(path).c_str(), mode);
    }
    void Remove(const std::string& path) const { std::filesystem::remove_all(Path(path)); }
    void Replace(const std::string& path, const std::string& old,
                 const std::string& text_now) const {
        std::string text = FileText(Path(path));
        const std::size_t place = text.find(old);
        ASSERT_NE(place, std::string::npos) << old;
        Write(path, text.replace(place, old.size(), text_now));
    }

    /// A line of /proc/net/route.
    static std::string RouteLine(const char* interface, const char* to, const char* mask) {
        std::ostringstream line;
        line << std::hex << std::uppercase << std::setfill('0') << interface << '\t' << std::setw(8)
             << inet_addr(to) << "\t00000000\t0001\t0\t0\t100\t" << std::setw(8) << inet_addr(mask)
             << "\t0\t0\t0\n";
        return line.str();
    }

    [[nodiscard]] app::DoctorMachine Machine() {
        return {.root = folder_.path(),
                .now = [this] { return now; },
                .is_clock_synchronised = [] { return true; },
                .output = [this](const auto& command) { return Output(command); },
                .user = [this](const std::string& name) { return User(name); },
                .group = [](const std::string& name) -> std::optional<gid_t> {
                    if (name != "video") return std::nullopt;
                    return getegid();
                },
                .cameras = [devices = cameras](const auto&) { return devices; },
                .can_link = [this](const auto& name) { return CanLink(name); },
                .socket_buffers = [this] { return buffers; },
                .multicast_source = [this] { return multicast_source; },
                .loopback_flags = [this] { return loopback_flags; },
                .send_to_self = [this](const auto&, int) { return Delivered(); },
                .hear = [this](const auto& url, const auto&) { return Heard(url); },
                .take_priority = [](int) { return hal::Checked<hal::Done>(hal::Done{}); },
                .lock_memory = [] { return hal::Checked<hal::Done>(hal::Done{}); }};
    }
    [[nodiscard]] std::vector<app::DoctorAnswer> Answers(const std::string& rig = "") {
        return RunChecks(AllChecks(app::ExamineMachine(Machine(), rig)));
    }
    [[nodiscard]] app::Diagnosis Answer(const std::string& check) {
        for (const app::DoctorAnswer& answer : Answers()) {
            if (answer.name == check) return answer.diagnosis;
        }
        ADD_FAILURE() << "there is no check " << check;
        return {};
    }
    /// Names of the checks that find this, in their order.
    [[nodiscard]] std::vector<std::string> Names(app::Finding finding) {
        std::vector<std::string> names;
        for (const app::DoctorAnswer& answer : Answers()) {
            if (answer.diagnosis.finding == finding) names.push_back(answer.name);
        }
        return names;
    }

    std::map<std::string, std::string> service{
        {"LoadState", "loaded"},      {"UnitFileState", "enabled"},
        {"ActiveState", "active"},    {"SubState", "running"},
        {"Result", "success"},        {"NRestarts", "0"},
        {"User", "hitchview"},        {"SupplementaryGroups", "video"},
        {"AmbientCapabilities", ""},  {"LimitRTPRIO", "50"},
        {"LimitMEMLOCK", "infinity"}, {"MemoryMax", "1073741824"},
        {"ProtectSystem", "strict"},  {"StateDirectory", "hitchview"},
        {"ReadWritePaths", ""}};
    std::map<std::string, std::string> recorder{{"LoadState", "loaded"},
                                                {"ActiveState", "inactive"}};
    std::string failed_units{};
    std::string power_mode = "NV Power Mode: MAXN\n0\n";
    bool user_exists = true;
    std::vector<gid_t> user_groups{getegid()};
    std::chrono::system_clock::time_point now{std::chrono::seconds(1'795'000'000)};
    std::vector<app::CameraDevice> cameras{};
    bool can_exists = true;
    app::CanLinkFacts can{.is_can = true,
                          .is_up = true,
                          .has_bit_rate = true,
                          .bit_rate = 500'000,
                          .state = app::CanLinkFacts::State::kOnBus};
    app::SocketBufferFacts buffers{212'992, 212'992};
    hal::Result<std::string, int> multicast_source = std::string("0.0.0.0");
    short loopback_flags = IFF_UP | IFF_MULTICAST;
    bool firewall = false;
    std::string url_of_service = "udpm://239.255.76.67:7667?ttl=0";

 private:
    void WriteRig() const {
        std::string rig =
            "schema: 1\ncanvas: {projection: cylinder}\ncalibration: rig.calib.yaml\n"
            "can: {source: {socketcan: can0}, hitch_angle: {id: 1111, start_bit: 23, "
            "length_bits: 12, byte_order: motorola, factor_deg: 0.1, offset_deg: -90}}\n"
            "record: {folder: /var/lib/hitchview/recordings, quota_mb: 100, min_free_mb: 1}\n"
            "units:\n";
        calib::RigCalibration calibration{.vehicle = "made", .written_by = "test"};
        for (const algo::Unit unit : algo::kUnits) {
            rig += std::string("  ") + ToString(unit) + ":\n    cameras:\n";
            for (const auto& camera : drivers::SimulatedRigGeometry(1280, 720)) {
                if (camera.unit != unit) continue;
                const std::string name(camera.name);
                rig +=
                    "      - {name: " + name + ", source: {v4l2: /dev/hitchview/" + name + "}}\n";
                calibration.cameras[name] =
                    calib::CalibratedCamera::From(camera.unit, camera.geometry);
            }
        }
        Write("etc/hitchview/rig.yaml", rig);
        EXPECT_EQ(SaveCalibration(calibration, Path("etc/hitchview/rig.calib.yaml")), "");
        chmod(Path("etc/hitchview/rig.calib.yaml").c_str(), 0644);
    }
    void WriteCameras() {
        MakeFolder("dev/hitchview");
        for (const auto& camera : drivers::SimulatedRigGeometry(1280, 720)) {
            const std::string node = "video" + std::to_string(cameras.size());
            Write("dev/" + node, "", 0660);
            std::filesystem::create_symlink("../" + node,
                                            Path("dev/hitchview/" + std::string(camera.name)));
            app::CameraDevice device;
            device.path = Path("dev/" + node);
            device.pick = app::CameraPick{"uyvy", {1280, 720}, 30, false, {}};
            cameras.push_back(device);
        }
    }
    void WriteKernel() const {
        Write("proc/meminfo", "MemTotal: 8000000 kB\nMemFree: 100 kB\nMemAvailable: 6000000 kB\n");
        Write("proc/sys/kernel/sched_rt_runtime_us", "950000\n");
        Write("proc/sys/kernel/sched_rt_period_us", "1000000\n");
        Write("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n");
        Write("sys/devices/system/clocksource/clocksource0/available_clocksource", "tsc hpet\n");
        for (const char* policy : {"policy0", "policy4"}) {
            const std::string folder = "sys/devices/system/cpu/cpufreq/" + std::string(policy);
            Write(folder + "/scaling_governor", "schedutil\n");
            Write(folder + "/scaling_driver", "tegra194\n");
            Write(folder + "/scaling_min_freq", "2201600\n");
            Write(folder + "/scaling_max_freq", "2201600\n");
        }
        Write("etc/hitchview/network", "# as shipped\ninterface=lo\n");
        Write("proc/net/route",
              "Iface\tDestination\tGateway \tFlags\tRefCnt\tUse\tMetric\tMask\t\tMTU\n" +
                  RouteLine("eth0", "0.0.0.0", "0.0.0.0") +
                  RouteLine("lo", "224.0.0.0", "240.0.0.0"));
        Write("etc/nv_tegra_release", "# R36 (release), REVISION: 4.0\n");
    }
    void WriteSlots() const {
        for (const char* slot : {"a", "b"}) {
            const std::string folder = "opt/hitchview/slots/" + std::string(slot);
            Write(folder + "/bin/hitchview", "", 0755);
            Write(folder + "/bin/hitchview-web", "", 0755);
            Write(folder + "/release", slot == std::string("a") ? "0.2.0\n" : "0.1.0\n");
        }
        std::filesystem::create_symlink("a", Path("opt/hitchview/slots/current"));
        std::filesystem::create_symlink("b", Path("opt/hitchview/slots/previous"));
    }

    [[nodiscard]] static std::string Text(const std::map<std::string, std::string>& properties) {
        std::string text;
        for (const auto& [name, value] : properties) text += name + "=" + value + "\n";
        return text;
    }
    [[nodiscard]] std::optional<std::string> Output(const std::vector<std::string>& command) const {
        if (command.front().ends_with("nvpmodel")) return power_mode;
        if (command.at(1) == "list-units") return failed_units;
        return Text(command.at(2) == "hitchview.service" ? service : recorder);
    }
    [[nodiscard]] std::optional<app::UserIds> User(const std::string& name) const {
        if (name == "hitchview" && user_exists) return app::UserIds{kServiceUser, user_groups};
        if (name.empty()) return app::UserIds{geteuid(), {getegid()}};
        return std::nullopt;
    }
    [[nodiscard]] hal::Checked<app::CanLinkFacts> CanLink(const std::string& name) const {
        if (name == "can0" && can_exists) return can;
        return "there is no interface '" + name + "'";
    }
    [[nodiscard]] hal::Checked<hal::Done> Delivered() const {
        const bool goes = multicast_source.ok() && (loopback_flags & IFF_UP) != 0 &&
                          (loopback_flags & IFF_MULTICAST) != 0 && !firewall;
        if (goes) return hal::Done{};
        return std::string("nothing came back");
    }
    [[nodiscard]] hal::Checked<app::HeardFacts> Heard(const std::string& url) const {
        const bool heard = Delivered() && url == url_of_service;
        return app::HeardFacts{heard ? 10 : 0, std::chrono::milliseconds(heard ? 330 : 1500)};
    }

    TemporaryFolder folder_;
};

}  // namespace hitchview::tests

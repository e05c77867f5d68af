#include "app/web_verb.hpp"

#include <poll.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>

#include "app/config.hpp"
#include "app/web_listen.hpp"
#include "drivers/lcm_listener.hpp"

namespace hitchview::app {
namespace {

using drivers::LcmListener;
using hal::Checked;
using std::chrono::milliseconds;

enum ExitCode { kDone = 0, kWrongUse = 2, kMachineFailed = 3 };

constexpr int kNiceness = 15;
/// The state goes out five times a second, and at once where it is urgent.
constexpr milliseconds kAnnouncePeriod{200};
/// How soon who waits for a share of the budget is looked after.
constexpr milliseconds kLongestSleep{10};

int Fail(ExitCode code, const std::string& reason) {
    std::fprintf(stderr, "hitchview web: %s\n", reason.c_str());
    return code;
}

/// Gives way to the programs of the frame path and of recording, wherever a CPU or the disk is
/// short.
void GiveWay() {
    constexpr int kThisProcess = 1;
    constexpr int kIdleClass = 3 << 13;  // linux/ioprio.h
    setpriority(PRIO_PROCESS, 0, kNiceness);
    syscall(SYS_ioprio_set, kThisProcess, 0, kIdleClass);
}

hal::Instant Now() {
    return std::chrono::steady_clock::now().time_since_epoch();
}

/// What the page shows, and where it comes from.
struct Sources {
    std::string url = drivers::kDefaultLcmUrl;
    WebChannels channels{};
    std::vector<WebCamera> cameras{};
};

Sources SourcesOf(const RigConfig& rig) {
    Sources sources{.url = rig.publish.url};
    sources.channels.panorama = rig.publish.panorama_channel;
    sources.channels.status = rig.publish.status_channel;
    sources.channels.hitch_angle = rig.publish.hitch_angle_channel;
    sources.channels.event = rig.publish.event_channel;
    sources.channels.health = rig.publish.health_channel;
    sources.channels.overlay = rig.publish.overlay.channel;
    for (const algo::Unit unit : algo::kUnits) {
        for (const CameraConfig& camera : rig.units[unit].cameras) {
            sources.cameras.push_back({.name = camera.name, .unit = algo::ToString(unit)});
        }
    }
    return sources;
}

Checked<Sources> ReadSources(const WebOptions& options) {
    Sources sources;
    if (!options.rig.empty()) {
        const auto rig = LoadRigConfig(options.rig);
        if (!rig) return rig.error();
        sources = SourcesOf(rig.value());
    }
    if (!options.url.empty()) sources.url = options.url;
    return sources;
}

/// Pictures are of interest as the newest only; of the others none should be missed.
bool SubscribeAll(LcmListener& listener, const WebChannels& channels) {
    constexpr int kNewest = 1;
    constexpr int kAll = 64;
    return listener.Subscribe(channels.panorama, kNewest) &&
           listener.Subscribe(channels.status, kAll) &&
           listener.Subscribe(channels.hitch_angle, kAll) &&
           listener.Subscribe(channels.event, kAll) && listener.Subscribe(channels.health, kAll) &&
           listener.Subscribe(channels.overlay, kNewest) &&
           listener.Subscribe(channels.preview_prefix + ".*", kAll);
}

void WaitForWork(const WebServer& server, const LcmListener& listener) {
    std::array<pollfd, 2> wanted{
        {{server.descriptor(), POLLIN, 0}, {listener.descriptor(), POLLIN, 0}}};
    poll(wanted.data(), wanted.size(), static_cast<int>(server.Patience(kLongestSleep).count()));
}

int ServeUntil(const std::atomic<bool>& stop, WebServer& server, LcmListener& listener,
               WebState& state) {
    hal::Instant announced_at{};
    while (!stop) {
        WaitForWork(server, listener);
        if (!listener.TakeAll()) return Fail(kMachineFailed, "LCM stopped receiving");
        const hal::Instant now = Now();
        if (state.TakeUrgency() || now - announced_at >= kAnnouncePeriod) {
            server.Announce(now);
            announced_at = now;
        }
        server.Serve(now);
    }
    return kDone;
}

void SayWhere(const WebOptions& options, const WebServer& server) {
    const std::string& address = options.server.address;
    const bool ip6 = address.find(':') != std::string::npos;
    std::printf("http://%s:%d/\n", ip6 ? ('[' + address + ']').c_str() : address.c_str(),
                server.port());
    std::fflush(stdout);
    if (IsLoopback(address)) return;
    std::fprintf(stderr,
                 "hitchview web: warning: everybody who reaches %s sees the pictures and may load "
                 "recordings down; nothing is encrypted\n",
                 address.c_str());
}

}  // namespace

int WebVerb(const WebOptions& options, const std::atomic<bool>& stop) {
    const auto sources = ReadSources(options);
    if (!sources) return Fail(kWrongUse, sources.error());
    if (const auto url = drivers::CheckLcmUrl(sources.value().url); !url) {
        return Fail(kWrongUse, url.error());
    }
    if (!options.recordings.empty() && !std::filesystem::is_directory(options.recordings)) {
        return Fail(kWrongUse, "--recordings: " + options.recordings.string() + " is no folder");
    }
    std::signal(SIGPIPE, SIG_IGN);  // a client that leaves is no reason to end
    GiveWay();

    const WebChannels& channels = sources.value().channels;
    WebState state(channels, sources.value().cameras);
    auto listener = LcmListener::Create(
        {.url = sources.value().url},
        [&](std::string_view channel, auto message) { state.Take(channel, message, Now()); });
    if (!listener) return Fail(kMachineFailed, listener.error());
    if (!SubscribeAll(**listener, channels)) return Fail(kMachineFailed, "LCM cannot subscribe");

    const WebRecordings recordings(options.recordings);
    const auto server = WebServer::Create(options.server, state, recordings);
    if (!server) return Fail(kMachineFailed, server.error());
    SayWhere(options, *server.value());
    return ServeUntil(stop, *server.value(), **listener, state);
}

}  // namespace hitchview::app

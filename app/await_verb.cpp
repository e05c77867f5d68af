#include "app/await_verb.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/config.hpp"
#include "app/exit_code.hpp"
#include "app/picture_judge.hpp"
#include "drivers/lcm_subscriber.hpp"

namespace hitchview::app {
namespace {

using drivers::LcmSubscriber;
using hal::Instant;
using std::chrono::milliseconds;

hal::Instant Now() {
    return std::chrono::steady_clock::now().time_since_epoch();
}

double SecondsSinceBoot() {
    timespec now{};
    clock_gettime(CLOCK_BOOTTIME, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double Seconds(Instant duration) {
    return std::chrono::duration<double>(duration).count();
}

/// What came since the start.
struct Tally {
    int row = 0;      ///< good ones since the newest that was not
    int longest = 0;  ///< such row
    int damaged = 0;
    int repeated = 0;
    int old = 0;
    int no_camera = 0;
    double first_since_boot_s = 0;  ///< of all the good ones
    Instant first_after{};          ///< the same
    Instant row_after{};            ///< the first of the row
    Instant newest_after{};         ///< of the good ones

    void Add(PictureVerdict verdict, Instant after) {
        switch (verdict) {
            case PictureVerdict::kShown:
                return AddGood(after);
            case PictureVerdict::kRepeated:
                return AddOther(repeated);
            case PictureVerdict::kOld:
                return AddOther(old);
            case PictureVerdict::kNoCamera:
                return AddOther(no_camera);
        }
    }
    void AddDamaged() { AddOther(damaged); }
    /// In the row; empty until it has two.
    [[nodiscard]] std::optional<double> RateHz() const {
        if (row < 2) return std::nullopt;
        return (row - 1) / Seconds(std::max(newest_after - row_after, Instant(1)));
    }

 private:
    void AddGood(Instant after) {
        if (longest == 0) {
            first_after = after;
            first_since_boot_s = SecondsSinceBoot();
        }
        if (row++ == 0) row_after = after;
        newest_after = after;
        longest = std::max(longest, row);
    }
    void AddOther(int& count) {
        ++count;
        row = 0;
    }
};

std::string Text(const char* format, double number) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, number);
    return text.data();
}

std::string Sentence(const Tally& tally, const AwaitOptions& options) {
    std::string text = std::to_string(tally.longest) + " good panoramas in a row of " +
                       std::to_string(options.panoramas) + " within " +
                       Text("%g s", options.within_s);
    if (tally.longest > 0) {
        text += "; the first after " + Text("%.2f s", Seconds(tally.first_after)) + ", " +
                Text("%.2f s since boot", tally.first_since_boot_s);
    }
    if (const auto rate_hz = tally.RateHz()) text += "; " + Text("%.1f per second", *rate_hz);
    const std::array others{std::pair{tally.damaged, "damaged"},
                            std::pair{tally.repeated, "not numbered on"},
                            std::pair{tally.old, "captured more than 1 s ago"},
                            std::pair{tally.no_camera, "without a camera's picture"}};
    for (const auto& [count, what] : others)
        if (count > 0) text += "; " + std::to_string(count) + ' ' + what;
    return text;
}

nlohmann::json Json(const Tally& tally, const AwaitOptions& options) {
    nlohmann::json json{{"good_in_a_row", tally.longest},    {"wanted", options.panoramas},
                        {"within_s", options.within_s},      {"damaged", tally.damaged},
                        {"not_numbered_on", tally.repeated}, {"old", tally.old},
                        {"no_camera", tally.no_camera},      {"first_after_s", nullptr},
                        {"first_since_boot_s", nullptr},     {"rate_hz", nullptr}};
    if (tally.longest > 0) {
        json["first_after_s"] = Seconds(tally.first_after);
        json["first_since_boot_s"] = tally.first_since_boot_s;
    }
    if (const auto rate_hz = tally.RateHz()) json["rate_hz"] = *rate_hz;
    return json;
}

/// Where the panoramas are to come from.
struct Source {
    drivers::LcmSubscriberOptions network;
    std::optional<int> cameras;  ///< of the rig, if a file says
};

hal::Checked<Source> SourceOf(const AwaitOptions& options) {
    PublishConfig publish;
    Source source;
    if (!options.rig.empty()) {
        auto config = LoadRigConfig(options.rig);
        if (!config) return config.error();
        publish = config->publish;
        source.cameras = 0;
        for (const algo::Unit unit : algo::kUnits)
            *source.cameras += static_cast<int>(config->units[unit].cameras.size());
    }
    source.network.url = options.url.empty() ? publish.url : options.url;
    source.network.channel = options.channel.empty() ? publish.panorama_channel : options.channel;
    source.network.health_channel = publish.health_channel;
    if (const auto url = drivers::CheckLcmUrl(source.network.url); !url) return url.error();
    if (const auto name = drivers::CheckLcmChannel("channel", source.network.channel); !name)
        return name.error();
    return source;
}

/// The rig's, as its file or its health message says.
std::optional<int> CameraCount(const Source& source, const LcmSubscriber& subscriber) {
    if (source.cameras) return source.cameras;
    const std::size_t named = subscriber.camera_names().size();
    return named == 0 ? std::nullopt : std::optional(static_cast<int>(named));
}

/// Empty if LCM gave up.
std::optional<Tally> Count(const AwaitOptions& options, const Source& source,
                           LcmSubscriber& subscriber, const std::atomic<bool>& stop) {
    constexpr milliseconds kPoll{50};
    PictureJudge judge;
    Tally tally;
    const Instant start = Now();
    const Instant end = start + Instant(static_cast<Instant::rep>(1e9 * options.within_s));
    while (!stop && tally.row < options.panoramas && Now() < end) {
        const auto image = subscriber.WaitImage(kPoll);
        const Instant now = Now();
        if (image)
            tally.Add(judge.Judge(image.value(), now, CameraCount(source, subscriber)),
                      now - start);
        else if (image.error() == hal::Error::kFailed)
            return std::nullopt;
        else if (image.error() != hal::Error::kTimeout)
            tally.AddDamaged();
    }
    return tally;
}

void Print(const Tally& tally, const AwaitOptions& options) {
    const std::string text = options.json ? Json(tally, options).dump(2) : Sentence(tally, options);
    std::fprintf(stdout, "%s\n", text.c_str());
}

}  // namespace

int AwaitVerb(const AwaitOptions& options, const std::atomic<bool>& stop) {
    const auto source = SourceOf(options);
    if (!source) return Fail(kWrongUse, source.error());
    const auto subscriber = LcmSubscriber::Create(source.value().network);
    if (!subscriber) return Fail(kMachineFailed, subscriber.error());
    const auto tally = Count(options, source.value(), *subscriber.value(), stop);
    if (!tally) return Fail(kMachineFailed, "LCM stopped receiving");
    Print(*tally, options);
    return tally->longest >= options.panoramas ? kGood : kBad;
}

}  // namespace hitchview::app

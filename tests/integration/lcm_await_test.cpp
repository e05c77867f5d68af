#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "drivers/lcm_publisher.hpp"
#include "drivers/steady_clock.hpp"
#include "tests/support/temporary_folder.hpp"

// `hitchview await` beside a sender of panoramas. Runs in a network namespace of its own
// (tests/support/lcm_namespace.sh).
namespace hitchview {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::MatchesRegex;

/// Sends panoramas at 100 Hz, and once their health, until it goes.
class Sender {
 public:
    struct Options {
        std::uint32_t cameras_missing = 0;
        std::uint32_t step = 1;          ///< of the numbers
        milliseconds standstill_at{-1};  ///< of the cameras, after the start; below 0: never
        bool names_cameras = false;      ///< two
        std::uint32_t again_after = 0;   ///< so many, numbered from 0 again; 0: never
        const char* channel = "PANORAMA";
    };
    explicit Sender(const Options& options) : options_(options) {
        drivers::LcmPublisherOptions network;
        network.messages.panorama_channel = options.channel;
        auto publisher = drivers::LcmPublisher::Create(network, clock_);
        EXPECT_TRUE(publisher) << publisher.error();
        publisher_ = std::move(*publisher);
        thread_ = std::thread([this] { Work(); });
    }
    ~Sender() {
        stop_ = true;
        thread_.join();
    }
    Sender(const Sender&) = delete;
    Sender& operator=(const Sender&) = delete;

 private:
    void Work() {
        hal::Health health;
        for (const char* name : {"front", "rear"}) health.cameras.Add({.name = {name}});
        const std::uint8_t jpeg[]{0xFF, 0xD8, 0xFF, 0xD9};
        const hal::Instant start = clock_.Now();
        hal::PanoramaImage image{.width_px = 64,
                                 .height_px = 32,
                                 .cameras_missing = options_.cameras_missing,
                                 .jpeg = jpeg};
        for (; !stop_; image.sequence += options_.step) {
            if (options_.again_after > 0) image.sequence %= options_.again_after;
            const hal::Instant now = clock_.Now();
            const bool stands =
                options_.standstill_at >= milliseconds(0) && now - start > options_.standstill_at;
            image.captured_until = stands ? start + options_.standstill_at : now;
            if (options_.names_cameras) {
                EXPECT_TRUE(publisher_->Publish(health));
            }
            EXPECT_TRUE(publisher_->Publish(image));
            std::this_thread::sleep_for(milliseconds(10));
        }
    }

    Options options_;
    drivers::SteadyClock clock_;
    std::unique_ptr<hal::Publisher> publisher_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

struct Answer {
    int code = -1;
    std::string text;
};

Answer Await(const std::string& arguments) {
    std::FILE* const output = popen((HITCHVIEW " await " + arguments + " 2>&1").c_str(), "r");
    Answer answer;
    for (int letter = std::fgetc(output); letter != EOF; letter = std::fgetc(output))
        answer.text += static_cast<char>(letter);
    answer.code = WEXITSTATUS(pclose(output));
    return answer;
}

TEST(LcmAwaitTest, EndsWithTheLastPanoramaThatIsWanted) {
    const Sender sender({});
    const Answer answer = Await("--panoramas 50 --within 60");
    EXPECT_EQ(answer.code, 0);
    EXPECT_THAT(
        answer.text,
        MatchesRegex("50 good panoramas in a row of 50 within 60 s; the first after [0-9.]+ s, "
                     "[0-9.]+ s since boot; [0-9.]+ per second\n"));
}

TEST(LcmAwaitTest, TellsTheSameAsJson) {
    const Sender sender({});
    const Answer answer = Await("--panoramas 50 --within 60 --json");
    EXPECT_EQ(answer.code, 0);
    const auto json = nlohmann::json::parse(answer.text);
    EXPECT_EQ(json.at("good_in_a_row"), 50);
    EXPECT_EQ(json.at("wanted"), 50);
    EXPECT_GT(json.at("first_after_s"), 0);
    EXPECT_LT(json.at("first_after_s"), 60);
    EXPECT_GT(json.at("first_since_boot_s"), json.at("first_after_s"));
    EXPECT_GT(json.at("rate_hz"), 5);
    EXPECT_LT(json.at("rate_hz"), 150);
}

TEST(LcmAwaitTest, WithoutASenderNoneCome) {
    const Answer answer = Await("--panoramas 1 --within 0.5");
    EXPECT_EQ(answer.code, 1);
    EXPECT_EQ(answer.text, "0 good panoramas in a row of 1 within 0.5 s\n");
}

TEST(LcmAwaitTest, PicturesThatStandStillAreNotTakenForLiveOnes) {
    const Sender sender({.standstill_at = milliseconds(500)});
    const Answer answer = Await("--panoramas 1000 --within 4");
    EXPECT_EQ(answer.code, 1);
    EXPECT_THAT(answer.text, HasSubstr("captured more than 1 s ago"));
}

TEST(LcmAwaitTest, APictureSentAgainAndAgainIsOnePicture) {
    const Sender sender({.step = 0});
    const Answer answer = Await("--panoramas 2 --within 1 --json");
    EXPECT_EQ(answer.code, 1);
    const auto json = nlohmann::json::parse(answer.text);
    EXPECT_EQ(json.at("good_in_a_row"), 1);
    EXPECT_GT(json.at("not_numbered_on"), 0);
}

/// As of a program that is started again and again.
TEST(LcmAwaitTest, PanoramasThatBeginAnewAreNoRow) {
    const Sender sender({.again_after = 20});
    const Answer answer = Await("--panoramas 30 --within 3 --json");
    EXPECT_EQ(answer.code, 1);
    const auto json = nlohmann::json::parse(answer.text);
    EXPECT_GT(json.at("good_in_a_row"), 5);
    EXPECT_LE(json.at("good_in_a_row"), 20);
    EXPECT_GT(json.at("not_numbered_on"), 1);
    EXPECT_EQ(Await("--panoramas 15 --within 60").code, 0);
}

TEST(LcmAwaitTest, PanoramasWithoutAnyCameraAreNotGood) {
    const Sender sender({.cameras_missing = 3, .names_cameras = true});
    const Answer answer = Await("--panoramas 1 --within 1");
    EXPECT_EQ(answer.code, 1);
    EXPECT_THAT(answer.text, HasSubstr("without a camera's picture"));
}

TEST(LcmAwaitTest, PanoramasOfOneCameraAreGood) {
    const Sender sender({.cameras_missing = 2, .names_cameras = true});
    EXPECT_EQ(Await("--panoramas 10 --within 60").code, 0);
}

TEST(LcmAwaitTest, TheRigFileNamesChannelAndCameras) {
    const tests::TemporaryFolder folder;
    const std::string rig =
        folder.Write("rig.yaml",
                     "schema: 1\ncanvas: {projection: plane, size_px: [64, 64]}\nunits:\n"
                     "  tractor: {cameras: [{name: front, source: {replay: front.avi}}]}\n"
                     "publish: {panorama_channel: OTHER}\n");
    const Sender sender({.cameras_missing = 1, .channel = "OTHER"});
    const Answer none = Await("--rig " + rig + " --panoramas 1 --within 1");
    EXPECT_EQ(none.code, 1);
    EXPECT_THAT(none.text, HasSubstr("without a camera's picture")) << "it has one camera";
    EXPECT_EQ(Await("--rig " + rig + " --channel PANORAMA --panoramas 1 --within 0.5").text,
              "0 good panoramas in a row of 1 within 0.5 s\n");
}

TEST(LcmAwaitTest, WrongUseIsTold) {
    EXPECT_EQ(Await("--panoramas 1").code, 2);
    EXPECT_EQ(Await("--panoramas 0 --within 1").code, 2);
    EXPECT_EQ(Await("--panoramas 1 --within -1").code, 2);
    EXPECT_EQ(Await("--panoramas 1 --within 1 --rig /no/such/rig.yaml").code, 2);
    EXPECT_EQ(Await("--panoramas 1 --within 1 --channel '.*'").code, 2);
    const Answer url = Await("--panoramas 1 --within 1 --url udpm://1.2.3.4:5");
    EXPECT_EQ(url.code, 2);
    EXPECT_THAT(url.text, HasSubstr("udpm://1.2.3.4:5"));
}

TEST(LcmAwaitTest, WithoutANetworkTheMachineHasFailed) {
    ASSERT_EQ(std::system("ip route del 224.0.0.0/4 dev lo"), 0);
    const Answer answer = Await("--panoramas 1 --within 1");
    ASSERT_EQ(std::system("ip route add 224.0.0.0/4 dev lo"), 0);
    EXPECT_EQ(answer.code, 3);
    EXPECT_THAT(answer.text, HasSubstr("route to 224.0.0.0/4"));
}

}  // namespace
}  // namespace hitchview

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/web_client.hpp"
#include "tests/support/web_program.hpp"

// Runs in a network namespace of its own (tests/support/lcm_namespace.sh).
namespace hitchview::tests {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr int kMisdirected = 421;

/// The program, on a port that was free.
class WebServerTest : public testing::Test {
 protected:
    static std::string Numbers(int count) {
        std::string text;
        for (int i = 0; i < count; ++i) text += std::to_string(i) + "\n";
        return text;
    }

    WebServerTest() : log_(Numbers(100'000)) {
        folder_.Write("drive.lcm", log_);
        folder_.Write("notes.txt", "secret");
    }

    WebAnswer Get(const std::string& path, const std::string& headers = {}) const {
        WebClient client(program_.port());
        return client.Get(path, headers).value_or(WebAnswer{});
    }

    /// The first picture that comes while `send` goes on.
    template <typename SendOne>
    WebAnswer PictureWhile(SendOne&& send) const {
        WebAnswer answer;
        for (int i = 0; i < 50 && answer.status != 200; ++i) {
            send();
            answer = Get("/panorama.jpg?after=0");
        }
        return answer;
    }

    TemporaryFolder folder_;
    std::string log_;
    RigSender rig_;
    WebProgram program_{HITCHVIEW, {"--port", "0", "--recordings", folder_.path()}};
};

TEST_F(WebServerTest, ThePageComesWithHeadersThatKeepOthersOut) {
    ASSERT_GT(program_.port(), 0) << program_.first_line();
    WebAnswer page = Get("/");
    EXPECT_EQ(page.status, 200);
    EXPECT_THAT(page.body, HasSubstr("<title>Hitchview</title>"));
    EXPECT_EQ(page.body.find("://"), std::string::npos) << "something from elsewhere";
    EXPECT_THAT(page.headers["content-security-policy"], HasSubstr("default-src 'none'"));
    EXPECT_EQ(page.headers["content-security-policy"].find("unsafe"), std::string::npos);
    EXPECT_EQ(page.headers["x-content-type-options"], "nosniff");
    EXPECT_EQ(page.headers["x-frame-options"], "DENY");
    EXPECT_EQ(Get("/", "If-None-Match: " + page.headers["etag"] + "\r\n").status, 304);
    EXPECT_EQ(Get("/page.js").headers["content-type"], "text/javascript; charset=utf-8");
}

TEST_F(WebServerTest, WhatIsNotForThisServerIsRefused) {
    EXPECT_EQ(Get("/", "Host: rebound.example\r\n").status, kMisdirected);
    EXPECT_EQ(Get("/events", "Host: rebound.example:8080\r\n").status, kMisdirected);
    EXPECT_EQ(Get("/events", "Sec-Fetch-Site: cross-site\r\n").status, 403);
    for (const char* path : {"/absent", "/../../etc/passwd", "/recordings/../../etc/passwd",
                             "/recordings/%2e%2e%2f%2e%2e%2fetc%2fpasswd", "/recordings/",
                             "/recordings/notes.txt%00.lcm", "//etc/passwd"}) {
        EXPECT_EQ(Get(path).status, 404) << path;
    }
    WebClient client(program_.port());
    client.Ask("/", "Content-Length: 0\r\n", "POST");
    EXPECT_EQ(client.Answer()->status, 405);
    EXPECT_EQ(Get("/", "Content-Length: 5\r\n").status, 400);
    std::string long_path(20'000, 'a');
    long_path.front() = '/';
    EXPECT_GE(Get(long_path).status, 400);
    EXPECT_GE(Get("/", "X: " + std::string(40'000, 'a') + "\r\n").status, 400);
    WebClient noise(program_.port());
    noise.Send("\x16\x03\x01 no HTTP at all\r\n\r\n");
    (void)noise.Answer();
    EXPECT_EQ(Get("/").status, 200);
}

TEST_F(WebServerTest, ADownloadThatBrokeOffGoesOnWhereItStopped) {
    WebAnswer whole = Get("/recordings/drive.lcm");
    EXPECT_EQ(whole.status, 200);
    EXPECT_EQ(whole.body, log_);
    const std::string tag = whole.headers["etag"];
    WebAnswer rest =
        Get("/recordings/drive.lcm", "Range: bytes=1000-\r\nIf-Range: " + tag + "\r\n");
    EXPECT_EQ(rest.status, 206);
    EXPECT_EQ(rest.body, log_.substr(1000));
    EXPECT_EQ(rest.headers["content-range"],
              "bytes 1000-" + std::to_string(log_.size() - 1) + "/" + std::to_string(log_.size()));
    EXPECT_EQ(Get("/recordings/drive.lcm", "Range: bytes=1000-\r\nIf-Range: \"other\"\r\n").body,
              log_);
    EXPECT_EQ(Get("/recordings/drive.lcm", "Range: bytes=99999999-\r\n").status, 416);
    WebClient client(program_.port());
    client.Ask("/recordings/drive.lcm", "", "HEAD");
    EXPECT_EQ(client.Answer(false)->headers["content-length"], std::to_string(log_.size()));
    EXPECT_EQ(json::parse(Get("/recordings").body)["files"][0]["bytes"], log_.size());
}

TEST_F(WebServerTest, APanoramaGoesOutByteForByteAndOnce) {
    const MessageBytes jpeg = JpegOfSize(140'000, 7);
    std::uint32_t sequence = 0;
    WebAnswer answer = PictureWhile([&] {
        ++sequence;
        rig_.Send("PANORAMA", ImageBytes(jpeg, 2048, 360, sequence, sequence));
    });
    ASSERT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, std::string(jpeg.begin(), jpeg.end()));
    EXPECT_EQ(answer.headers["content-type"], "image/jpeg");
    EXPECT_LE(std::stoi(answer.headers["x-age-ms"]), 500);
    const std::string serial = answer.headers["x-serial"];
    WebAnswer later;
    while (later.status != 204) {
        later = Get("/panorama.jpg?after=" + serial);
        ASSERT_TRUE(later.status == 204 || later.headers["x-serial"] != serial);
        if (later.status == 200) break;
    }
}

TEST_F(WebServerTest, TheStreamTellsOfALostCamera) {
    WebClient client(program_.port());
    client.Ask("/events");
    ASSERT_TRUE(client.TakeThrough("\r\n\r\n"));
    std::string state;
    for (std::uint32_t i = 0; i < 100 && state != "lost"; ++i) {
        rig_.Send("PANORAMA_HEALTH", HealthBytes(i, {.cameras = {"front", "left"}}));
        rig_.Send("PANORAMA_STATUS", StatusBytes(i, i, 0b10));
        const auto text = client.TakeThrough("\n\n");
        ASSERT_TRUE(text);
        const json news = json::parse(text->substr(text->find("data: ") + 6));
        if (!news["cameras"].empty()) state = news["cameras"].back()["state"];
    }
    EXPECT_EQ(state, "lost");
}

TEST_F(WebServerTest, DamagedMessagesOnEveryChannelDoNotEndIt) {
    for (const char* channel : {"PANORAMA", "PANORAMA_STATUS", "PANORAMA_EVENT", "HITCH_ANGLE",
                                "PANORAMA_HEALTH", "PANORAMA_OVERLAY", "PREVIEW_FRONT"}) {
        const auto good = {HealthBytes(1, {.cameras = {"front"}}), OverlayBytes(1, 64, 32, 0),
                           StatusBytes(1, 1, 0), EventBytes(1, 1, "front", "x"),
                           ImageBytes(JpegOfSize(100, 1), 64, 32, 1, 1)};
        for (MessageBytes message : good) {
            rig_.Send(channel, message);
            for (std::size_t at = 0; at < message.size(); at += 7) {
                MessageBytes damaged = message;
                damaged[at] = 0xFF;
                damaged.resize(std::max<std::size_t>(1, damaged.size() - at / 2));
                rig_.Send(channel, damaged);
            }
        }
    }
    EXPECT_TRUE(program_.IsRunning());
    EXPECT_EQ(Get("/").status, 200);
}

TEST_F(WebServerTest, ClientsThatNeverReadHarmNobody) {
    constexpr int kReaders = 45;
    constexpr int kSleepers = 5;
    constexpr std::size_t kMostMemory = 160 << 20;
    const PanoramaStream panoramas(150'000);
    std::vector<std::unique_ptr<WebClient>> sleepers;
    for (int i = 0; i < kSleepers; ++i) {
        sleepers.push_back(std::make_unique<WebClient>(program_.port(), 4096));
        sleepers.back()->Ask(i % 2 == 0 ? "/panorama.jpg?after=0" : "/events");
    }
    std::vector<std::unique_ptr<WebClient>> readers;
    for (int i = 0; i < kReaders; ++i) {
        readers.push_back(std::make_unique<WebClient>(program_.port()));
    }
    std::vector<int> pictures(kReaders);
    std::vector<std::string> serials(kReaders, "0");
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(4);
    while (std::chrono::steady_clock::now() < end) {
        for (std::size_t i = 0; i < kReaders; ++i) {
            ASSERT_TRUE(readers[i]->Ask("/panorama.jpg?after=" + serials[i]));
        }
        for (std::size_t i = 0; i < kReaders; ++i) {
            auto answer = readers[i]->Answer();
            ASSERT_TRUE(answer) << "reader " << i;
            pictures[i] += answer->status == 200 ? 1 : 0;
            serials[i] = answer->headers["x-serial"];
        }
    }
    EXPECT_GE(*std::ranges::min_element(pictures), 4);
    EXPECT_LT(program_.RssBytes(), kMostMemory);
    RecordProperty("pictures_each", *std::ranges::min_element(pictures));
    std::printf("each of %d readers saw at least %d pictures in 4 s; server %zu MB\n", kReaders,
                *std::ranges::min_element(pictures), program_.RssBytes() >> 20);
}

TEST_F(WebServerTest, AConnectionBeyondTheAgreedNumberWaitsUntilAnotherLeaves) {
    WebProgram small(HITCHVIEW, {"--port", "0", "--connections", "4"});
    std::vector<std::unique_ptr<WebClient>> clients;
    for (int i = 0; i < 4; ++i) {
        clients.push_back(std::make_unique<WebClient>(small.port()));
        ASSERT_TRUE(clients.back()->Get("/")) << i;
    }
    WebClient fifth(small.port());
    fifth.Ask("/");
    EXPECT_FALSE(fifth.Receive(milliseconds(300)));
    clients.pop_back();
    EXPECT_TRUE(fifth.Answer());
}

TEST_F(WebServerTest, AStopSignalEndsItWithClientsInEveryState) {
    WebClient idle(program_.port());
    WebClient events(program_.port());
    events.Ask("/events");
    ASSERT_TRUE(events.TakeThrough("\r\n\r\n"));
    WebClient waiting(program_.port());
    waiting.Ask("/panorama.jpg?after=0");
    WebClient half(program_.port());
    half.Send("GET / HTTP/1.1\r\nHost: 127");
    WebClient download(program_.port(), 4096);
    download.Ask("/recordings/drive.lcm");
    EXPECT_EQ(program_.Stop(), 0);
}

TEST_F(WebServerTest, APortThatIsTakenIsSaidByTheExitCode) {
    WebProgram second(HITCHVIEW, {"--port", std::to_string(program_.port())});
    EXPECT_EQ(second.first_line(), "");
    EXPECT_EQ(second.Wait(), 3);
}

TEST_F(WebServerTest, WrongUseIsSaidByTheExitCode) {
    EXPECT_EQ(WebProgram(HITCHVIEW, {"--port", "70000"}).Wait(), 2);
    EXPECT_EQ(WebProgram(HITCHVIEW, {"--port", "0", "--url", "udpm://1.2.3.4:7667"}).Wait(), 2);
    EXPECT_EQ(WebProgram(HITCHVIEW, {"--port", "0", "--bind", "example.com"}).Wait(), 2);
}

}  // namespace
}  // namespace hitchview::tests

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <thread>

#include "app/jpeg_encoder.hpp"
#include "drivers/lcm_publisher.hpp"
#include "drivers/steady_clock.hpp"
#include "tests/support/i420_picture.hpp"
#include "tests/support/temporary_folder.hpp"

// What docs/examples tells makers of display units to begin with. Runs in a network namespace of
// its own (tests/support/lcm_namespace.sh).
namespace hitchview {
namespace {

using std::chrono::milliseconds;

/// Publishes one picture thirty times a second until destroyed. `late`: captured so long before.
class Source {
 public:
    explicit Source(milliseconds late = milliseconds(0)) : late_(late) {
        const auto picture = tests::I420Picture::Waves(640, 120, 3);
        app::JpegEncoder encoder(picture.format(), {});
        const auto encoded = encoder.Encode(picture.view());
        jpeg.assign(encoded.value().begin(), encoded.value().end());
        publisher_ = std::move(drivers::LcmPublisher::Create({}, clock_).value());
        thread_ = std::thread([this] { Run(); });
    }
    ~Source() {
        stop_ = true;
        thread_.join();
    }
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;

    std::vector<std::uint8_t> jpeg;

 private:
    void Run() {
        for (std::uint32_t sequence = 0; !stop_; ++sequence) {
            const hal::Instant captured = clock_.Now() - late_;
            EXPECT_TRUE(publisher_->Publish(hal::PanoramaImage{.sequence = sequence,
                                                               .captured_from = captured,
                                                               .captured_until = captured,
                                                               .width_px = 640,
                                                               .height_px = 120,
                                                               .jpeg = jpeg}));
            std::this_thread::sleep_for(milliseconds(33));
        }
    }

    drivers::SteadyClock clock_;
    hal::Instant late_;
    std::unique_ptr<drivers::LcmPublisher> publisher_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

/// What a command says and how it ends, run in a folder.
std::pair<std::string, int> RunIn(const tests::TemporaryFolder& folder,
                                  const std::string& command) {
    std::FILE* const output =
        popen(("cd " + folder.path() + " && timeout 60 " + command).c_str(), "r");
    std::string text;
    std::array<char, 512> line{};
    while (std::fgets(line.data(), line.size(), output) != nullptr) text += line.data();
    return {text, pclose(output)};
}

void ExpectShowsPictures(const std::string& program) {
    const tests::TemporaryFolder folder;
    const Source source;
    const auto [text, status] =
        RunIn(folder, program + " '" + drivers::kDefaultLcmUrl + "&recv_buf_size=4194304' 3");
    EXPECT_EQ(status, 0) << text;
    EXPECT_NE(text.find("sequence "), std::string::npos) << text;
    EXPECT_NE(text.find("640x120 age "), std::string::npos) << text;
    const std::string saved = tests::FileText(folder / "newest.jpg");
    EXPECT_EQ(saved, std::string(source.jpeg.begin(), source.jpeg.end()));
}

void ExpectShowsNoOldPicture(const std::string& program) {
    const tests::TemporaryFolder folder;
    const Source source(milliseconds(2000));
    const auto [text, status] = RunIn(folder, "timeout 1 " + program);
    EXPECT_NE(status, 0);
    EXPECT_NE(text.find("NO IMAGE: the picture is 20"), std::string::npos) << text;
    EXPECT_EQ(tests::FileText(folder / "newest.jpg"), "");
}

TEST(LcmExamplesTest, TheOneInCShowsPictures) {
    ExpectShowsPictures(EXAMPLE_C);
}

TEST(LcmExamplesTest, TheOneInCppShowsPictures) {
    ExpectShowsPictures(EXAMPLE_CPP);
}

TEST(LcmExamplesTest, NeitherShowsOldOnes) {
    ExpectShowsNoOldPicture(EXAMPLE_C);
    ExpectShowsNoOldPicture(EXAMPLE_CPP);
}

TEST(LcmExamplesTest, WithoutAPublisherThereIsNoImage) {
    const tests::TemporaryFolder folder;
    for (const char* program : {EXAMPLE_C, EXAMPLE_CPP}) {
        const auto [text, status] = RunIn(folder, std::string("timeout 1 ") + program);
        EXPECT_NE(text.find("NO IMAGE: none came"), std::string::npos) << text;
    }
}

TEST(LcmExamplesTest, TheOneInPythonShowsPictures) {
    const std::string python = "PYTHONPATH=" EXAMPLE_PYTHON_TYPES " python3 ";
    if (std::system("python3 -c 'import lcm' 2> /dev/null") != 0) {
        EXPECT_EQ(std::system("python3 -c \"compile(open('" EXAMPLE_PYTHON
                              "').read(), 'example', 'exec')\""),
                  0);
        GTEST_SKIP() << "Python's module lcm is not installed: the example was compiled only";
    }
    ExpectShowsPictures("env " + python + EXAMPLE_PYTHON);
}

}  // namespace
}  // namespace hitchview

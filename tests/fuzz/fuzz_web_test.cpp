#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz_corpus.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/rig_messages.hpp"

namespace hitchview::tests {
namespace {

/// In the order of the channels of the fuzz target.
std::vector<MessageBytes> Messages() {
    const MessageBytes jpeg{0xFF, 0xD8, 0xFF, 0xE0, 0xFF, 0xD9};
    return {ImageBytes(jpeg, 64, 32, 1, 1),
            StatusBytes(1, 1, 3),
            EventBytes(1, 1, "front", "text"),
            HitchAngleBytes(1, 0.1),
            HealthBytes(1, {.cameras = {"front", "left"}}),
            OverlayBytes(1, 64, 32, 0),
            ImageBytes(jpeg, 192, 108, 1, 1)};
}

TEST(FuzzWebTest, NoMutationOfAMessageBreaksWhatClientsAreTold) {
    std::mt19937 random(1);
    const auto messages = Messages();
    for (std::size_t channel = 0; channel < messages.size(); ++channel) {
        for (int i = 0; i < 3000; ++i) {
            MessageBytes bytes = messages[channel];
            bytes.insert(bytes.begin(), static_cast<std::uint8_t>(channel));
            for (auto n = random() % 4; n <= 4; ++n) {
                // The fingerprint stays: without it nothing is read.
                bytes[9 + random() % (bytes.size() - 9)] = static_cast<std::uint8_t>(random());
            }
            if (random() % 4 == 0) bytes.resize(1 + random() % bytes.size());
            ASSERT_EQ(LLVMFuzzerTestOneInput(bytes.data(), bytes.size()), 0);
        }
    }
}

TEST(FuzzWebTest, NoMutationOfARequestBreaksAPromise) {
    std::mt19937 random(2);
    const std::string letters = "bytes=-,0123456789/.[]:lcm%\xFF";
    for (int i = 0; i < 20'000; ++i) {
        std::string text = i % 2 == 0 ? "bytes=" : "";
        for (auto n = random() % 24; n > 0; --n) text += letters[random() % letters.size()];
        ASSERT_EQ(
            LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()),
            0);
    }
}

TEST(FuzzWebTest, NoFileOfTheCorpusAndNoMutationOfOneBreaksAPromise) {
    RunCorpus("web", 2000);
}

}  // namespace
}  // namespace hitchview::tests

#include <gtest/gtest.h>

#include <random>

#include "tests/fuzz/fuzz_corpus.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/health_message.hpp"
#include "tests/support/image_message.hpp"

namespace hitchview::tests {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Some bytes changed, cut off or put in.
Bytes Mutated(Bytes bytes, std::mt19937& random) {
    for (auto changes = 1 + random() % 6; changes > 0 && !bytes.empty(); --changes) {
        const auto at = static_cast<std::ptrdiff_t>(random() % bytes.size());
        switch (random() % 5) {
            case 0:
                bytes.resize(static_cast<std::size_t>(at));
                break;
            case 1:
                bytes.insert(bytes.begin() + at, random() % 9, std::uint8_t{0xFF});
                break;
            default:
                bytes[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(random());
        }
    }
    return bytes;
}

TEST(FuzzLcmMessageTest, NoMutationOfASoundMessageBreaksAPromise) {
    std::mt19937 random(11);
    for (const Bytes& sound : {HealthMessage({"front", "rear"}), ImageMessage{}.Encode()}) {
        for (int i = 0; i < 20'000; ++i) {
            const Bytes bytes = Mutated(sound, random);
            EXPECT_EQ(LLVMFuzzerTestOneInput(bytes.data(), bytes.size()), 0);
        }
    }
}

TEST(FuzzLcmMessageTest, NoRandomBytesBreakAPromise) {
    std::mt19937 random(12);
    for (int i = 0; i < 2'000; ++i) {
        Bytes bytes(random() % 600);
        for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
        EXPECT_EQ(LLVMFuzzerTestOneInput(bytes.data(), bytes.size()), 0);
    }
}

TEST(FuzzLcmMessageTest, NoFileOfTheCorpusAndNoMutationOfOneBreaksAPromise) {
    RunCorpus("lcm_message", 50'000);
}

}  // namespace
}  // namespace hitchview::tests

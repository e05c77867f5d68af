#include <gtest/gtest.h>

#include <random>

#include "tests/fuzz/fuzz_corpus.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/random_log.hpp"

namespace hitchview::tests {
namespace {

TEST(FuzzLcmLogTest, NoFileOfTheCorpusAndNoMutationOfOneBreaksAPromise) {
    RunCorpus("lcm_log", 20'000);
}

TEST(FuzzLcmLogTest, NoMutationOfALongLogBreaksAPromiseOfTheReader) {
    const std::vector<FuzzInput> logs{RandomLog(3, 9).bytes};
    std::mt19937 random(1);
    for (int i = 0; i < 3000; ++i) {
        const FuzzInput bytes = Mutated(logs.front(), logs, random);
        ASSERT_EQ(LLVMFuzzerTestOneInput(bytes.data(), bytes.size()), 0);
    }
}

}  // namespace
}  // namespace hitchview::tests

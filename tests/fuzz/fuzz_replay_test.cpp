#include <gtest/gtest.h>

#include "tests/fuzz/fuzz_corpus.hpp"

namespace hitchview::tests {
namespace {

TEST(FuzzReplayTest, NoFileOfTheCorpusAndNoMutationOfOneBreaksAPromise) {
    RunCorpus("replay", 30'000);
}

}  // namespace
}  // namespace hitchview::tests

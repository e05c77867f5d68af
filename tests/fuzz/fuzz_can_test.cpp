#include <gtest/gtest.h>

#include "tests/fuzz/fuzz_corpus.hpp"

namespace hitchview::tests {
namespace {

TEST(FuzzCanTest, NoFileOfTheCorpusAndNoMutationOfOneBreaksAPromise) {
    RunCorpus("can", 50'000);
}

}  // namespace
}  // namespace hitchview::tests

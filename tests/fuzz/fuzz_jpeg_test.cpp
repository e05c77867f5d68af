#include <gtest/gtest.h>

#include "tests/fuzz/fuzz_corpus.hpp"

namespace hitchview::tests {
namespace {

TEST(FuzzJpegTest, NoFileOfTheCorpusAndNoMutationOfOneBreaksAPromise) {
    RunCorpus("jpeg", 10'000);
}

}  // namespace
}  // namespace hitchview::tests

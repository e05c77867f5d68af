#include <gtest/gtest.h>

#include "tests/fuzz/fuzz_corpus.hpp"

namespace hitchview::tests {
namespace {

TEST(FuzzRigTest, NoFileOfTheCorpusAndNoMutationOfOneBreaksAPromise) {
    RunCorpus("rig", 2000);
}

}  // namespace
}  // namespace hitchview::tests

#include <gtest/gtest.h>

#include "tests/fuzz/fuzz_corpus.hpp"

namespace hitchview::tests {
namespace {

TEST(FuzzCalibrationTest, NoFileOfTheCorpusAndNoMutationOfOneBreaksAPromise) {
    RunCorpus("calibration", 2000);
}

}  // namespace
}  // namespace hitchview::tests

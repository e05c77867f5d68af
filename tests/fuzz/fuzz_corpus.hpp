#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace hitchview::tests {

using FuzzInput = std::vector<std::uint8_t>;

/// The files in tests/fuzz/corpus/NAME, in the order of their names.
std::vector<FuzzInput> Corpus(const std::string& name);

/// Some bytes changed, cut out, repeated, or taken from another input of the corpus.
FuzzInput Mutated(FuzzInput input, const std::vector<FuzzInput>& corpus, std::mt19937& random);

/// Runs the target on each file of its corpus, and on so many mutations of them.
void RunCorpus(const std::string& name, int mutations);

}  // namespace hitchview::tests

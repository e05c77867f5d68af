#include "tests/fuzz/fuzz_corpus.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/fuzz_target.hpp"

namespace hitchview::tests {
namespace {

FuzzInput BytesOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A few neighbouring bytes.
FuzzInput PieceOf(const FuzzInput& input, std::mt19937& random) {
    if (input.empty()) return {0};
    const std::size_t at = random() % input.size();
    const std::size_t count = std::min<std::size_t>(1 + random() % 32, input.size() - at);
    const auto first = input.begin() + static_cast<std::ptrdiff_t>(at);
    return {first, first + static_cast<std::ptrdiff_t>(count)};
}

void Change(FuzzInput& input, const FuzzInput& other, std::mt19937& random) {
    const FuzzInput piece = PieceOf(random() % 2 == 0 ? input : other, random);
    const auto at = input.begin() + static_cast<std::ptrdiff_t>(random() % (input.size() + 1));
    const auto end = at + std::min(std::ssize(piece), input.end() - at);
    switch (random() % 4) {
        case 0:
            std::transform(at, end, at,
                           [&](std::uint8_t) { return static_cast<std::uint8_t>(random()); });
            break;
        case 1:
            std::copy(piece.begin(), piece.begin() + (end - at), at);
            break;
        case 2:
            input.erase(at, end);
            break;
        default:
            input.insert(at, piece.begin(), piece.end());
    }
}

}  // namespace

std::vector<FuzzInput> Corpus(const std::string& name) {
    std::vector<std::filesystem::path> files;
    const std::string folder = HITCHVIEW_SOURCE_DIR "/tests/fuzz/corpus/" + name;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files.push_back(entry.path());
    std::ranges::sort(files);
    std::vector<FuzzInput> corpus;
    std::ranges::transform(files, std::back_inserter(corpus), BytesOf);
    return corpus;
}

FuzzInput Mutated(FuzzInput input, const std::vector<FuzzInput>& corpus, std::mt19937& random) {
    for (auto changes = 1 + random() % 6; changes > 0; --changes)
        Change(input, corpus[random() % corpus.size()], random);
    return input;
}

void RunCorpus(const std::string& name, int mutations) {
    const std::vector<FuzzInput> corpus = Corpus(name);
    ASSERT_FALSE(corpus.empty());
    for (const FuzzInput& input : corpus)
        EXPECT_EQ(LLVMFuzzerTestOneInput(input.data(), input.size()), 0);
    std::mt19937 random(1);
    for (int i = 0; i < mutations; ++i) {
        const FuzzInput input =
            Mutated(corpus[static_cast<std::size_t>(i) % corpus.size()], corpus, random);
        EXPECT_EQ(LLVMFuzzerTestOneInput(input.data(), input.size()), 0);
    }
}

}  // namespace hitchview::tests

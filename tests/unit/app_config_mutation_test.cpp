#include <gtest/gtest.h>

#include <random>
#include <string>

#include "app/config.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using Random = std::mt19937;

/// A few bytes replaced, lost, inserted or repeated.
std::string Mutated(std::string text, Random& random) {
    using namespace std::string_literals;
    static const std::string kBytes = "{}[]:,&*!#|>'\"%@`-? \n\t01x.~<\0\xff"s;
    const auto below = [&](std::size_t limit) { return random() % limit; };
    for (auto count = 1 + below(4); count > 0; --count) {
        const std::size_t at = below(text.size());
        switch (below(4)) {
            case 0:
                text[at] = kBytes[below(kBytes.size())];
                break;
            case 1:
                text.erase(at, below(20));
                break;
            case 2:
                text.insert(at, 1, kBytes[below(kBytes.size())]);
                break;
            default:
                text.insert(at, text.substr(below(text.size()), below(40)));
                break;
        }
    }
    return text;
}

TEST(ConfigMutationTest, ADamagedFileIsReadOrRefusedWithAReason) {
    const tests::TemporaryFolder folder;
    const std::string example = tests::FileText(HITCHVIEW_SOURCE_DIR "/docs/rig.example.yaml");
    Random random(7);
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
        const std::string text = Mutated(example, random);
        const auto config = LoadRigConfig(folder.Write("rig.yaml", text));
        if (config.ok()) continue;
        ++refused;
        ASSERT_NE(config.error().find("must be"), std::string::npos) << config.error() << text;
    }
    EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace hitchview::app

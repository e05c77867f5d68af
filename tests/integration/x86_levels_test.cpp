#include <gtest/gtest.h>

#include <array>

#include "app/program.hpp"
#include "tests/support/temporary_folder.hpp"

// One recording gives one panorama, bit for bit, whatever vectors the processor has. QEMU's user
// mode stands in for older processors; the program and its libraries choose their code by what the
// processor says of itself.
namespace hitchview::app {
namespace {

constexpr std::array kProcessors{"Nehalem",   // SSE 4.2
                                 "Haswell"};  // AVX2, FMA

std::vector<std::string> Replay(const std::string& rig, const std::string& out) {
    return {"replay", "--rig",         rig,     "--frames", "8", "--workers",
            "2",      "--write-video", "--out", out};
}

TEST(X86LevelsTest, ThePanoramaIsTheSameBitForBit) {
    if (std::string(QEMU_X86_64).empty())
        GTEST_SKIP() << "needs an x86 machine with qemu-x86_64 (package qemu-user)";
    const tests::TemporaryFolder folder;
    ASSERT_EQ(RunProgram(HITCHVIEW, {"demo", "--headless", "--frames", "30", "--camera-width",
                                     "320", "--out", folder / "demo"}),
              0);
    const std::string rig = folder / "demo/recording/rig.yaml";
    ASSERT_EQ(RunProgram(HITCHVIEW, Replay(rig, folder / "here")), 0);
    const std::string expected = tests::FileText(folder / "here/panorama.avi");
    ASSERT_GT(expected.size(), 10'000U);
    for (const std::string processor : kProcessors) {
        std::vector<std::string> arguments = Replay(rig, folder / processor);
        arguments.insert(arguments.begin(), {"-cpu", processor, HITCHVIEW});
        ASSERT_EQ(RunProgram(QEMU_X86_64, arguments), 0);
        EXPECT_TRUE(tests::FileText(folder / (processor + "/panorama.avi")) == expected)
            << processor;
    }
}

}  // namespace
}  // namespace hitchview::app

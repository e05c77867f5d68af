#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

// The virtual machine itself: that the device tests run where they think they do.
namespace hitchview {
namespace {

class VirtualMachineTest : public testing::Test {
 protected:
    void SetUp() override {
        if (std::getenv("VM_OUT") == nullptr) GTEST_SKIP() << "not in the virtual machine";
    }
};

TEST_F(VirtualMachineTest, TheHostsFilesCannotBeChanged) {
    const std::filesystem::path file = "/usr/share/hitchview-was-here";
    std::ofstream(file) << "only in the overlay";
    EXPECT_TRUE(std::filesystem::exists(file));
    std::ifstream mounts("/proc/mounts");
    const std::string text{std::istreambuf_iterator<char>(mounts), {}};
    EXPECT_NE(text.find("overlay / overlay"), std::string::npos) << text;
}

TEST_F(VirtualMachineTest, ItsFolderOnTheHostCanBeWrittenTo) {
    std::ofstream file(std::filesystem::path(std::getenv("VM_OUT")) / "seen");
    file << "here";
    EXPECT_TRUE(file.flush());
}

TEST_F(VirtualMachineTest, ThereAreCamerasAndCanBuses) {
    for (const char* module : {"vivid", "vimc", "vcan", "vxcan"}) {
        const std::string command = std::string("modprobe --dry-run ") + module;
        EXPECT_EQ(std::system(command.c_str()), 0) << module;
    }
}

}  // namespace
}  // namespace hitchview

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace hitchview::tests {

/// libcamera's id of the kernel's virtual media controller camera.
inline constexpr const char* kVimcCamera = "platform/vimc.0 Sensor B";

inline bool ShellSucceeds(const std::string& command) {
    return std::system(command.c_str()) == 0;
}

class VimcTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!ShellSucceeds("modprobe --dry-run vimc 2>/dev/null"))
            GTEST_SKIP() << "this kernel has no virtual media controller camera (vimc)";
        if (!ShellSucceeds("udevadm control --ping 2>/dev/null"))
            GTEST_SKIP() << "udev does not run; libcamera finds cameras through it";
        ASSERT_TRUE(ShellSucceeds("modprobe vimc && udevadm trigger && udevadm settle"));
        loaded_ = true;
    }
    void TearDown() override {
        if (!loaded_) return;
        EXPECT_TRUE(ShellSucceeds("modprobe --remove vimc && udevadm settle"));
    }

 private:
    bool loaded_ = false;
};

}  // namespace hitchview::tests

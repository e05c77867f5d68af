#include "drivers/v4l2_probe.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/device/vivid.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::drivers {
namespace {

TEST(V4l2ProbeTest, TellsWhatEveryCameraIsAndCanDo) {
    if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
    const tests::Vivid vivid({.cameras = 2});
    ASSERT_TRUE(vivid.loaded());
    const tests::TemporaryFolder links;
    std::filesystem::create_symlink("/dev/video1", links / "trailer-rear");

    const auto reports = ProbeV4l2Devices({links.path()});

    ASSERT_EQ(reports.size(), 2U);
    const V4l2DeviceReport& report = reports[1];
    EXPECT_EQ(report.path, "/dev/video1");
    EXPECT_EQ(report.links, std::vector<std::string>{links / "trailer-rear"});
    EXPECT_EQ(report.driver + " " + report.card + " " + report.bus,
              "vivid vivid platform:vivid-001");
    EXPECT_NE(OffersText(report.offers).find("NV12 320x180 at "), std::string::npos);
    EXPECT_TRUE(std::ranges::any_of(report.controls, [](const V4l2Control& control) {
        return control.name == "test_pattern" && control.menu.size() > 5;
    }));
    EXPECT_FALSE(report.busy);
    EXPECT_TRUE(report.stamps_known);
    EXPECT_EQ(report.stamps, V4l2StampSource::kEndOfFrame);
    EXPECT_EQ(report.refusal, "");
}

TEST(V4l2ProbeTest, DoesNotDisturbACameraThatStreams) {
    if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
    const tests::Vivid vivid({});
    ASSERT_TRUE(vivid.loaded());
    auto camera = V4l2Camera::Open(tests::VividCamera(0));
    ASSERT_TRUE(camera.ok()) << camera.error();
    const auto reports = ProbeV4l2Devices();
    ASSERT_EQ(reports.size(), 1U);
    EXPECT_TRUE(reports[0].busy);
    EXPECT_FALSE(reports[0].stamps_known);
    EXPECT_TRUE((*camera)->WaitFrame(std::chrono::milliseconds(1000)).ok());
}

}  // namespace
}  // namespace hitchview::drivers

#include <gtest/gtest.h>

#include "app/record_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

constexpr std::int64_t kMoment_us = 1'700'000'000'000'000;  // 2023-11-14T22:13:20Z

RecordFolder Folder(const std::string& path, std::uint64_t quota_bytes = 0) {
    auto folder = RecordFolder::Open({.folder = path, .quota_bytes = quota_bytes});
    EXPECT_TRUE(folder) << folder.error();
    return std::move(folder.value());
}

TEST(RecordFolderTest, SegmentsAreNamedByTheStartAndCountedUp) {
    const tests::TemporaryFolder folder;
    RecordFolder sut = Folder(folder / "new/drives");
    sut.Begin(kMoment_us);
    EXPECT_EQ(sut.NextSegment(), folder / "new/drives/20231114T221320Z-0001.lcm");
    EXPECT_EQ(sut.NextSegment(), folder / "new/drives/20231114T221320Z-0002.lcm");
    EXPECT_EQ(sut.newest_name(), "20231114T221320Z-0002.lcm");
}

TEST(RecordFolderTest, AFileThatIsThereIsNotOverwritten) {
    const tests::TemporaryFolder folder;
    folder.Write("20231114T221320Z-0001.lcm", "mine");
    RecordFolder sut = Folder(folder.path());
    sut.Begin(kMoment_us);
    EXPECT_EQ(sut.NextSegment(), folder / "20231114T221320Z-0002.lcm");
}

TEST(RecordFolderTest, NamesStayInOrderBeyondTheLastNumber) {
    const tests::TemporaryFolder folder;
    RecordFolder sut = Folder(folder.path());
    sut.Begin(kMoment_us);
    std::string last;
    for (int i = 0; i < 10'005; ++i) {
        const std::string next = sut.NextSegment();
        ASSERT_LT(last, next);
        ASSERT_TRUE(IsSegmentName(sut.newest_name())) << next;
        last = next;
    }
}

TEST(RecordFolderTest, OnlyNamesOfSegmentsAreSegments) {
    EXPECT_TRUE(IsSegmentName("20231114T221320Z-0001.lcm"));
    for (const char* other : {"20231114T221320Z-0001.lcm.bak", "x0231114T221320Z-0001.lcm",
                              "20231114T221320Z-001.lcm", "drive.lcm", ""})
        EXPECT_FALSE(IsSegmentName(other)) << other;
}

TEST(RecordFolderTest, TheOldestRecordingsMakeRoomAndNothingElseGoes) {
    const tests::TemporaryFolder folder;
    const std::string kilobyte(1000, 'x');
    for (int i = 1; i <= 5; ++i)
        folder.Write("2023111" + std::to_string(i) + "T221320Z-0001.lcm", kilobyte);
    folder.Write("20200101T000000Z-0001.lcm.txt", kilobyte);
    folder.Write("drive.lcm", kilobyte);
    std::filesystem::create_symlink(folder / "drive.lcm", folder / "20200101T000000Z-0001.lcm");

    RecordFolder sut = Folder(folder.path(), 4000);
    sut.MakeRoom();
    EXPECT_FALSE(std::filesystem::exists(folder / "20231112T221320Z-0001.lcm"));
    EXPECT_TRUE(std::filesystem::exists(folder / "20231113T221320Z-0001.lcm"));
    for (const char* other :
         {"20200101T000000Z-0001.lcm.txt", "drive.lcm", "20200101T000000Z-0001.lcm"})
        EXPECT_TRUE(std::filesystem::exists(folder / other)) << other;
}

TEST(RecordFolderTest, TheFloorOfFreeSpaceIsKept) {
    const tests::TemporaryFolder folder;
    auto ample = RecordFolder::Open({.folder = folder.path(), .min_free_bytes = 1});
    auto none = RecordFolder::Open({.folder = folder.path(), .min_free_bytes = 1ULL << 60});
    EXPECT_TRUE(ample.value().HasSpace());
    EXPECT_FALSE(none.value().HasSpace());
    EXPECT_GT(ample.value().FreeBytes(), 0);
}

TEST(RecordFolderTest, AFolderThatCannotBeMadeIsRefusedByName) {
    const tests::TemporaryFolder folder;
    folder.Write("file", "");
    const auto refused = RecordFolder::Open({.folder = folder / "file/drives"});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().find("file/drives"), std::string::npos);
}

}  // namespace
}  // namespace hitchview::app

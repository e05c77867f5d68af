#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "app/web_recordings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

TEST(WebRecordingsTest, OnlyRegularLogsDirectlyInTheFolderAreListed) {
    const tests::TemporaryFolder folder;
    folder.Write("b.lcm", "12345");
    folder.Write("notes.txt", "secret");
    folder.Write(".hidden.lcm", "x");
    std::filesystem::create_directory(folder / "folder.lcm");
    std::filesystem::create_symlink("/etc/passwd", folder / "link.lcm");
    ASSERT_EQ(mkfifo((folder / "pipe.lcm").c_str(), 0600), 0);
    const json list = json::parse(WebRecordings(folder.path()).List());
    EXPECT_EQ(list["folder"], true);
    ASSERT_EQ(list["files"].size(), 1U) << list;
    EXPECT_EQ(list["files"][0]["name"], "b.lcm");
    EXPECT_EQ(list["files"][0]["bytes"], 5);
}

TEST(WebRecordingsTest, WhatIsNotListedCannotBeOpened) {
    const tests::TemporaryFolder folder;
    folder.Write("b.lcm", "12345");
    folder.Write("notes.txt", "secret");
    std::filesystem::create_directory(folder / "folder.lcm");
    std::filesystem::create_symlink("b.lcm", folder / "link.lcm");
    ASSERT_EQ(mkfifo((folder / "pipe.lcm").c_str(), 0600), 0);
    const WebRecordings recordings(folder.path());
    for (const char* name : {"", "notes.txt", "folder.lcm", "link.lcm", "pipe.lcm", "absent.lcm",
                             "../b.lcm", "./b.lcm", "/etc/passwd"}) {
        EXPECT_FALSE(recordings.Open(name)) << name;
    }
    EXPECT_FALSE(WebRecordings("").Open("b.lcm"));
    const auto recording = recordings.Open("b.lcm");
    ASSERT_TRUE(recording);
    EXPECT_EQ(recording.value().size_bytes, 5U);
    close(recording.value().descriptor);
}

TEST(WebRecordingsTest, ARecordingThatGrowsGetsAnotherTag) {
    const tests::TemporaryFolder folder;
    const auto tag = [&] {
        const auto recording = WebRecordings(folder.path()).Open("b.lcm");
        close(recording.value().descriptor);
        return recording.value().tag;
    };
    folder.Write("b.lcm", "12345");
    const std::string before = tag();
    EXPECT_EQ(tag(), before);
    folder.Write("b.lcm", "123456");
    EXPECT_NE(tag(), before);
}

TEST(WebRecordingsTest, WithoutAFolderTheListSaysSo) {
    EXPECT_EQ(json::parse(WebRecordings("").List()),
              (json{{"folder", false}, {"files", json::array()}}));
}

}  // namespace
}  // namespace hitchview::app

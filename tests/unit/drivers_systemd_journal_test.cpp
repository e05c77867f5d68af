#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <map>
#include <set>

#include "drivers/systemd_journal.hpp"
#include "tests/support/datagram_listener.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::drivers {
namespace {

using hal::Event;
using hal::EventCode;
using tests::DatagramListener;

/// Reads an entry as systemd does.
std::map<std::string, std::string> FieldsOf(const std::string& datagram) {
    std::map<std::string, std::string> fields;
    std::size_t at = 0;
    while (at < datagram.size()) {
        const std::size_t end = datagram.find_first_of("=\n", at);
        const std::string name = datagram.substr(at, end - at);
        std::size_t length = 0;
        if (datagram.at(end) == '=') {
            at = end + 1;
            length = datagram.find('\n', at) - at;
        } else {
            for (std::size_t i = 0; i < 8; ++i)
                length |= std::size_t{static_cast<unsigned char>(datagram.at(end + 1 + i))}
                          << (8 * i);
            at = end + 9;
        }
        EXPECT_TRUE(fields.emplace(name, datagram.substr(at, length)).second) << name;
        at += length;
        EXPECT_EQ(datagram.at(at), '\n');
        ++at;
    }
    return fields;
}

class SystemdJournalTest : public testing::Test {
 protected:
    std::map<std::string, std::string> Written(const Event& event) {
        log_->Add(event);
        const auto datagram = journal_.Take(std::chrono::seconds(5));
        EXPECT_TRUE(datagram);
        return FieldsOf(datagram.value_or(""));
    }

    tests::TemporaryFolder folder_;
    const std::string path_ = folder_ / "journal";
    DatagramListener journal_{path_};
    std::unique_ptr<hal::EventLog> log_ = SystemdJournal::Open("8:1", path_.c_str());
};

TEST_F(SystemdJournalTest, AnEventOfACameraHasTheseFields) {
    using Fields = std::map<std::string, std::string>;
    EXPECT_EQ(Written({EventCode::kCameraLost, {}, {"rear"}, {"lost: silent"}}),
              (Fields{{"MESSAGE", "camera rear: lost: silent"},
                      {"MESSAGE_ID", "1a40b6adaa2b407d99fa96cc61589a43"},
                      {"PRIORITY", "4"},
                      {"SYSLOG_IDENTIFIER", "hitchview"},
                      {"HITCHVIEW_EVENT", "camera_lost"},
                      {"HITCHVIEW_CODE", "1"},
                      {"HITCHVIEW_SUBJECT", "rear"},
                      {"CAMERA", "rear"}}));
}

TEST_F(SystemdJournalTest, OtherEventsHaveNoCamera) {
    auto seam = Written({EventCode::kSeamCoast, {}, {"left"}, {"12 matches"}});
    EXPECT_EQ(seam["MESSAGE"], "left: 12 matches");
    EXPECT_EQ(seam["HITCHVIEW_CODE"], "21");
    EXPECT_EQ(seam.count("CAMERA"), 0U);
    auto deadline = Written({EventCode::kDeadlineMissed, {}, {}, {"too late"}});
    EXPECT_EQ(deadline["MESSAGE"], "too late");
    EXPECT_EQ(deadline.count("HITCHVIEW_SUBJECT"), 0U);
}

TEST_F(SystemdJournalTest, EachFamilyOfCodesHasAnIdOfItsOwnAndEachCodeOne) {
    std::map<int, std::set<std::string>> ids;
    std::set<std::string> all;
    for (const EventCode code : hal::kEventCodes) {
        auto fields = Written({code, {}, {"x"}, {"y"}});
        EXPECT_EQ(fields["HITCHVIEW_EVENT"], ToString(code));
        EXPECT_EQ(fields["MESSAGE_ID"].size(), 32U);
        ids[static_cast<int>(code) / 20].insert(fields["MESSAGE_ID"]);
        all.insert(fields["MESSAGE_ID"]);
    }
    for (const auto& [family, of_family] : ids) EXPECT_EQ(of_family.size(), 1U) << family;
    EXPECT_EQ(all.size(), ids.size());
}

TEST_F(SystemdJournalTest, AValueOfSeveralLinesMakesNoFieldOfItsOwn) {
    auto fields = Written({EventCode::kCameraLost, {}, {"rear\nX=1"}, {"a\nPRIORITY=0\nb"}});
    EXPECT_EQ(fields["MESSAGE"], "camera rear\nX=1: a\nPRIORITY=0\nb");
    EXPECT_EQ(fields["CAMERA"], "rear\nX=1");
    EXPECT_EQ(fields["PRIORITY"], "4");
    EXPECT_EQ(fields.size(), 8U);
}

TEST_F(SystemdJournalTest, TheLongestEventIsWhole) {
    const std::string subject(63, '\n');
    const std::string text(191, '\n');
    auto fields = Written({EventCode::kCameraBack, {}, {subject}, {text}});
    EXPECT_EQ(fields["MESSAGE"], "camera " + subject + ": " + text);
    EXPECT_EQ(fields["CAMERA"], subject);
}

TEST_F(SystemdJournalTest, ATooSlowJournalIsNotWaitedForAndNoMemoryIsTaken) {
    const Event event{EventCode::kCameraLost, {}, {"rear"}, {"lost: silent"}};
    constexpr int kMoreThanItsQueueHolds = 5000;
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    for (int i = 0; i < kMoreThanItsQueueHolds; ++i) log_->Add(event);
    const std::uint64_t calls = tests::HeapCallsOfThisThread() - before;
    EXPECT_LT(journal_.TakeAll().size(), kMoreThanItsQueueHolds);
    if (tests::kHeapCallsAreCounted) {
        EXPECT_EQ(calls, 0U);
    }
}

TEST_F(SystemdJournalTest, WithoutAJournalThereIsNoLog) {
    EXPECT_EQ(SystemdJournal::Open(nullptr, path_.c_str()), nullptr);
    EXPECT_EQ(SystemdJournal::Open("8:1", (folder_ / "nowhere").c_str()), nullptr);
    EXPECT_EQ(SystemdJournal::Open("8:1", folder_.Write("file", "").c_str()), nullptr);
}

TEST_F(SystemdJournalTest, ItKnowsWhetherStderrIsTheJournals) {
    struct stat file {};
    ASSERT_EQ(fstat(STDERR_FILENO, &file), 0);
    const std::string stream = std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino);
    EXPECT_TRUE(SystemdJournal::Open(stream.c_str(), path_.c_str())->has_stderr());
    EXPECT_FALSE(SystemdJournal::Open((stream + "1").c_str(), path_.c_str())->has_stderr());
}

}  // namespace
}  // namespace hitchview::drivers

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "app/program.hpp"
#include "tests/support/healthy_machine.hpp"

namespace hitchview::app {
namespace {

using testing::HasSubstr;
using testing::Lt;

DoctorCheck Check(const char* name, Finding finding, std::vector<std::string> needs = {}) {
    return {name,
            [=] {
                return Diagnosis{finding, std::string("what of ") + name,
                                 finding == Finding::kBad ? "mend it" : ""};
            },
            std::move(needs)};
}

TEST(DoctorAnswersTest, WhatIsBadAfterAnotherIsUnknownAndNamesTheFirst) {
    const auto answers = RunChecks(
        {Check("first", Finding::kBad), Check("second", Finding::kBad, {"other", "first"}),
         Check("third", Finding::kBad, {"second"}), Check("alone", Finding::kBad)});
    EXPECT_EQ(answers[0].diagnosis.finding, Finding::kBad);
    EXPECT_EQ(answers[1].diagnosis.finding, Finding::kUnknown);
    EXPECT_EQ(answers[1].diagnosis.what, "after first: what of second");
    EXPECT_EQ(answers[1].diagnosis.remedy, "");
    EXPECT_EQ(answers[2].diagnosis.what, "after first: what of third");
    EXPECT_EQ(answers[3].diagnosis.finding, Finding::kBad);
}

TEST(DoctorAnswersTest, WhatIsGoodOrBadByItselfIsTold) {
    const auto answers =
        RunChecks({Check("first", Finding::kBad), Check("good", Finding::kGood, {"first"}),
                   Check("unknown", Finding::kUnknown), Check("bad", Finding::kBad, {"unknown"})});
    EXPECT_EQ(answers[1].diagnosis.finding, Finding::kGood);
    EXPECT_EQ(answers[3].diagnosis.finding, Finding::kBad);
}

TEST(DoctorAnswersTest, ACheckThatHangsIsBadAndTheOthersAreAsked) {
    const DoctorCheck hangs{"hangs", [] {
                                std::this_thread::sleep_for(std::chrono::seconds(1));
                                return Diagnosis{Finding::kGood, "at last", ""};
                            }};
    const auto answers =
        RunChecks({hangs, Check("good", Finding::kGood)}, std::chrono::milliseconds(50));
    EXPECT_EQ(answers[0].diagnosis.finding, Finding::kBad);
    EXPECT_THAT(answers[0].diagnosis.what, HasSubstr("no answer within 50 ms"));
    EXPECT_EQ(answers[1].diagnosis.finding, Finding::kGood);
    std::this_thread::sleep_for(std::chrono::seconds(1));
}

TEST(DoctorAnswersTest, ATableHasOneLineForEachWhateverTheTextsHold) {
    const std::vector<DoctorAnswer> answers{{"a", {Finding::kGood, "fi\nne\x1b[2J", ""}},
                                            {"longer", {Finding::kUnknown, "not seen", ""}},
                                            {"b", {Finding::kBad, "broken", "mend it"}}};
    EXPECT_EQ(DoctorTable(answers),
              "good     a       fi ne [2J\n"
              "unknown  longer  not seen\n"
              "bad      b       broken\n"
              "                 -> mend it\n");
}

TEST(DoctorAnswersTest, JsonHasASchemaAndIsWholeWhateverTheTextsHold) {
    const auto json =
        nlohmann::json::parse(DoctorJson({{"a", {Finding::kBad, "cut off \xc3", "mend \"it\""}},
                                          {"b", {Finding::kUnknown, "after a", ""}}}));
    EXPECT_EQ(json["schema"], 1);
    EXPECT_EQ(json["ready"], false);
    ASSERT_EQ(json["checks"].size(), 2U);
    EXPECT_EQ(json["checks"][0]["check"], "a");
    EXPECT_EQ(json["checks"][0]["verdict"], "bad");
    EXPECT_EQ(json["checks"][0]["remedy"], "mend \"it\"");
    EXPECT_EQ(json["checks"][1]["verdict"], "unknown");
}

TEST(DoctorAnswersTest, NamesAreUniqueAndWhatIsNeededComesBefore) {
    tests::HealthyMachine machine;
    std::set<std::string> names;
    for (const DoctorCheck& check : AllChecks(ExamineMachine(machine.Machine(), ""))) {
        for (const std::string& need : check.needs)
            EXPECT_TRUE(names.contains(need)) << check.name << " needs " << need;
        EXPECT_TRUE(names.insert(check.name).second) << check.name;
    }
}

TEST(DoctorAnswersTest, ThePageOfChecksNamesEachOfThem) {
    tests::HealthyMachine machine;
    const std::string page = tests::FileText(HITCHVIEW_SOURCE_DIR "/docs/doctor.md");
    for (const DoctorCheck& check : AllChecks(ExamineMachine(machine.Machine(), "")))
        EXPECT_THAT(page, HasSubstr("| `" + std::string(check.name) + "` |"));
}

TEST(DoctorMachineFilesTest, FilesAreReadBelowTheRootAndNotWaitedFor) {
    tests::TemporaryFolder folder;
    const DoctorMachine machine{.root = folder.path()};
    EXPECT_EQ(machine.At("/etc/x"), std::filesystem::path(folder / "etc/x"));
    EXPECT_EQ(machine.At(folder / "etc/x"), std::filesystem::path(folder / "etc/x"));
    EXPECT_EQ(DoctorMachine{}.At("/etc/x"), std::filesystem::path("/etc/x"));
    EXPECT_EQ(ReadText(folder.Write("text", "one\ntwo \n\n")), "one\ntwo");
    EXPECT_EQ(ReadNumber(folder.Write("number", "-42\n")), -42);
    EXPECT_EQ(ReadNumber(folder.Write("none", "42 apples\n")), std::nullopt);
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(ReadText(folder / "pipe"), std::nullopt);
    EXPECT_EQ(ReadText(folder.path()), std::nullopt);
    EXPECT_EQ(ReadText(folder / "nothing"), std::nullopt);
    EXPECT_EQ(ReadText("/dev/zero"), std::nullopt);
}

TEST(OutputOfProgramTest, GivesWhatWasWritten) {
    EXPECT_EQ(OutputOf("/bin/echo", {"one", "two"}, std::chrono::seconds(5)), "one two\n");
    EXPECT_EQ(OutputOf("/bin/cat", {}, std::chrono::seconds(5)), "") << "there is nothing to read";
}

TEST(OutputOfProgramTest, WhatFailsGivesNothing) {
    EXPECT_EQ(OutputOf("/bin/sh", {"-c", "echo text; exit 1"}, std::chrono::seconds(5)),
              std::nullopt);
    EXPECT_EQ(OutputOf("/nothing/there", {}, std::chrono::seconds(5)), std::nullopt);
}

TEST(OutputOfProgramTest, WhatHangsOrNeverStopsWritingIsEnded) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const std::chrono::milliseconds limit(200);
    EXPECT_EQ(OutputOf("/bin/sleep", {"30"}, limit), std::nullopt);
    EXPECT_EQ(OutputOf("/bin/sh", {"-c", "exec >&-; sleep 30"}, limit), std::nullopt);
    EXPECT_EQ(OutputOf("/bin/sh", {"-c", "sleep 30; true"}, limit), std::nullopt);
    EXPECT_EQ(OutputOf("/usr/bin/yes", {}, limit), std::nullopt);
    EXPECT_THAT(Clock::now() - start, Lt(std::chrono::seconds(15)));
}

}  // namespace
}  // namespace hitchview::app

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "app/doctor_answers.hpp"
#include "app/doctor_verb.hpp"
#include "tests/support/temporary_folder.hpp"

// What the doctor says of networks that are made ill and healed again. Runs in a network namespace
// of its own (tests/support/lcm_namespace.sh).
namespace hitchview::app {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::map<std::string, Diagnosis> AskOf(const PublishConfig& publish) {
    std::map<std::string, Diagnosis> diagnoses;
    const auto subject = std::make_shared<DoctorSubject>();
    subject->machine = ThisMachine();
    subject->rig.config.publish = publish;
    for (const DoctorAnswer& answer : RunChecks(LcmChecks(subject)))
        diagnoses[answer.name] = answer.diagnosis;
    return diagnoses;
}

int Shell(const char* command) {
    return std::system(command);
}

TEST(LcmDoctorTest, AHealthyNetworkIsGood) {
    for (const auto& [name, diagnosis] : AskOf({})) {
        EXPECT_EQ(diagnosis.finding, Finding::kGood) << name << ": " << diagnosis.what;
        EXPECT_EQ(diagnosis.remedy, "");
    }
}

TEST(LcmDoctorTest, AMissingRouteIsFoundAndItsRemedyHelps) {
    ASSERT_EQ(Shell("ip route del 224.0.0.0/4"), 0);
    auto ill = AskOf({});
    EXPECT_EQ(ill["lcm_multicast_route"].finding, Finding::kBad);
    EXPECT_EQ(ill["lcm_delivery"].finding, Finding::kUnknown);
    EXPECT_THAT(ill["lcm_delivery"].what, StartsWith("after lcm_multicast_route"));
    EXPECT_THAT(ill["lcm_multicast_route"].remedy, HasSubstr("ip route add 224.0.0.0/4 dev lo"));
    ASSERT_EQ(Shell("ip route add 224.0.0.0/4 dev lo"), 0);
    EXPECT_EQ(AskOf({})["lcm_multicast_route"].finding, Finding::kGood);
}

TEST(LcmDoctorTest, AnInterfaceWithoutMulticastIsFoundAndItsRemedyHelps) {
    ASSERT_EQ(Shell("ip link set lo multicast off"), 0);
    auto ill = AskOf({});
    EXPECT_EQ(ill["lcm_loopback_multicast"].finding, Finding::kBad);
    EXPECT_EQ(ill["lcm_loopback_multicast"].remedy, "ip link set lo multicast on");
    ASSERT_EQ(Shell(ill["lcm_loopback_multicast"].remedy.c_str()), 0);
    EXPECT_EQ(AskOf({})["lcm_loopback_multicast"].finding, Finding::kGood);
}

TEST(LcmDoctorTest, ABudgetThatTheUsualBufferCannotHoldIsFound) {
    auto diagnoses = AskOf({.max_bytes = 4'000'000});
    const Diagnosis& usual = diagnoses["lcm_usual_receive_buffer"];
    if (usual.finding == Finding::kGood) GTEST_SKIP() << usual.what;
    EXPECT_EQ(usual.finding, Finding::kBad);
    EXPECT_THAT(usual.remedy, HasSubstr("90-hitchview.conf"));
}

TEST(LcmDoctorTest, WhatIsNoNetworkIsNotJudged) {
    auto diagnoses = AskOf({.url = "file:///tmp/nowhere.lcm?mode=w"});
    EXPECT_EQ(diagnoses["lcm_delivery"].finding, Finding::kUnknown);
}

TEST(DoctorVerbTest, OnThisMachineNothingTakesLongAndWhatIsBadHasARemedy) {
    const auto start = std::chrono::steady_clock::now();
    for (const auto& [name, diagnosis] : RunChecks(AllChecks(ExamineMachine(ThisMachine(), "")))) {
        EXPECT_NE(diagnosis.what, "") << name;
        EXPECT_EQ(diagnosis.remedy.empty(), diagnosis.finding != Finding::kBad) << name;
        EXPECT_THAT(diagnosis.what, Not(HasSubstr("no answer within"))) << name;
    }
    EXPECT_THAT(std::chrono::steady_clock::now() - start, testing::Lt(std::chrono::seconds(20)));
}

TEST(DoctorVerbTest, ARigFileThatIsGivenAndWrongIsWrongUse) {
    tests::TemporaryFolder folder;
    testing::internal::CaptureStderr();
    EXPECT_EQ(DoctorVerb({.rig = folder.Write("rig.yaml", "schema: 2\n")}), 2);
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("rig.yaml:1: schema is 2"));
}

TEST(DoctorVerbTest, ARigWithoutItsCameraIsBadAndJsonSaysWhich) {
    tests::TemporaryFolder folder;
    const std::string rig = folder.Write(
        "rig.yaml",
        "schema: 1\ncanvas: {projection: plane, size_px: [640, 360]}\nunits: {tractor: {cameras: "
        "[{name: left, source: {v4l2: /dev/hitchview/nothing}}]}}\n");
    testing::internal::CaptureStdout();
    EXPECT_EQ(DoctorVerb({.rig = rig, .json = true}), 1);
    const auto json = nlohmann::json::parse(testing::internal::GetCapturedStdout());
    EXPECT_EQ(json["ready"], false);
    for (const auto& check : json["checks"]) {
        if (check["check"] == "camera_devices") {
            EXPECT_EQ(check["verdict"], "bad");
        }
    }
}

TEST(DoctorVerbTest, AnAnswerThatCannotBeWrittenIsAFailureOfTheMachine) {
    const auto ask = [] {
        if (std::freopen("/dev/full", "w", stdout) == nullptr) std::exit(99);
        std::exit(DoctorVerb({}));
    };
    EXPECT_EXIT(ask(), testing::ExitedWithCode(3), "the answer cannot be written");
}

}  // namespace
}  // namespace hitchview::app

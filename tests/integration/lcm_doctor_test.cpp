#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "app/doctor_answers.hpp"

// What the doctor says of networks that are made ill and healed again. Runs in a network namespace
// of its own (tests/support/lcm_namespace.sh).
namespace hitchview::app {
namespace {

using testing::HasSubstr;
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

}  // namespace
}  // namespace hitchview::app

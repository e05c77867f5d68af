#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/healthy_machine.hpp"

// The same of what is installed: slots of releases, services, and what they publish.
namespace hitchview::app {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class DoctorServiceTest : public testing::Test {
 protected:
    void SetUp() override { ASSERT_THAT(machine_.Names(Finding::kBad), IsEmpty()); }
    void ExpectBad(const std::string& check, const std::string& what, const std::string& remedy) {
        EXPECT_THAT(machine_.Names(Finding::kBad), ElementsAre(check));
        const Diagnosis diagnosis = machine_.Answer(check);
        EXPECT_THAT(diagnosis.what, HasSubstr(what));
        EXPECT_THAT(diagnosis.remedy, HasSubstr(remedy));
    }

    tests::HealthyMachine machine_;
};

TEST_F(DoctorServiceTest, AReleaseThatWasRolledBack) {
    machine_.Write("opt/hitchview/slots/rolled-back",
                   "release=0.3.0\nslot=b\nwhy=fewer than 300 good panoramas\n"
                   "when=2026-11-22T19:51:39Z\n");
    machine_.failed_units = "hitchview-trial.service loaded failed failed Hitchview: trial\n";
    ExpectBad("slot_rollback",
              "release 0.3.0 was rolled back at 2026-11-22T19:51:39Z: fewer than 300",
              "hitchview-slots acknowledge");
    EXPECT_THAT(machine_.Answer("service_units").what, StartsWith("after slot_rollback"));
}

TEST_F(DoctorServiceTest, AReleaseOnTrialIsTold) {
    machine_.Write("opt/hitchview/slots/trial", "slot=a\nboots_left=2\n");
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty());
    EXPECT_EQ(machine_.Answer("slot_programs").what,
              "release 0.2.0 in slot a, on trial: 2 starts left to prove itself");
}

TEST_F(DoctorServiceTest, ASlotThatIsGone) {
    machine_.Remove("opt/hitchview/slots/a");
    ExpectBad("slot_programs", "lacks bin/hitchview", "--reinstall hitchview");
}

TEST_F(DoctorServiceTest, ACurrentSlotThatIsNone) {
    for (const char* target : {"c", "/opt/hitchview/slots/a", "../../etc"}) {
        machine_.Remove("opt/hitchview/slots/current");
        std::filesystem::create_symlink(target, machine_.Path("opt/hitchview/slots/current"));
        ExpectBad("slot_programs", "leads to no slot", "--reinstall hitchview");
    }
    machine_.Remove("opt/hitchview/slots/current");
    ExpectBad("slot_programs", "leads to no slot", "--reinstall hitchview");
}

TEST_F(DoctorServiceTest, AProgramThatCannotBeRun) {
    chmod(machine_.Path("opt/hitchview/slots/a/bin/hitchview-web").c_str(), 0644);
    ExpectBad("slot_programs", "lacks bin/hitchview-web", "--reinstall hitchview");
}

TEST_F(DoctorServiceTest, WithoutSlotsNothingIsJudged) {
    machine_.Remove("opt");
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty());
    EXPECT_THAT(machine_.Names(Finding::kUnknown), ElementsAre("slot_programs", "slot_rollback"));
}

TEST_F(DoctorServiceTest, AServiceThatDoesNotStartWithTheMachine) {
    machine_.service["UnitFileState"] = "disabled";
    ExpectBad("service_enabled", "hitchview.service is disabled", "systemctl enable --now");
    machine_.service["ActiveState"] = "inactive";
    ExpectBad("service_enabled", "hitchview.service is disabled", "systemctl enable --now");
}

TEST_F(DoctorServiceTest, AServiceThatMayNotStart) {
    machine_.service["LoadState"] = "masked";
    machine_.service["UnitFileState"] = "masked";
    machine_.service["ActiveState"] = "inactive";
    ExpectBad("service_enabled", "masked", "systemctl unmask hitchview");
}

TEST_F(DoctorServiceTest, AServiceThatWasStopped) {
    machine_.service["ActiveState"] = "inactive";
    machine_.service["SubState"] = "dead";
    ExpectBad("service", "inactive (dead)", "systemctl start hitchview");
    machine_.recorder["ActiveState"] = "active";
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty());
}

TEST_F(DoctorServiceTest, AServiceThatFailed) {
    machine_.service["ActiveState"] = "failed";
    machine_.service["Result"] = "exit-code";
    ExpectBad("service", "the last time by exit-code", "journalctl --unit hitchview.service");
}

TEST_F(DoctorServiceTest, AServiceThatStartsAgainAndAgain) {
    machine_.service["ActiveState"] = "activating";
    machine_.service["SubState"] = "start";
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty()) << "it may come up yet";
    machine_.service["NRestarts"] = "12";
    ExpectBad("service", "12 restarts, and starts once more", "journalctl");
}

TEST_F(DoctorServiceTest, AnotherUnitThatFailed) {
    machine_.failed_units = "hitchview-web.service loaded failed failed Hitchview: page\n";
    ExpectBad("service_units", "hitchview-web.service", "journalctl --unit hitchview-web.service");
}

TEST_F(DoctorServiceTest, TheRouteThatFailedIsNotToldTwice) {
    machine_.failed_units = "hitchview-lcm-route.service loaded failed failed Hitchview: route\n";
    machine_.multicast_source = ENETUNREACH;
    ExpectBad("lcm_multicast_route", "not routed", "hitchview-lcm-route");
}

TEST_F(DoctorServiceTest, AServiceThatPublishesElsewhere) {
    machine_.url_of_service = "udpm://239.255.76.67:7668?ttl=0";
    ExpectBad("display_stream", "no panorama on PANORAMA", "systemctl restart hitchview");
}

TEST_F(DoctorServiceTest, WithoutSystemdNothingIsJudged) {
    machine_.Remove("run");
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty());
    EXPECT_THAT(machine_.Names(Finding::kUnknown), Contains("service"));
    EXPECT_THAT(machine_.Answer("real_time_priority").what, HasSubstr("threads may have"));
}

TEST_F(DoctorServiceTest, ASystemdThatAnswersNothingIsNotTrusted) {
    auto machine = machine_.Machine();
    for (const char* text :
         {"", "=\n=\n", "LoadState", "\0\xff\n", "NRestarts=99999999999999999999"}) {
        machine.output = [text](const auto&) { return std::string(text); };
        for (const DoctorAnswer& answer : RunChecks(AllChecks(ExamineMachine(machine, ""))))
            EXPECT_NE(answer.diagnosis.finding, Finding::kBad) << answer.name;
    }
}

}  // namespace
}  // namespace hitchview::app

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/healthy_machine.hpp"

// Of each breakage of a machine that is otherwise whole, exactly one check is bad: the one whose
// remedy mends it.
namespace hitchview::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class DoctorMachineTest : public testing::Test {
 protected:
    void SetUp() override {
        ASSERT_THAT(machine_.Names(Finding::kBad), IsEmpty());
        ASSERT_THAT(machine_.Names(Finding::kUnknown), IsEmpty());
    }
    /// The one that is bad, which has a remedy.
    void ExpectBad(const std::string& check, const std::string& what, const std::string& remedy) {
        EXPECT_THAT(machine_.Names(Finding::kBad), ElementsAre(check));
        const Diagnosis diagnosis = machine_.Answer(check);
        EXPECT_THAT(diagnosis.what, HasSubstr(what));
        EXPECT_THAT(diagnosis.remedy, HasSubstr(remedy));
    }

    tests::HealthyMachine machine_;
};

TEST_F(DoctorMachineTest, TheClockOfAMachineWhoseBatteryIsFlat) {
    machine_.now = std::chrono::system_clock::time_point(std::chrono::hours(24));
    ExpectBad("system_clock", "it is 1970-01-02T00:00:00Z", "timedatectl set-time");
}

TEST_F(DoctorMachineTest, AClockBeforeTheProgramWasBuilt) {
    machine_.Write("usr/bin/hitchview", "");
    machine_.now = std::chrono::system_clock::now() - std::chrono::hours(24);
    ExpectBad("system_clock", "which is before", "hwclock --systohc");
}

TEST_F(DoctorMachineTest, AClockSourceThatCountsTicks) {
    machine_.Write("sys/devices/system/clocksource/clocksource0/current_clocksource",
                   "refined-jiffies\n");
    ExpectBad("clock_source", "refined-jiffies", "tsc hpet");
}

TEST_F(DoctorMachineTest, AGovernorThatHoldsTheLowestClock) {
    machine_.Write("sys/devices/system/cpu/cpufreq/policy4/scaling_governor", "powersave\n");
    ExpectBad("cpu_governor", "the lowest clock of policy4", "scaling_governor");
}

TEST_F(DoctorMachineTest, PowersaveOfADriverThatTakesItForAHintIsGood) {
    for (const char* policy : {"policy0", "policy4"}) {
        const std::string folder = "sys/devices/system/cpu/cpufreq/" + std::string(policy);
        machine_.Write(folder + "/scaling_governor", "powersave\n");
        machine_.Write(folder + "/scaling_driver", "intel_pstate\n");
    }
    EXPECT_EQ(machine_.Answer("cpu_governor").finding, Finding::kGood);
}

TEST_F(DoctorMachineTest, AJetsonInALimitedPowerMode) {
    machine_.power_mode = "NV Power Mode: MODE_30W\n2\n";
    machine_.Write("sys/devices/system/cpu/cpufreq/policy0/scaling_min_freq", "729600\n");
    ExpectBad("power_mode", "MODE_30W", "nvpmodel -m 0");
}

TEST_F(DoctorMachineTest, AJetsonWhoseClocksVary) {
    machine_.Write("sys/devices/system/cpu/cpufreq/policy0/scaling_min_freq", "729600\n");
    ExpectBad("jetson_clocks", "policy0", "jetson_clocks");
}

TEST_F(DoctorMachineTest, AnotherMachineHasNoPowerModes) {
    machine_.Remove("etc/nv_tegra_release");
    machine_.power_mode = "NV Power Mode: MODE_30W\n2\n";
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty());
    EXPECT_THAT(machine_.Names(Finding::kUnknown), ElementsAre("power_mode", "jetson_clocks"));
}

TEST_F(DoctorMachineTest, AServiceWithoutRealTimePriority) {
    machine_.service["LimitRTPRIO"] = "0";
    ExpectBad("real_time_priority", "up to 0, not 1", "LimitRTPRIO=50");
}

TEST_F(DoctorMachineTest, AServiceThatMayHaveLessPriorityThanItsRigAsksFor) {
    machine_.Replace("etc/hitchview/rig.yaml", "units:", "threads: {priority: 60}\nunits:");
    ExpectBad("real_time_priority", "up to 50, not 60", "LimitRTPRIO=");
}

TEST_F(DoctorMachineTest, AServiceThatMayNotLockItsMemory) {
    machine_.service["LimitMEMLOCK"] = "8388608";
    ExpectBad("real_time_memory_lock", "8388608 bytes", "LimitMEMLOCK=infinity");
}

TEST_F(DoctorMachineTest, AKernelThatStopsRealTimeThreadsInBetween) {
    machine_.Write("proc/sys/kernel/sched_rt_runtime_us", "200000\n");
    ExpectBad("real_time_bandwidth", "200000 of 1000000", "kernel.sched_rt_runtime_us=950000");
}

TEST_F(DoctorMachineTest, TooLittleMemoryForARunThatHasNotBegun) {
    machine_.Write("proc/meminfo", "MemAvailable: 200000 kB\n");
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty()) << "the service has its memory already";
    machine_.service["ActiveState"] = "failed";
    ExpectBad("memory", "205 MB are available", "record.memory_mb");
}

TEST_F(DoctorMachineTest, AServiceWithoutRoomForItsRecorder) {
    machine_.Replace("etc/hitchview/rig.yaml", "quota_mb: 100", "quota_mb: 100, memory_mb: 2000");
    ExpectBad("memory_limit", "the service may have 1074 MB", "MemoryMax=");
}

TEST_F(DoctorMachineTest, RecordingsThatBelongToAnother) {
    machine_.MakeFolder("var/lib/hitchview/recordings", 0755);
    ExpectBad("record_folder", "user hitchview may not write to", "install --directory --owner=");
}

TEST_F(DoctorMachineTest, RecordingsBelowAFolderThatMayNotBePassed) {
    machine_.MakeFolder("var/lib/hitchview", 0700);
    ExpectBad("record_folder", "user hitchview may not write to", "install --directory");
}

TEST_F(DoctorMachineTest, AMissingFolderOfRecordingsIsMadeWhereItMayBe) {
    machine_.Remove("var/lib/hitchview/recordings");
    ExpectBad("record_folder", "may not write to", "install --directory");
    machine_.MakeFolder("var/lib/hitchview", 0775);
    EXPECT_THAT(machine_.Answer("record_folder").what, HasSubstr("may make"));
}

TEST_F(DoctorMachineTest, RecordingsOutsideTheSandbox) {
    machine_.MakeFolder("data", 0777);
    machine_.Replace("etc/hitchview/rig.yaml", "/var/lib/hitchview/recordings", "/data");
    ExpectBad("record_folder", "the service may not write to /data", "ReadWritePaths=/data");
    machine_.service["ReadWritePaths"] = "-/data";
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty());
}

TEST_F(DoctorMachineTest, ADiskThatIsFull) {
    machine_.Replace("etc/hitchview/rig.yaml", "min_free_mb: 1", "min_free_mb: 10000000");
    ExpectBad("record_space", "recordings leave 10000000 MB", "quota_mb");
}

TEST_F(DoctorMachineTest, AQuotaThatTheDiskDoesNotHave) {
    machine_.Replace("etc/hitchview/rig.yaml", "quota_mb: 100", "quota_mb: 10000000");
    ExpectBad("record_quota", "recordings may have 10000000 MB", "lower record.quota_mb");
}

TEST_F(DoctorMachineTest, ReceiveBuffersThatLargePanoramasDoNotFit) {
    machine_.Replace("etc/hitchview/rig.yaml", "units:", "publish: {max_bytes: 4000000}\nunits:");
    ExpectBad("lcm_receive_buffer", "rmem_max is 212992", "90-hitchview.conf");
    machine_.buffers.largest_bytes = 16'777'216;
    ExpectBad("lcm_usual_receive_buffer", "rmem_default is 212992", "90-hitchview.conf");
}

TEST_F(DoctorMachineTest, ReceiveBuffersBelowTheKernelsOwn) {
    machine_.buffers.largest_bytes = 65'536;
    ExpectBad("lcm_receive_buffer", "rmem_max is 65536", "90-hitchview.conf");
}

TEST_F(DoctorMachineTest, NoRouteForMulticast) {
    machine_.multicast_source = ENETUNREACH;
    ExpectBad("lcm_multicast_route", "not routed", "ip route add 224.0.0.0/4");
    machine_.loopback_flags = IFF_UP;
    ExpectBad("lcm_multicast_route", "not routed", "ip route add 224.0.0.0/4");
}

TEST_F(DoctorMachineTest, MulticastThatGoesByAnotherInterfaceThanIsConfigured) {
    machine_.Write("proc/net/route", machine_.RouteLine("eth0", "0.0.0.0", "0.0.0.0"));
    machine_.multicast_source = std::string("192.0.2.7");
    ExpectBad("lcm_multicast_route", "routed to eth0, /etc/hitchview/network says lo",
              "systemctl restart hitchview-lcm-route");
    machine_.Write("etc/hitchview/network", "interface=eth0\n");
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty());
}

TEST_F(DoctorMachineTest, ARouteOfLcmsGroupAloneComesBeforeThatOfAllMulticast) {
    machine_.Write("proc/net/route",
                   machine_.RouteLine("eth1", "239.255.76.67", "255.255.255.255") +
                       machine_.RouteLine("lo", "224.0.0.0", "240.0.0.0"));
    ExpectBad("lcm_multicast_route", "routed to eth1", "hitchview-lcm-route");
}

TEST_F(DoctorMachineTest, LoopbackThatIsDown) {
    machine_.loopback_flags = IFF_MULTICAST;
    machine_.multicast_source = ENETUNREACH;
    ExpectBad("lcm_loopback_multicast", "lo is down", "ip link set lo up");
}

TEST_F(DoctorMachineTest, LoopbackThatCarriesNoMulticast) {
    machine_.loopback_flags = IFF_UP;
    ExpectBad("lcm_loopback_multicast", "no multicast", "ip link set lo multicast on");
}

TEST_F(DoctorMachineTest, AFirewallBetweenPrograms) {
    machine_.firewall = true;
    ExpectBad("lcm_delivery", "nothing came back", "nft list ruleset");
}

}  // namespace
}  // namespace hitchview::app

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/config.hpp"
#include "app/hitch_angle_decoder.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"

namespace hitchview::app {
namespace {

using hal::HitchAngleQuality;
using testing::AllOf;
using testing::HasSubstr;

const std::string kDbc =
    "BO_ 1111 Yaw: 8 X\n"
    " SG_ Angle : 23|12@0+ (0.1,-90) [-90|90] \"degrees\" X\n"
    " SG_ State : 47|4@0+ (1,0) [0|15] \"\" X\n"
    " SG_ Real : 0|32@1- (1,0) [0|0] \"deg\" X\n"
    " SG_ Long : 0|64@1- (1,0) [0|0] \"deg\" X\n"
    " SG_ Beyond : 60|12@1- (1,0) [0|0] \"deg\" X\n"
    " SG_ Zero : 0|12@1- (0,0) [0|0] \"deg\" X\n"
    " SG_ Unitless : 0|12@1- (1,0) [0|0] \"\" X\n"
    "BO_ 2147483655 Pages: 8 X\n"
    " SG_ Page M : 0|8@1+ (1,0) [0|0] \"\" X\n"
    " SG_ Left m1 : 8|16@1- (0.001,0) [0|0] \"rad\" X\n"
    " SG_ Other m2 : 8|16@1+ (1,0) [0|0] \"\" X\n"
    "VAL_ 1111 Angle 4095 \"Faulty\" 4094 \"No_Data_Exists\" 900 \"Straight\";\n"
    "VAL_ 1111 State 15 \"Faulty\" 8 \"High\" 7 \"Low\" 0 \"Init\";\n"
    "SIG_VALTYPE_ 1111 Real : 1;\n"
    "BA_ \"GenMsgCycleTime\" BO_ 1111 40;\n";

class ConfigCanTest : public testing::Test {
 protected:
    hal::Checked<RigConfig> Load(const std::string& can) {
        folder_.Write("x.dbc", kDbc);
        return LoadRigConfig(
            folder_.Write("rig.yaml",
                          "schema: 1\n"
                          "canvas: {projection: plane, size_px: [640, 360]}\n"
                          "units: {tractor: {cameras: [{name: a, source: {replay: a.avi}}]}}\n"
                          "can: " +
                              can + "\n"));
    }
    CanConfig Read(const std::string& can) {
        auto config = Load(can);
        EXPECT_TRUE(config) << config.error();
        return config ? *config.value().can : CanConfig{};
    }
    HitchAngleSignal ReadSignal(const std::string& keys) {
        return Read("{source: {socketcan: can0}, hitch_angle: {" + keys + "}}").hitch_angle;
    }
    std::string Refusal(const std::string& can) {
        const auto config = Load(can);
        return config ? "none" : config.error();
    }
    std::string SignalRefusal(const std::string& keys) {
        return Refusal("{source: {socketcan: can0}, hitch_angle: {" + keys + "}}");
    }

    tests::TemporaryFolder folder_;
};

const std::string kNamed = "dbc: x.dbc, message: Yaw, signal: Angle";
const std::string kBits = "id: 1, start_bit: 0, length_bits: 8, factor_deg: 1";

hal::CanFrame YawFrame(unsigned raw, unsigned state) {
    hal::CanFrame frame{.id = 1111, .size_bytes = 8};
    frame.data[2] = static_cast<std::uint8_t>(raw >> 4);
    frame.data[3] = static_cast<std::uint8_t>(raw << 4);
    frame.data[5] = static_cast<std::uint8_t>(state << 4);
    return frame;
}

hal::HitchAngle Decoded(const HitchAngleSignal& signal, const hal::CanFrame& frame) {
    return DecodeHitchAngle(signal, frame).value();
}

double Degrees(const hal::HitchAngle& angle) {
    return angle.angle_rad * 180 / std::numbers::pi;
}

TEST_F(ConfigCanTest, ABusOfTheMachineIsNamedByItsInterface) {
    const CanConfig can = Read("{source: {socketcan: can0}, hitch_angle: {" + kBits + "}}");
    EXPECT_EQ(can.source, CanConfig::Source::kSocketCan);
    EXPECT_EQ(can.interface, "can0");
    EXPECT_EQ(can.receive_buffer_bytes, 1 << 20);
}

TEST_F(ConfigCanTest, ASourceIsExactlyOneOfThree) {
    const std::string rest = ", hitch_angle: {" + kBits + "}}";
    EXPECT_THAT(Refusal("{source: {socketcan: can0, simulated: true}" + rest),
                HasSubstr("rig.yaml:4: can.source is"));
    EXPECT_THAT(Refusal("{source: {}" + rest), HasSubstr("either simulated, candump or socketcan"));
    EXPECT_THAT(
        Refusal("{source: {socketcan: a_name_too_long_}" + rest),
        HasSubstr("can.source.socketcan is a_name_too_long_, must be the name of a network"));
    EXPECT_THAT(Refusal("{source: {simulated: true}, receive_buffer_bytes: 5000" + rest),
                HasSubstr("can.receive_buffer_bytes is 5000, must be absent unless"));
    EXPECT_THAT(Refusal("{source: {socketcan: can0}, receive_buffer_bytes: 1" + rest),
                HasSubstr("must be 4096 to 67108864"));
}

TEST_F(ConfigCanTest, ASignalOfADbcFileBringsItsLayoutRangeCodesAndAge) {
    const HitchAngleSignal signal = ReadSignal(kNamed);
    EXPECT_EQ(signal.id, 1111U);
    EXPECT_FALSE(signal.IsExtended());
    EXPECT_FALSE(signal.j1939) << "an 11-bit id";
    EXPECT_EQ(signal.min_deg, -90);
    EXPECT_EQ(signal.max_deg, 90);
    EXPECT_EQ(signal.max_age, std::chrono::milliseconds(200)) << "five cycles of 40 ms";
    EXPECT_NEAR(Degrees(Decoded(signal, YawFrame(1350, 0))), 45, 1e-9);
    EXPECT_EQ(Decoded(signal, YawFrame(900, 0)).quality, HitchAngleQuality::kValid)
        << "named, no code";
    EXPECT_EQ(Decoded(signal, YawFrame(4095, 0)).quality, HitchAngleQuality::kError);
    EXPECT_EQ(Decoded(signal, YawFrame(4094, 0)).quality, HitchAngleQuality::kNotAvailable);
    EXPECT_EQ(Decoded(signal, YawFrame(4093, 0)).quality, HitchAngleQuality::kImplausible);
}

TEST_F(ConfigCanTest, WhatTheRigFileSaysGoesBeforeTheDbcFile) {
    const HitchAngleSignal signal = ReadSignal(
        kNamed + ", min_deg: -30, max_deg: 30, max_age_ms: 0, j1939: true, max_rate_deg_s: 60");
    EXPECT_EQ(signal.min_deg, -30);
    EXPECT_EQ(signal.max_age.count(), 0);
    EXPECT_TRUE(signal.j1939);
    EXPECT_EQ(signal.max_rate_deg_s, 60);
}

TEST_F(ConfigCanTest, ASignalThatCountsToTheRightIsTurnedRound) {
    const HitchAngleSignal signal = ReadSignal(kNamed + ", positive: right, max_deg: 80");
    EXPECT_NEAR(Degrees(Decoded(signal, YawFrame(1350, 0))), -45, 1e-9);
    EXPECT_EQ(Decoded(signal, YawFrame(0, 0)).quality, HitchAngleQuality::kImplausible) << "+90";
    EXPECT_EQ(Decoded(signal, YawFrame(1800, 0)).quality, HitchAngleQuality::kValid) << "-90";
}

TEST_F(ConfigCanTest, TheQualitySignalDecidesWhetherTheAngleCounts) {
    const HitchAngleSignal signal =
        ReadSignal(kNamed + ", quality_signal: State, valid_qualities: [High, 7]");
    const auto quality = [&](unsigned state) {
        return Decoded(signal, YawFrame(900, state)).quality;
    };
    EXPECT_EQ(quality(8), HitchAngleQuality::kValid);
    EXPECT_EQ(quality(7), HitchAngleQuality::kValid);
    EXPECT_EQ(quality(15), HitchAngleQuality::kError);
    EXPECT_EQ(quality(0), HitchAngleQuality::kNotAvailable);
    EXPECT_EQ(quality(3), HitchAngleQuality::kNotAvailable) << "not in the file";
    hal::CanFrame shorter = YawFrame(900, 8);
    shorter.size_bytes = 4;
    EXPECT_EQ(Decoded(signal, shorter).quality, HitchAngleQuality::kError);
}

TEST_F(ConfigCanTest, AMultiplexedSignalIsReadOnlyFromItsFrames) {
    const HitchAngleSignal signal = ReadSignal("dbc: x.dbc, message: Pages, signal: Left");
    EXPECT_EQ(signal.id, 7U);
    EXPECT_TRUE(signal.IsExtended());
    hal::CanFrame frame{.id = 7, .extended = true, .size_bytes = 8, .data = {1, 0xe8, 0x03}};
    EXPECT_NEAR(DecodeHitchAngle(signal, frame)->angle_rad, 1.0, 1e-12)
        << "1000 thousandths of a radian";
    frame.data[0] = 2;
    EXPECT_FALSE(DecodeHitchAngle(signal, frame));
    frame.data[0] = 1;
    frame.extended = false;
    EXPECT_FALSE(DecodeHitchAngle(signal, frame)) << "the same number in the other format";
}

TEST_F(ConfigCanTest, AUnitThatTheFileDoesNotTellIsAskedFor) {
    EXPECT_THAT(
        SignalRefusal("dbc: x.dbc, message: Yaw, signal: Unitless"),
        AllOf(HasSubstr(
                  "rig.yaml:4: can.hitch_angle.signal is Unitless, must be a signal in degrees"),
              HasSubstr("line 8 is in ''")));
    EXPECT_EQ(ReadSignal("dbc: x.dbc, message: Yaw, signal: Unitless, unit: degrees").factor_deg,
              1);
    EXPECT_NEAR(ReadSignal("dbc: x.dbc, message: Yaw, signal: Unitless, unit: radians").factor_deg,
                57.29577951, 1e-8);
}

TEST_F(ConfigCanTest, MistakesAreNamedWithWhatThereIs) {
    const auto says = [](const char* what) {
        return AllOf(HasSubstr("rig.yaml:4: can.hitch_angle."), HasSubstr(what));
    };
    EXPECT_THAT(SignalRefusal("dbc: y.dbc, message: Yaw, signal: Angle"),
                says("dbc is y.dbc, must be a DBC file that can be read: "));
    EXPECT_THAT(SignalRefusal("dbc: x.dbc, signal: Angle"), says("message is missing"));
    EXPECT_THAT(SignalRefusal("dbc: x.dbc, message: Yav, signal: Angle"),
                says("message is Yav, must be a message of x.dbc, Yaw, Pages"));
    EXPECT_THAT(SignalRefusal("dbc: x.dbc, message: Yaw, signal: Angel"),
                says("signal is Angel, must be a signal of message Yaw, Angle"));
    EXPECT_THAT(SignalRefusal(kNamed + ", id: 5"), says("id is 5, must be absent with dbc"));
    EXPECT_THAT(SignalRefusal(kBits + ", message: Yaw"),
                says("message is Yaw, must be absent without dbc"));
    EXPECT_THAT(SignalRefusal(kBits + ", quality_signal: Q"), says("must be absent without dbc"));
    EXPECT_THAT(SignalRefusal("dbc: x.dbc, message: Yaw, signal: Real"),
                says("not floating point (signal Real in line 4)"));
    EXPECT_THAT(SignalRefusal("dbc: x.dbc, message: Yaw, signal: Long"), says("1 to 32 bits"));
    EXPECT_THAT(SignalRefusal("dbc: x.dbc, message: Yaw, signal: Beyond"),
                says("inside its message of 8 bytes"));
    EXPECT_THAT(SignalRefusal("dbc: x.dbc, message: Yaw, signal: Zero"),
                says("factor is other than 0"));
    EXPECT_THAT(SignalRefusal(kNamed + ", unit: turns"),
                says("unit is turns, must be one of degrees, radians"));
    EXPECT_THAT(SignalRefusal(kNamed + ", positive: up"), says("must be one of left, right"));
    EXPECT_THAT(SignalRefusal(kNamed + ", quality_signal: State"),
                says("valid_qualities is missing"));
    EXPECT_THAT(SignalRefusal(kNamed + ", valid_qualities: [1]"),
                says("must be absent without quality_signal"));
    EXPECT_THAT(SignalRefusal(kNamed + ", quality_signal: Stat, valid_qualities: [1]"),
                says("quality_signal is Stat, must be a signal of message Yaw, State"));
    EXPECT_THAT(SignalRefusal(kNamed + ", quality_signal: State, valid_qualities: [Higher]"),
                says("its number or its text, High"));
    EXPECT_THAT(SignalRefusal("dbc: x.dbc, message: Pages, signal: Left, quality_signal: Other, "
                              "valid_qualities: [1]"),
                says("in the same frames"));
    EXPECT_THAT(SignalRefusal(kBits + ", max_age_ms: 60001"), says("must be 0 to 60000"));
    EXPECT_THAT(SignalRefusal(kBits + ", max_rate_deg_s: -1"), says("must be 0 to 10000"));
}

TEST_F(ConfigCanTest, TheAngleOfAVehicleOnTheRoadIsFoundByName) {
    const std::string file = tests::TestData("can/ford_lincoln_base_pt.dbc");
    if (file.empty()) GTEST_SKIP() << "no shared/data/can/ford_lincoln_base_pt.dbc";
    const HitchAngleSignal signal =
        ReadSignal("dbc: " + file +
                   ", message: TrailerAid_Stat2_FD1, signal: TrlrHitchYaw_An_Actl,"
                   " quality_signal: TrlrHitchYaw_D_Stat, valid_qualities: [HiConfdLrndAngle, "
                   "HiConfdAngleMem]");
    EXPECT_NEAR(Degrees(Decoded(signal, YawFrame(1350, 8))), 45, 1e-9);
    EXPECT_EQ(Decoded(signal, YawFrame(1350, 10)).quality, HitchAngleQuality::kError);
    EXPECT_EQ(Decoded(signal, YawFrame(1350, 3)).quality, HitchAngleQuality::kNotAvailable);
    EXPECT_EQ(Decoded(signal, YawFrame(4095, 8)).quality, HitchAngleQuality::kError);
    EXPECT_EQ(Decoded(signal, YawFrame(4094, 8)).quality, HitchAngleQuality::kNotAvailable);
}

}  // namespace
}  // namespace hitchview::app

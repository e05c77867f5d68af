#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "app/hitch_angle_decoder.hpp"

namespace hitchview::app {
namespace {

using hal::CanFrame;
using hal::HitchAngle;
using hal::HitchAngleQuality;
using ByteOrder = HitchAngleSignal::ByteOrder;

double Degrees(double radians) {
    return radians * 180 / std::numbers::pi;
}

// Frame 1111 TrailerAid_Stat2_FD1, signal TrlrHitchYaw_An_Actl : 23|12@0+ (0.1,-90) [-90|319.3].
HitchAngleSignal Ford() {
    return {.id = 1111,
            .start_bit = 23,
            .length_bits = 12,
            .byte_order = ByteOrder::kMotorola,
            .factor_deg = 0.1,
            .offset_deg = -90,
            .min_deg = -90,
            .max_deg = 319.3};
}

// `raw` in bytes 2 and 3, high nibble first; all other bits are ones, which must not matter.
CanFrame FordFrame(unsigned raw) {
    CanFrame frame{.id = 1111, .size_bytes = 8, .received_at = std::chrono::seconds(3)};
    frame.data.fill(0xff);
    frame.data[2] = static_cast<std::uint8_t>(raw >> 4);
    frame.data[3] = static_cast<std::uint8_t>((raw & 15U) << 4 | 15U);
    return frame;
}

// An unsigned signal from bit 0 on that fills the frame, in whole degrees, without limits.
HitchAngleSignal Plain(int length_bits) {
    return {.id = 1, .length_bits = length_bits, .min_deg = -1e10, .max_deg = 1e10};
}

CanFrame PlainFrame(std::uint32_t raw) {
    CanFrame frame{.id = 1, .size_bytes = 8};
    for (int i = 0; i < 4; ++i) frame.data[i] = static_cast<std::uint8_t>(raw >> (8 * i));
    return frame;
}

HitchAngleQuality QualityOf(const HitchAngleSignal& signal, const CanFrame& frame) {
    return DecodeHitchAngle(signal, frame).value().quality;
}

HitchAngleQuality QualityOfRaw(int length_bits, std::uint32_t raw) {
    return QualityOf(Plain(length_bits), PlainFrame(raw));
}

// The definition of DBC numbering, one bit after the other.
std::int64_t RawBitByBit(const HitchAngleSignal& signal, const CanFrame& frame) {
    const bool intel = signal.byte_order == ByteOrder::kIntel;
    std::int64_t raw = 0;
    int bit = signal.start_bit;
    bool is_negative = false;
    for (int i = 0; i < signal.length_bits; ++i) {
        const bool one = (frame.data[bit / 8] >> (bit % 8) & 1) != 0;
        const int weight = intel ? i : signal.length_bits - 1 - i;
        if (one) raw += std::int64_t{1} << weight;
        if (weight == signal.length_bits - 1) is_negative = one && signal.is_signed;
        bit = intel || bit % 8 != 0 ? bit + (intel ? 1 : -1) : bit + 15;
    }
    return is_negative ? raw - (std::int64_t{1} << signal.length_bits) : raw;
}

// Bytes a frame must have for the signal; the definition again, bit by bit.
int BytesNeeded(const HitchAngleSignal& signal) {
    int bit = signal.start_bit;
    for (int i = 1; i < signal.length_bits; ++i) {
        if (signal.byte_order == ByteOrder::kIntel) {
            ++bit;
        } else {
            bit += bit % 8 == 0 ? 15 : -1;
        }
    }
    return bit / 8 + 1;
}

class RandomSignals {
 public:
    HitchAngleSignal Signal() {
        HitchAngleSignal signal{.id = 1, .start_bit = Up(511), .length_bits = 1 + Up(31)};
        signal.byte_order = Up(1) == 0 ? ByteOrder::kIntel : ByteOrder::kMotorola;
        signal.is_signed = Up(1) == 1;
        signal.factor_deg = 0.5 * (1 + Up(6)) * (Up(1) == 0 ? 1 : -1);
        signal.offset_deg = Up(100) - 50;
        signal.min_deg = -1e12;
        signal.max_deg = 1e12;
        return signal;
    }
    CanFrame Frame() {
        CanFrame frame{.id = 1, .size_bytes = 64};
        for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(Up(255));
        return frame;
    }

 private:
    int Up(int largest) { return std::uniform_int_distribution<int>(0, largest)(random_); }

    std::mt19937 random_{1};
};

TEST(HitchAngleDecoderTest, EverySignalReadsAsBitByBit) {
    RandomSignals random;
    int compared = 0;
    for (int i = 0; i < 20000; ++i) {
        const HitchAngleSignal signal = random.Signal();
        const CanFrame frame = random.Frame();
        if (BytesNeeded(signal) > 64) continue;
        const HitchAngle angle = DecodeHitchAngle(signal, frame).value();
        if (angle.quality != HitchAngleQuality::kValid) continue;
        const double expected_deg =
            signal.factor_deg * static_cast<double>(RawBitByBit(signal, frame)) + signal.offset_deg;
        ASSERT_NEAR(Degrees(angle.angle_rad), expected_deg, 1e-12 * (1 + std::abs(expected_deg)))
            << "start " << signal.start_bit << " length " << signal.length_bits;
        ++compared;
    }
    EXPECT_GT(compared, 18000);
}

TEST(HitchAngleDecoderTest, AFrameIsLongEnoughExactlyFromTheLastByteOfTheSignalOn) {
    RandomSignals random;
    for (int i = 0; i < 5000; ++i) {
        HitchAngleSignal signal = random.Signal();
        signal.is_signed = true;  // no codes: kError can only mean 'too short'
        CanFrame frame = random.Frame();
        for (int size = 0; size <= 64; ++size) {
            frame.size_bytes = static_cast<std::uint8_t>(size);
            const bool too_short = QualityOf(signal, frame) == HitchAngleQuality::kError;
            ASSERT_EQ(too_short, size < BytesNeeded(signal))
                << "start " << signal.start_bit << " length " << signal.length_bits;
        }
    }
}

TEST(HitchAngleDecoderTest, FordsSignalReadsAsItsDescriptionSays) {
    const HitchAngle straight = DecodeHitchAngle(Ford(), FordFrame(900)).value();
    EXPECT_EQ(straight.quality, HitchAngleQuality::kValid);
    EXPECT_NEAR(straight.angle_rad, 0, 1e-12);
    EXPECT_EQ(straight.received_at, std::chrono::seconds(3));
    EXPECT_NEAR(Degrees(DecodeHitchAngle(Ford(), FordFrame(0))->angle_rad), -90, 1e-9);
    EXPECT_NEAR(Degrees(DecodeHitchAngle(Ford(), FordFrame(1350))->angle_rad), 45, 1e-9);
    EXPECT_NEAR(Degrees(DecodeHitchAngle(Ford(), FordFrame(4093))->angle_rad), 319.3, 1e-9);
}

TEST(HitchAngleDecoderTest, FordsTwoCodesAreNotAngles) {
    EXPECT_EQ(QualityOf(Ford(), FordFrame(4093)), HitchAngleQuality::kValid);
    EXPECT_EQ(QualityOf(Ford(), FordFrame(4094)), HitchAngleQuality::kError);
    EXPECT_EQ(QualityOf(Ford(), FordFrame(4095)), HitchAngleQuality::kNotAvailable);
}

TEST(HitchAngleDecoderTest, FordsSignalNeedsFourBytes) {
    CanFrame frame = FordFrame(900);
    frame.size_bytes = 4;
    EXPECT_EQ(QualityOf(Ford(), frame), HitchAngleQuality::kValid);
    frame.size_bytes = 3;
    EXPECT_EQ(QualityOf(Ford(), frame), HitchAngleQuality::kError);
}

TEST(HitchAngleDecoderTest, TheTopByteOfWholeBytesIsTheCode) {
    for (const int length_bits : {8, 16, 24, 32}) {
        const int shift = length_bits - 8;
        const std::uint32_t below = (1U << shift) - 1;  // all bits under the top byte
        const auto raw = [&](std::uint32_t top, std::uint32_t low) { return top << shift | low; };
        EXPECT_EQ(QualityOfRaw(length_bits, raw(0xff, 0)), HitchAngleQuality::kNotAvailable);
        EXPECT_EQ(QualityOfRaw(length_bits, raw(0xff, below)), HitchAngleQuality::kNotAvailable);
        EXPECT_EQ(QualityOfRaw(length_bits, raw(0xfe, 0)), HitchAngleQuality::kError);
        EXPECT_EQ(QualityOfRaw(length_bits, raw(0xfe, below)), HitchAngleQuality::kError);
        EXPECT_EQ(QualityOfRaw(length_bits, raw(0xfd, below)), HitchAngleQuality::kValid);
    }
}

TEST(HitchAngleDecoderTest, OtherLengthsHaveOneValueForEachCode) {
    for (const int length_bits : {9, 12, 15, 17, 31}) {
        const std::uint32_t all_ones = (1U << length_bits) - 1;
        EXPECT_EQ(QualityOfRaw(length_bits, all_ones), HitchAngleQuality::kNotAvailable);
        EXPECT_EQ(QualityOfRaw(length_bits, all_ones - 1), HitchAngleQuality::kError);
        EXPECT_EQ(QualityOfRaw(length_bits, all_ones - 2), HitchAngleQuality::kValid);
    }
}

TEST(HitchAngleDecoderTest, ShortSignalsHaveNoCodes) {
    EXPECT_EQ(QualityOfRaw(7, 127), HitchAngleQuality::kValid);
    EXPECT_EQ(QualityOfRaw(1, 1), HitchAngleQuality::kValid);
}

TEST(HitchAngleDecoderTest, AllOnesOfASignedSignalIsMinusOne) {
    HitchAngleSignal signal = Plain(16);
    signal.is_signed = true;
    const HitchAngle angle = DecodeHitchAngle(signal, PlainFrame(0xffff)).value();
    EXPECT_EQ(angle.quality, HitchAngleQuality::kValid);
    EXPECT_NEAR(Degrees(angle.angle_rad), -1, 1e-12);
}

TEST(HitchAngleDecoderTest, OutsideTheRangeIsImplausibleAndItsEndsAreInside) {
    HitchAngleSignal signal = Ford();
    signal.min_deg = -60.3;
    signal.max_deg = 60.3;
    EXPECT_EQ(QualityOf(signal, FordFrame(296)), HitchAngleQuality::kImplausible);
    EXPECT_EQ(QualityOf(signal, FordFrame(297)), HitchAngleQuality::kValid);
    EXPECT_EQ(QualityOf(signal, FordFrame(1503)), HitchAngleQuality::kValid);
    EXPECT_EQ(QualityOf(signal, FordFrame(1504)), HitchAngleQuality::kImplausible);
}

TEST(HitchAngleDecoderTest, ACodeCountsAlsoInsideTheRange) {
    EXPECT_EQ(QualityOfRaw(8, 255), HitchAngleQuality::kNotAvailable);
}

TEST(HitchAngleDecoderTest, AFrameOfAnotherIdHasNoAngle) {
    CanFrame frame = FordFrame(900);
    frame.id = 1112;
    EXPECT_FALSE(DecodeHitchAngle(Ford(), frame));
}

TEST(HitchAngleDecoderTest, TheSameNumberInTheOtherIdFormatIsAnotherId) {
    CanFrame frame = FordFrame(900);
    frame.extended = true;
    EXPECT_FALSE(DecodeHitchAngle(Ford(), frame));

    HitchAngleSignal signal = Ford();
    signal.id = frame.id = 0x18ff7a27;
    EXPECT_TRUE(DecodeHitchAngle(signal, frame));
    frame.extended = false;
    EXPECT_FALSE(DecodeHitchAngle(signal, frame));
}

TEST(HitchAngleDecoderTest, WithoutTheCodesOfJ1939TheWholeRangeIsAngles) {
    HitchAngleSignal signal = Plain(16);
    signal.j1939 = false;
    EXPECT_EQ(QualityOf(signal, PlainFrame(0xffff)), HitchAngleQuality::kValid);
    EXPECT_EQ(QualityOf(signal, PlainFrame(0xfe00)), HitchAngleQuality::kValid);
}

TEST(HitchAngleDecoderTest, RemoteAndErrorFramesHaveNoAngle) {
    for (const auto kind : {hal::CanFrameKind::kRemote, hal::CanFrameKind::kError}) {
        CanFrame frame = FordFrame(900);
        frame.kind = kind;
        EXPECT_FALSE(DecodeHitchAngle(Ford(), frame));
    }
}

// A frame of 0.1 degree steps, `degrees` at millisecond `time_ms`.
CanFrame FordAt(double degrees, int time_ms) {
    CanFrame frame = FordFrame(static_cast<unsigned>(std::lround((degrees + 90) * 10)));
    frame.received_at = std::chrono::milliseconds(time_ms);
    return frame;
}

TEST(HitchAngleMonitorTest, AJumpIsImplausibleUntilTheAngleCouldHaveTurnedSoFar) {
    HitchAngleSignal signal = Ford();
    signal.max_rate_deg_s = 100;
    HitchAngleMonitor monitor(signal);
    const auto quality = [&](double degrees, int time_ms) {
        return monitor.Decode(FordAt(degrees, time_ms))->quality;
    };
    EXPECT_EQ(quality(40, 0), HitchAngleQuality::kValid) << "the first";
    EXPECT_EQ(quality(42, 20), HitchAngleQuality::kValid) << "just the rate";
    EXPECT_EQ(quality(52, 40), HitchAngleQuality::kImplausible);
    EXPECT_EQ(quality(52, 60), HitchAngleQuality::kImplausible);
    EXPECT_EQ(quality(43, 80), HitchAngleQuality::kValid) << "it was a glitch";
    EXPECT_EQ(quality(53, 100), HitchAngleQuality::kImplausible);
    EXPECT_EQ(quality(53, 181), HitchAngleQuality::kValid) << "it was not";
}

TEST(HitchAngleMonitorTest, OneStepOfTheSignalIsNoJumpHoweverShortTheTime) {
    HitchAngleSignal signal = Ford();
    signal.max_rate_deg_s = 1;
    HitchAngleMonitor monitor(signal);
    monitor.Decode(FordAt(10, 5));
    EXPECT_EQ(monitor.Decode(FordAt(10.1, 5))->quality, HitchAngleQuality::kValid);
}

TEST(HitchAngleMonitorTest, SilenceIsToldOnceAndAgainAfterTheNextFrame) {
    using std::chrono::milliseconds;
    HitchAngleSignal signal = Ford();
    signal.max_age = milliseconds(100);
    HitchAngleMonitor monitor(signal);
    EXPECT_FALSE(monitor.Stale(milliseconds(1000))) << "the start";
    EXPECT_FALSE(monitor.Stale(milliseconds(1100)));
    const auto stale = monitor.Stale(milliseconds(1170));
    ASSERT_TRUE(stale);
    EXPECT_EQ(stale->quality, HitchAngleQuality::kStale);
    EXPECT_EQ(stale->received_at, milliseconds(1100)) << "when it became so";
    EXPECT_FALSE(monitor.Stale(milliseconds(9000)));
    monitor.Decode(FordAt(4, 9100));
    EXPECT_FALSE(monitor.Stale(milliseconds(9200)));
    EXPECT_TRUE(monitor.Stale(milliseconds(9201)));
}

TEST(HitchAngleMonitorTest, WithoutALargestAgeSilenceIsNothing) {
    HitchAngleSignal signal = Ford();
    signal.max_age = {};
    HitchAngleMonitor monitor(signal);
    monitor.Stale(std::chrono::seconds(1));
    EXPECT_FALSE(monitor.Stale(std::chrono::hours(10)));
}

}  // namespace
}  // namespace hitchview::app

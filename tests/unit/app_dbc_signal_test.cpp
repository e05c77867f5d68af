#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "app/can_field.hpp"
#include "app/dbc_signal.hpp"

namespace hitchview::app {
namespace {

// The bits of a signal as the numbering of DBC files defines them, highest weight first.
std::vector<int> BitsOf(const DbcSignal& signal) {
    std::vector<int> bits;
    for (int i = 0, bit = signal.start_bit; i < signal.length_bits; ++i) {
        if (signal.motorola) {
            bits.push_back(bit);
            bit += bit % 8 == 0 ? 15 : -1;
        } else {
            bits.insert(bits.begin(), bit++);
        }
    }
    return bits;
}

std::int64_t RawBitByBit(const DbcSignal& signal, const std::vector<std::uint8_t>& data) {
    std::int64_t raw = 0;
    bool is_first = true;
    for (const int bit : BitsOf(signal)) {
        const int one = data[static_cast<std::size_t>(bit / 8)] >> (bit % 8) & 1;
        raw = 2 * raw + (is_first && signal.is_signed ? -one : one);
        is_first = false;
    }
    return raw;
}

DbcMessage MessageOf(const std::string& layout, int bytes = 8) {
    const auto dbc = ParseDbc(
        "BO_ 1 A: " + std::to_string(bytes) + " X\n SG_ s : " + layout + " (1,0) [0|0] \"deg\" X\n",
        "x.dbc");
    EXPECT_TRUE(dbc) << dbc.error();
    return dbc.value().messages.at(0);
}

std::optional<std::int64_t> Raw(const std::string& layout, const std::vector<std::uint8_t>& data) {
    const DbcMessage message = MessageOf(layout, static_cast<int>(data.size()));
    return RawValue(FieldOf(message, message.signals[0]).value(), data);
}

TEST(DbcSignalTest, WorkedByHand) {
    // Intel from bit 4: the high nibble of byte 0 is the lowest, then byte 1.
    EXPECT_EQ(Raw("4|12@1+", {0x5f, 0xa3}), 0xa35);
    // Motorola from bit 7: bytes as they are written.
    EXPECT_EQ(Raw("7|16@0+", {0x12, 0x34}), 0x1234);
    // Motorola from bit 3: the low nibble of byte 0 is the highest, then byte 1.
    EXPECT_EQ(Raw("3|12@0+", {0xf1, 0x23}), 0x123);
    // Two's complement: -2 in 12 bits.
    EXPECT_EQ(Raw("3|12@0-", {0x0f, 0xfe}), -2);
    EXPECT_EQ(Raw("0|8@1-", {0x80}), -128);
    EXPECT_EQ(Raw("7|32@0+", {0xff, 0xff, 0xff, 0xff}), 4294967295);
}

TEST(DbcSignalTest, AnySignalReadsAsBitByBitOrLiesOutsideItsMessage) {
    std::mt19937 random(1);
    const auto up = [&](int largest) {
        return std::uniform_int_distribution<int>(0, largest)(random);
    };
    int read = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::vector<std::uint8_t> data(static_cast<std::size_t>(1 + up(63)));
        for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(up(255));
        std::ostringstream layout;
        layout << up(520) << '|' << 1 + up(31) << '@' << up(1) << (up(1) == 1 ? '+' : '-');
        const DbcMessage message = MessageOf(layout.str(), static_cast<int>(data.size()));
        const DbcSignal& signal = message.signals[0];
        const std::vector<int> bits = BitsOf(signal);
        const bool fits = std::ranges::max(bits) / 8 < static_cast<int>(data.size());
        const auto field = FieldOf(message, signal);
        ASSERT_EQ(field.ok(), fits) << layout.str() << " in " << data.size();
        if (!fits) continue;
        ASSERT_EQ(RawValue(field.value(), data), RawBitByBit(signal, data)) << layout.str();
        ++read;
    }
    EXPECT_GT(read, 4000);
}

TEST(DbcSignalTest, TextsAreCodesByWhatTheySayInAnySpelling) {
    DbcSignal signal;
    const std::vector<std::string> errors{"Faulty", "SENSOR_FAILURE", "Error indicator",
                                          "In-valid"};
    const std::vector<std::string> missing{"No Data Exists", "not_available", "SNA",
                                           "Unavailable",    "Initialising",  "NotUsed_3",
                                           "unknown"};
    const std::vector<std::string> names{"Straight", "Left", "Snatched", ""};
    std::int64_t raw = 0;
    for (const auto* texts : {&errors, &missing, &names}) {
        for (const std::string& text : *texts) signal.texts.push_back({raw++, text});
    }
    const HitchAngleCodes codes = CodesOf(signal);
    EXPECT_EQ(codes.errors, (std::vector<std::int64_t>{0, 1, 2, 3}));
    EXPECT_EQ(codes.not_available, (std::vector<std::int64_t>{4, 5, 6, 7, 8, 9, 10}));
}

TEST(DbcSignalTest, UnitsOfAnglesAreKnownInTheirSpellings) {
    for (const char* unit : {"deg", "Degrees", "degree", "\xc2\xb0", "\xb0"})
        EXPECT_EQ(DegreesIn(unit), 1.0) << unit;
    for (const char* unit : {"rad", "radians", "Radian"})
        EXPECT_NEAR(DegreesIn(unit).value_or(0), 57.29577951308232, 1e-12) << unit;
    for (const char* unit : {"", "degrees/second", "deg/s", "rad/s", "%", "mrad"})
        EXPECT_FALSE(DegreesIn(unit)) << unit;
}

TEST(DbcSignalTest, TheNamesMostAlikeComeFirst) {
    EXPECT_EQ(MostLike("Anglr", {"State", "Angel", "Angle", "Age"}), ", Angle, Angel, Age");
    EXPECT_EQ(MostLike("x", {}), "");
}

TEST(DbcSignalTest, AMultiplexedSignalNeedsAPlainMultiplexor) {
    const auto angle = [](const std::string& signals) {
        const auto dbc =
            ParseDbc("BO_ 1 A: 8 X\n SG_ s m2 : 8|8@1+ (1,0) [0|0] \"deg\" X\n" + signals, "x");
        const DbcMessage& message = dbc.value().messages[0];
        return HitchAngleOf(message, message.signals[0], 1);
    };
    const std::string page = " SG_ p M : 0|4@1+ (1,0) [0|0] \"\" X\n";
    const auto good = angle(page);
    ASSERT_TRUE(good) << good.error();
    EXPECT_EQ(good.value().multiplexor->value, 2);
    EXPECT_EQ(good.value().multiplexor->field.length_bits, 4);
    EXPECT_FALSE(angle(""));
    EXPECT_FALSE(angle(" SG_ p m1M : 0|4@1+ (1,0) [0|0] \"\" X\n"));
    EXPECT_FALSE(angle(page + "SG_MUL_VAL_ 1 s p 2-2, 5-9;\n"));
    EXPECT_TRUE(angle(page + "SG_MUL_VAL_ 1 s p 2-2;\n"));
}

TEST(DbcSignalTest, AnAngleKeepsWithinWhatAngleSignalsMayBe) {
    const auto angle = [](const std::string& scale, double unit_deg) {
        const auto dbc = ParseDbc("BO_ 1 A: 8 X\n SG_ s : 0|8@1+ " + scale +
                                      " \"deg\" X\nBA_ \"GenMsgCycleTime\" BO_ 1 3600000;\n",
                                  "x.dbc");
        EXPECT_TRUE(dbc) << dbc.error();
        const DbcMessage& message = dbc.value().messages[0];
        return HitchAngleOf(message, message.signals[0], unit_deg);
    };
    const auto wide = angle("(1000,100000) [-1e9|1e9]", -1);
    ASSERT_TRUE(wide) << wide.error();
    EXPECT_EQ(wide.value().min_deg, -360);
    EXPECT_EQ(wide.value().max_deg, 360);
    EXPECT_EQ(wide.value().max_age, std::chrono::minutes(1));
    EXPECT_FALSE(angle("(1000.1,0) [0|1]", 1));
    EXPECT_FALSE(angle("(1e308,0) [0|1]", 57));
    EXPECT_FALSE(angle("(1,-100000.1) [0|1]", 1));
}

}  // namespace
}  // namespace hitchview::app

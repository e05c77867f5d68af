#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "app/dbc_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"

namespace hitchview::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kSmall =
    "VERSION \"1.0\"\n"
    "\n"
    "NS_ :\n"
    "\tCM_\n"
    "\tBA_DEF_\n"
    "\tBO_\n"
    "\n"
    "BS_: 125000\n"
    "\n"
    "BU_: Tractor\n"
    "     Trailer Bridge_\n"
    "VAL_TABLE_ States 1 \"On; really\" 0 \"Off\" ;\n"
    "\n"
    "BO_ 1111 Yaw: 8 Trailer\n"
    " SG_ Angle : 23|12@0+ (0.1,-90) [-90|319.3] \"degrees\" Tractor,Bridge_\n"
    " SG_ State: 47|4@0- (1,0) [0|15] \"\"  Tractor\n"
    "\n"
    "BO_ 2566879783 Extended : 64 Vector__XXX\r\n"
    " SG_ Page M : 0|8@1+ (1,0) [0|0] \"\" Vector__XXX\r\n"
    " SG_ Low m0 : 8|16@1- (1E-2,+0) [0|0] \"\" Vector__XXX\r\n"
    " SG_ High m3M : 8|16@1+ (-0.5,1.5E+3) [0|1.8E+019] \"rad\" Vector__XXX\r\n"
    "\n"
    "BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n"
    " SG_ Lost : nonsense\n"
    "\n"
    "CM_ SG_ 1111 Angle \"positive to the left;\n"
    "BO_ 7 this is text: 8 \\\"X\\\"\";\n"
    "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 100000;\n"
    "BA_DEF_DEF_ \"GenMsgCycleTime\" 200;\n"
    "BA_ \"GenMsgCycleTime\" BO_ 1111 20;\n"
    "BA_ \"GenMsgCycleTime\" BO_ 9 10;\n"
    "BA_ \"Other\" SG_ 1111 Angle 1;\n"
    "VAL_ 1111 Angle 4095 \"Faulty\" 4094 \"NoDataExists\";\n"
    "VAL_ 1111 Gone 1 \"x\" ;\n"
    "VAL_ Environment 0 \"x\" ;\n"
    "VAL_ 1111 State -1 \"Minus\" 18446744073709551615 \"Most\" ;\n"
    "SIG_VALTYPE_ 2566879783 High : 1;\n"
    "SG_MUL_VAL_ 2566879783 Low Page 0-0, 5-5;\n"
    "SG_MUL_VAL_ 2566879783 High Page 3-3;\n";

/// Null if there is none of the name.
template <typename T>
const T* Named(const std::vector<T>& all, const std::string& name) {
    const auto found = std::ranges::find(all, name, &T::name);
    return found == all.end() ? nullptr : &*found;
}

DbcFile Parse(const std::string& text) {
    auto dbc = ParseDbc(text, "x.dbc");
    EXPECT_TRUE(dbc) << dbc.error();
    return dbc ? std::move(*dbc) : DbcFile{};
}

std::string Refusal(const std::string& text) {
    const auto dbc = ParseDbc(text, "x.dbc");
    return dbc ? "none" : dbc.error();
}

TEST(DbcFileTest, MessagesHaveTheirIdFormatSizeAndCycle) {
    const DbcFile dbc = Parse(kSmall);
    ASSERT_EQ(dbc.messages.size(), 2U);
    const DbcMessage& standard = *Named(dbc.messages, "Yaw");
    EXPECT_EQ(standard.id, 1111U);
    EXPECT_FALSE(standard.extended);
    EXPECT_EQ(standard.size_bytes, 8);
    EXPECT_EQ(standard.cycle_time, std::chrono::milliseconds(20));
    const DbcMessage& extended = *Named(dbc.messages, "Extended");
    EXPECT_EQ(extended.id, 0x18ff7a27U);
    EXPECT_TRUE(extended.extended);
    EXPECT_EQ(extended.cycle_time, std::chrono::milliseconds(200)) << "the default";
    EXPECT_EQ(Named(dbc.messages, "VECTOR__INDEPENDENT_SIG_MSG"), nullptr);
}

TEST(DbcFileTest, SignalsHaveTheirLayoutScaleRangeAndUnit) {
    const DbcFile dbc = Parse(kSmall);
    const DbcSignal& angle = *Named(dbc.messages[0].signals, "Angle");
    EXPECT_EQ(angle.line, 15);
    EXPECT_EQ(angle.start_bit, 23);
    EXPECT_EQ(angle.length_bits, 12);
    EXPECT_TRUE(angle.motorola);
    EXPECT_FALSE(angle.is_signed);
    EXPECT_EQ(angle.factor, 0.1);
    EXPECT_EQ(angle.offset, -90);
    EXPECT_EQ(angle.min, -90);
    EXPECT_EQ(angle.max, 319.3);
    EXPECT_EQ(angle.unit, "degrees");
    EXPECT_TRUE(Named(dbc.messages[0].signals, "State")->is_signed);
    const DbcSignal& high = *Named(dbc.messages[1].signals, "High");
    EXPECT_EQ(high.factor, -0.5);
    EXPECT_EQ(high.offset, 1500);
    EXPECT_EQ(high.max, 1.8e19);
    EXPECT_FALSE(high.motorola);
}

TEST(DbcFileTest, MultiplexingIsTold) {
    const DbcFile dbc = Parse(kSmall);
    const DbcMessage& message = dbc.messages[1];
    EXPECT_EQ(message.FindMultiplexor(), Named(message.signals, "Page"));
    EXPECT_FALSE(Named(message.signals, "Page")->multiplexed_by);
    EXPECT_EQ(Named(message.signals, "Low")->multiplexed_by, 0);
    EXPECT_TRUE(Named(message.signals, "Low")->extended_multiplexing);
    EXPECT_EQ(Named(message.signals, "High")->multiplexed_by, 3);
    EXPECT_FALSE(Named(message.signals, "High")->extended_multiplexing) << "the same once more";
    EXPECT_TRUE(Named(message.signals, "High")->is_multiplexor);
    EXPECT_TRUE(Named(message.signals, "High")->is_float);
    EXPECT_FALSE(Named(message.signals, "Low")->is_float);
}

TEST(DbcFileTest, TextsBelongToTheirValues) {
    const DbcFile dbc = Parse(kSmall);
    const auto& texts = Named(dbc.messages[0].signals, "Angle")->texts;
    ASSERT_EQ(texts.size(), 2U);
    EXPECT_EQ(texts[0].raw, 4095);
    EXPECT_EQ(texts[0].text, "Faulty");
    EXPECT_EQ(texts[1].text, "NoDataExists");
    EXPECT_EQ(Named(dbc.messages[0].signals, "State")->texts[1].raw, -1) << "64 bits, all ones";
}

TEST(DbcFileTest, AMistakeIsNamedWithFileAndLine) {
    const std::string message = "BO_ 1 A: 8 X\n";
    const auto signal = [&](const std::string& rest) {
        return Refusal(message + " SG_ s " + rest + "\n");
    };
    EXPECT_EQ(Refusal(message + " SG_ s : 0|8@1+ (1,0) [0|0] \"\" X\n"), "none");
    EXPECT_EQ(Refusal("\n\nBO_ x A: 8 X\n"),
              "x.dbc:3: 'x' stands where must be id, 0 to 4294967295");
    EXPECT_THAT(Refusal("BO_ 2048 A: 8 X\n"),
                HasSubstr("x.dbc:1: id of message A is 2048, must be"));
    EXPECT_THAT(Refusal("BO_ 1 : 8 X\n"), HasSubstr("must be the message's name"));
    EXPECT_THAT(Refusal("BO_ 1 A: 70000 X\n"), HasSubstr("must be size in bytes, 0 to 65535"));
    EXPECT_THAT(Refusal(message + "BO_ 1 B: 8 X\n"),
                HasSubstr("x.dbc:2: message B or its id 1 is there twice"));
    EXPECT_THAT(Refusal(message + "BO_ 2 A: 8 X\n"), HasSubstr("there twice"));
    EXPECT_THAT(Refusal("SG_ s : 0|8@1+ (1,0) [0|0] \"\" X\n"), HasSubstr("below its message"));
    EXPECT_THAT(signal("Q : 0|8@1+ (1,0) [0|0] \"\" X"),
                HasSubstr("x.dbc:2: 'Q' stands where must be M"));
    EXPECT_THAT(signal("m : 0|8@1+ (1,0) [0|0] \"\" X"), HasSubstr("M, m and a number"));
    EXPECT_THAT(signal(": -1|8@1+ (1,0) [0|0] \"\" X"), HasSubstr("start bit, 0 to 65535"));
    EXPECT_THAT(signal(": 0|8@2+ (1,0) [0|0] \"\" X"), HasSubstr("0 (Motorola) or 1 (Intel)"));
    EXPECT_THAT(signal(": 0|8@1+ (nan,0) [0|0] \"\" X"), HasSubstr("factor, a number"));
    EXPECT_THAT(signal(": 0|8@1+ (1,1e999) [0|0] \"\" X"), HasSubstr("offset, a number"));
    EXPECT_THAT(signal(": 0|8@1+ (1,0) [0|0] X"), HasSubstr("the unit in quotes"));
    EXPECT_THAT(signal(": 0|8@1+ (1,0) [0|0] \"deg X"), HasSubstr("without its closing quote"));
    EXPECT_THAT(Refusal(message + "CM_ \"x\"\nBO_ 2 B: 8 X\n"),
                HasSubstr("x.dbc:3: 'BO_' stands where must be the semicolon"));
    EXPECT_THAT(Refusal("CM_ \"x"), HasSubstr("x.dbc:1"));
    EXPECT_THAT(Refusal(message + "BA_ \"GenMsgCycleTime\" BO_ 1 often;"),
                HasSubstr("cycle time in ms"));
}

TEST(DbcFileTest, MoreThanTheLargestCountsAreRefused) {
    std::string text;
    for (std::size_t i = 0; i <= DbcFile::kMaxMessages; ++i) {
        const std::string number = std::to_string(i);
        text += "BO_ " + std::to_string(0x80000000U + i) + " M" + number + ": 8 X\n";
    }
    EXPECT_THAT(Refusal(text), HasSubstr("too many messages, must be at most 20000"));
}

TEST(DbcFileTest, AFileThatIsNotThereOrTooLargeIsNamed) {
    const tests::TemporaryFolder folder;
    EXPECT_THAT(LoadDbc(folder / "none.dbc").error(), HasSubstr("none.dbc: No such file"));
    const std::string file = folder.Write("large.dbc", "");
    std::filesystem::resize_file(file, DbcFile::kMaxBytes + 1);
    EXPECT_THAT(LoadDbc(file).error(), HasSubstr("must be at most 16777216"));
}

TEST(DbcFileTest, DamagedFilesAreReadOrRefusedWithTheirLine) {
    std::mt19937 random(1);
    const auto below = [&](std::size_t limit) { return random() % limit; };
    int refused = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = kSmall;
        for (std::size_t count = 1 + below(4); count > 0; --count) {
            const std::size_t at = below(text.size());
            if (below(3) == 0) text[at] = static_cast<char>(below(256));
            if (below(3) == 0) text.erase(at, below(30));
            if (below(3) == 0) text.insert(at, text.substr(below(text.size()), below(60)));
        }
        const std::string why = Refusal(text);
        refused += why != "none";
        ASSERT_TRUE(why == "none" || why.starts_with("x.dbc:")) << why;
    }
    EXPECT_GT(refused, 5000);
}

TEST(DbcFileTest, AFileOfAVehicleOnTheRoadIsReadAsATextSearchFindsIt) {
    const std::string file = tests::TestData("can/ford_lincoln_base_pt.dbc");
    if (file.empty()) GTEST_SKIP() << "no shared/data/can/ford_lincoln_base_pt.dbc";
    const auto dbc = LoadDbc(file);
    ASSERT_TRUE(dbc) << dbc.error();
    std::size_t signals = 0;
    for (const DbcMessage& message : dbc.value().messages) signals += message.signals.size();
    EXPECT_EQ(dbc.value().messages.size(), 331U);
    EXPECT_EQ(signals, 2150U);
    const DbcMessage* const message = Named(dbc.value().messages, "TrailerAid_Stat2_FD1");
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(message->id, 1111U);
    const DbcSignal* const angle = Named(message->signals, "TrlrHitchYaw_An_Actl");
    ASSERT_NE(angle, nullptr);
    EXPECT_EQ(angle->line, 1174);
    EXPECT_EQ(angle->texts.size(), 2U);
    EXPECT_EQ(Named(message->signals, "TrlrHitchYaw_D_Stat")->texts.size(), 16U);
}

}  // namespace
}  // namespace hitchview::app

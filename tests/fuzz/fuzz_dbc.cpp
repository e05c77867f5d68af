#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "app/dbc_file.hpp"
#include "app/dbc_signal.hpp"
#include "app/hitch_angle_decoder.hpp"
#include "hal/expect.hpp"
#include "tests/fuzz/fuzz_bytes.hpp"
#include "tests/fuzz/fuzz_complaint.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace hitchview;
using app::DbcFile;
using app::DbcMessage;
using app::DbcSignal;

template <typename Number>
void Append(Number number, std::string& text) {
    std::array<char, 32> digits{};
    text.append(digits.data(),
                std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
}

std::uint32_t IdInFile(const DbcMessage& message) {
    return message.id | (message.extended ? 0x80000000U : 0U);
}

void AppendPlace(const char* keyword, const DbcMessage& message, const DbcSignal& signal,
                 std::string& text) {
    text.append(keyword).append(1, ' ');
    Append(IdInFile(message), text);
    text.append(1, ' ').append(signal.name);
}

void AppendSignal(const DbcSignal& signal, std::string& text) {
    text.append(" SG_ ").append(signal.name).append(1, ' ');
    if (signal.multiplexed_by) {
        text += 'm';
        Append(*signal.multiplexed_by, text);
    }
    if (signal.is_multiplexor) text += 'M';
    text += " : ";
    Append(signal.start_bit, text);
    text += '|';
    Append(signal.length_bits, text);
    text.append(signal.motorola ? "@0" : "@1").append(signal.is_signed ? "- (" : "+ (");
    Append(signal.factor, text);
    text += ',';
    Append(signal.offset, text);
    text += ") [";
    Append(signal.min, text);
    text += '|';
    Append(signal.max, text);
    text.append("] \"").append(signal.unit).append("\" X\n");
}

void AppendStatements(const DbcMessage& message, const DbcSignal& signal, std::string& text) {
    if (signal.is_float) {
        AppendPlace("SIG_VALTYPE_", message, signal, text);
        text += " : 1;\n";
    }
    if (signal.extended_multiplexing) {
        AppendPlace("SG_MUL_VAL_", message, signal, text);
        text += " Page 0-0, 2-3;\n";
    }
    if (signal.texts.empty()) return;
    AppendPlace("VAL_", message, signal, text);
    for (const app::DbcValueText& value : signal.texts) {
        text += ' ';
        Append(value.raw, text);
        text.append(" \"").append(value.text).append(1, '"');
    }
    text += " ;\n";
}

std::string TextOf(const DbcFile& dbc) {
    std::string text;
    for (const DbcMessage& message : dbc.messages) {
        text += "BO_ ";
        Append(IdInFile(message), text);
        text.append(1, ' ').append(message.name).append(" : ");
        Append(message.size_bytes, text);
        text += " X\n";
        for (const DbcSignal& signal : message.signals) AppendSignal(signal, text);
    }
    for (const DbcMessage& message : dbc.messages) {
        if (message.cycle_time) {
            text += "BA_ \"GenMsgCycleTime\" BO_ ";
            Append(IdInFile(message), text);
            text += ' ';
            Append(message.cycle_time->count(), text);
            text += ";\n";
        }
        for (const DbcSignal& signal : message.signals) AppendStatements(message, signal, text);
    }
    return text;
}

/// The file says the same when it is written anew.
void ExpectSameWhenWritten(const DbcFile& dbc) {
    const std::string text = TextOf(dbc);
    auto again = app::ParseDbc(text, "again.dbc");
    HV_EXPECT(again.ok());
    HV_EXPECT(TextOf(*again) == text);
}

void ExpectSound(const DbcSignal& signal, int lines) {
    HV_EXPECT(signal.line >= 1 && signal.line <= lines && !signal.name.empty());
    HV_EXPECT(signal.start_bit >= 0 && signal.start_bit <= 65535);
    HV_EXPECT(signal.length_bits >= 0 && signal.length_bits <= 65535);
    for (const double number : {signal.factor, signal.offset, signal.min, signal.max})
        HV_EXPECT(std::isfinite(number));
}

void ExpectSound(const DbcFile& dbc, int lines) {
    std::set<std::uint32_t> ids;
    std::set<std::string_view> names;
    for (const DbcMessage& message : dbc.messages) {
        HV_EXPECT(ids.insert(IdInFile(message)).second && names.insert(message.name).second);
        HV_EXPECT(message.id <= (message.extended ? 0x1fffffffU : 0x7ffU));
        HV_EXPECT(message.size_bytes >= 0 && message.size_bytes <= 65535);
        HV_EXPECT(!message.cycle_time || (message.cycle_time->count() > 0 &&
                                          *message.cycle_time <= std::chrono::hours(1)));
        for (const DbcSignal& signal : message.signals) ExpectSound(signal, lines);
    }
}

/// What HitchAngleSignal says of its members.
void ExpectInRange(const app::HitchAngleSignal& signal) {
    HV_EXPECT(signal.start_bit >= 0 && signal.start_bit <= 511);
    HV_EXPECT(signal.length_bits >= 1 && signal.length_bits <= 32);
    HV_EXPECT(signal.factor_deg != 0 && std::abs(signal.factor_deg) <= 1000);
    HV_EXPECT(std::abs(signal.offset_deg) <= 100'000);
    HV_EXPECT(signal.min_deg >= -360 && signal.min_deg <= signal.max_deg && signal.max_deg <= 360);
    HV_EXPECT(signal.max_age.count() >= 0 && signal.max_age.count() <= 60'000);
}

/// A frame that changes all over with `seed`.
hal::CanFrame FrameOf(const app::HitchAngleSignal& signal, int size_bytes, std::uint32_t seed) {
    hal::CanFrame frame{.id = signal.id, .extended = signal.IsExtended()};
    frame.size_bytes = static_cast<std::uint8_t>(std::min(size_bytes, 64));
    for (std::size_t i = 0; i < frame.size_bytes; ++i) {
        seed = seed * 1664525 + 1013904223;
        frame.data[i] = static_cast<std::uint8_t>(seed >> 24);
    }
    return frame;
}

void Decode(const DbcMessage& message, const DbcSignal& dbc, double unit_deg) {
    const auto signal = app::HitchAngleOf(message, dbc, unit_deg);
    HV_EXPECT(signal.ok() || !signal.error().empty());
    if (!signal) return;
    ExpectInRange(signal.value());
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
        const auto angle = app::DecodeHitchAngle(signal.value(),
                                                 FrameOf(signal.value(), message.size_bytes, seed));
        HV_EXPECT(!angle || std::abs(angle->angle_rad) <= 2.001 * std::numbers::pi);
        HV_EXPECT(!angle || angle->quality == hal::HitchAngleQuality::kValid ||
                  angle->angle_rad == 0);
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = tests::TextOf({data, size});
    const auto dbc = app::ParseDbc(text, "x.dbc");
    const int lines = tests::LinesOf(text);
    if (!dbc) {
        tests::ExpectComplaint(dbc.error(), "x.dbc", lines);
        return 0;
    }
    ExpectSound(dbc.value(), lines);
    ExpectSameWhenWritten(dbc.value());
    for (const DbcMessage& message : dbc.value().messages) {
        for (const DbcSignal& signal : message.signals) {
            Decode(message, signal, -1);
            Decode(message, signal, 180 / std::numbers::pi);
        }
    }
    return 0;
}

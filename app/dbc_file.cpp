#include "app/dbc_file.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <system_error>
#include <utility>

#include "app/dbc_reader.hpp"

namespace hitchview::app {
namespace {

using hal::Checked;
using Kind = DbcToken::Kind;

constexpr std::uint32_t kExtendedFlag = 0x80000000;
constexpr std::uint32_t kLargestStandardId = 0x7ff;
constexpr std::uint32_t kLargestExtendedId = 0x1fffffff;
constexpr std::uint32_t kIndependentSignals = 0xc0000000;
constexpr std::int64_t kLongestCycle_ms = 3'600'000;
constexpr std::string_view kCycleTime = "GenMsgCycleTime";

// Raw values of 64 bits come signed and unsigned.
std::optional<std::int64_t> ParsedRaw(std::string_view text) {
    if (const auto number = ParsedNumber<std::int64_t>(text)) return number;
    const auto number = ParsedNumber<std::uint64_t>(text);
    return number ? std::optional(static_cast<std::int64_t>(*number)) : std::nullopt;
}

class Parser {
 public:
    Parser(std::string_view text, const std::string& file) : in_(text, file) {}

    Checked<DbcFile> Parse() {
        while (in_.token().kind != Kind::kEnd && in_.error().empty()) ParseStatement();
        if (!in_.error().empty()) return in_.error();
        ApplyDefaultCycle();
        return std::move(dbc_);
    }

 private:
    using SignalKey = std::pair<std::uint32_t, std::string_view>;
    struct SignalPlace {
        std::size_t message;
        std::size_t signal;
    };

    void ParseStatement();
    void ParseMessage();
    void ParseSignal();
    bool ParseMultiplexing(DbcSignal& signal);
    bool ParseLayout(DbcSignal& signal);
    bool ParseScale(DbcSignal& signal);
    void AddSignal(DbcSignal signal, std::string_view name);
    void ParseValueTexts();
    void ParseFloatType();
    void ParseExtendedMultiplexing();
    void ParseAttribute();
    void ParseDefaultAttribute();
    void ApplyDefaultCycle();

    // The signal that `id name` at the token means; null where there is none. Takes both off.
    DbcSignal* TakeSignalPlace();

    DbcReader in_;
    DbcFile dbc_;
    bool skips_signals_ = false;  // those of the message that is none
    std::size_t signals_ = 0;
    std::size_t texts_ = 0;
    std::map<std::uint32_t, std::size_t> message_of_id_;  // as in the file, with the flag
    std::map<std::string_view, std::size_t> message_of_name_;
    std::map<SignalKey, SignalPlace> places_;
    std::optional<std::int64_t> default_cycle_ms_;
    std::map<std::size_t, std::int64_t> cycle_ms_;  // of a message
};

void Parser::ParseStatement() {
    const DbcToken keyword = in_.token();
    if (keyword.kind == Kind::kOpenText) {
        in_.Refuse("a closing quote");
        return;
    }
    in_.Advance();
    // Such is the list of keywords at the top of a file.
    if (in_.token().starts_line || keyword.kind != Kind::kWord) return;
    if (keyword.text == "BO_") return ParseMessage();
    if (keyword.text == "SG_") return ParseSignal();
    if (keyword.text == "VAL_") return ParseValueTexts();
    if (keyword.text == "SIG_VALTYPE_") return ParseFloatType();
    if (keyword.text == "SG_MUL_VAL_") return ParseExtendedMultiplexing();
    if (keyword.text == "BA_") return ParseAttribute();
    if (keyword.text == "BA_DEF_DEF_") return ParseDefaultAttribute();
    const bool is_list = keyword.text == "NS_" || keyword.text == "BS_" || keyword.text == "BU_";
    if (is_list || !keyword.text.ends_with('_')) return in_.SkipLine();
    in_.SkipStatement();
}

void Parser::ParseMessage() {
    const int line = in_.token().line;
    DbcMessage message;
    std::uint32_t id = 0;
    std::string_view name;
    if (!in_.TakeNumber<std::uint32_t>(0, UINT32_MAX, id, "id")) return;
    if (!in_.TakeName(name, "the message's name") || !in_.TakeSign(':')) return;
    if (!in_.TakeNumber(0, 65535, message.size_bytes, "size in bytes")) return;
    in_.SkipLine();
    skips_signals_ = id == kIndependentSignals;
    if (skips_signals_) return;

    message.extended = (id & kExtendedFlag) != 0;
    message.id = id & ~kExtendedFlag;
    message.name = name;
    if (message.id > (message.extended ? kLargestExtendedId : kLargestStandardId)) {
        in_.Complain(line, "id of message " + message.name + " is " + std::to_string(id) +
                               ", must be 0 to 2047, or 2147483648 + 0 to 536870911 (extended)");
        return;
    }
    const bool is_new_id = message_of_id_.emplace(id, dbc_.messages.size()).second;
    if (!is_new_id || !message_of_name_.emplace(name, dbc_.messages.size()).second) {
        in_.Complain(line, "message " + message.name + " or its id " + std::to_string(id) +
                               " is there twice, must be unique");
    } else if (dbc_.messages.size() == DbcFile::kMaxMessages) {
        in_.Complain(line,
                     "too many messages, must be at most " + std::to_string(DbcFile::kMaxMessages));
    } else {
        dbc_.messages.push_back(std::move(message));
    }
}

void Parser::ParseSignal() {
    DbcSignal signal;
    signal.line = in_.token().line;
    if (skips_signals_) return in_.SkipLine();
    std::string_view name;
    std::string_view unit;
    if (!in_.TakeName(name, "the signal's name") || !ParseMultiplexing(signal)) return;
    if (!in_.TakeSign(':') || !ParseLayout(signal) || !ParseScale(signal)) return;
    if (!in_.TakeText(unit, "the unit in quotes")) return;
    in_.SkipLine();
    signal.name = name;
    signal.unit = unit;
    AddSignal(std::move(signal), name);
}

// Nothing, M, m<k> or m<k>M.
bool Parser::ParseMultiplexing(DbcSignal& signal) {
    if (in_.token().kind != Kind::kWord) return true;
    std::string_view word = in_.token().text;
    signal.is_multiplexor = word.ends_with('M');
    if (signal.is_multiplexor) word.remove_suffix(1);
    if (word.starts_with('m')) signal.multiplexed_by = ParsedNumber<std::uint32_t>(word.substr(1));
    if (!word.empty() && !signal.multiplexed_by) return in_.Refuse("M, m and a number, or :");
    in_.Advance();
    return true;
}

// 23|12@0+
bool Parser::ParseLayout(DbcSignal& signal) {
    if (!in_.TakeNumber(0, 65535, signal.start_bit, "start bit") || !in_.TakeSign('|'))
        return false;
    if (!in_.TakeNumber(0, 65535, signal.length_bits, "length in bits") || !in_.TakeSign('@'))
        return false;
    const std::string_view form = in_.token().text;
    const bool known = in_.token().kind == Kind::kWord && form.size() == 2 &&
                       (form[0] == '0' || form[0] == '1') && (form[1] == '+' || form[1] == '-');
    if (!known) return in_.Refuse("0 (Motorola) or 1 (Intel), then + (unsigned) or - (signed)");
    signal.motorola = form[0] == '0';
    signal.is_signed = form[1] == '-';
    in_.Advance();
    return true;
}

// (0.1,-90) [-90|319.3]
bool Parser::ParseScale(DbcSignal& signal) {
    return in_.TakeSign('(') && in_.TakeReal(signal.factor, "factor") && in_.TakeSign(',') &&
           in_.TakeReal(signal.offset, "offset") && in_.TakeSign(')') && in_.TakeSign('[') &&
           in_.TakeReal(signal.min, "minimum") && in_.TakeSign('|') &&
           in_.TakeReal(signal.max, "maximum") && in_.TakeSign(']');
}

void Parser::AddSignal(DbcSignal signal, std::string_view name) {
    if (dbc_.messages.empty()) {
        in_.Complain(signal.line, "signal " + signal.name + " must stand below its message (BO_)");
        return;
    }
    DbcMessage& message = dbc_.messages.back();
    const std::uint32_t id = message.id | (message.extended ? kExtendedFlag : 0);
    const SignalPlace place{dbc_.messages.size() - 1, message.signals.size()};
    if (!places_.emplace(SignalKey{id, name}, place).second) {
        in_.Complain(signal.line, "signal " + signal.name +
                                      " is there twice, must be unique in message " + message.name);
    } else if (++signals_ > DbcFile::kMaxSignals) {
        in_.Complain(signal.line,
                     "too many signals, must be at most " + std::to_string(DbcFile::kMaxSignals));
    } else {
        message.signals.push_back(std::move(signal));
    }
}

DbcSignal* Parser::TakeSignalPlace() {
    const auto id = ParsedNumber<std::uint32_t>(in_.token().text);
    if (in_.token().kind == Kind::kWord) in_.Advance();
    const std::string_view name = in_.token().text;
    if (in_.token().kind != Kind::kWord || !id) return nullptr;
    in_.Advance();
    const auto found = places_.find({*id, name});
    if (found == places_.end()) return nullptr;
    return &dbc_.messages[found->second.message].signals[found->second.signal];
}

// VAL_ 1111 Yaw 4095 "Faulty" 4094 "NoDataExists";
void Parser::ParseValueTexts() {
    DbcSignal* const signal = TakeSignalPlace();
    if (signal == nullptr) return in_.SkipStatement();
    while (in_.token().kind == Kind::kWord) {
        const auto raw = ParsedRaw(in_.token().text);
        in_.Advance();
        std::string_view text;
        if (!in_.TakeText(text, "the text of a value in quotes")) return;
        if (++texts_ > DbcFile::kMaxTexts) {
            in_.Complain(in_.token().line, "too many texts of values, must be at most " +
                                               std::to_string(DbcFile::kMaxTexts));
            return;
        }
        if (raw) signal->texts.push_back({*raw, std::string(text)});
    }
    in_.TakeSign(';');
}

// SIG_VALTYPE_ 1111 Yaw : 1;
void Parser::ParseFloatType() {
    DbcSignal* const signal = TakeSignalPlace();
    if (signal != nullptr && in_.token().IsSign(':')) {
        in_.Advance();
        signal->is_float = !in_.token().IsWord("0");
    }
    in_.SkipStatement();
}

// SG_MUL_VAL_ 1111 Yaw Page 3-3; says no more than m3 does. Other ranges and lists do.
void Parser::ParseExtendedMultiplexing() {
    if (DbcSignal* const signal = TakeSignalPlace()) {
        in_.Advance();
        const std::string page = std::to_string(signal->multiplexed_by.value_or(-1));
        const bool is_simple = in_.token().IsWord(page + "-" + page);
        if (is_simple) in_.Advance();
        signal->extended_multiplexing = !is_simple || !in_.token().IsSign(';');
    }
    in_.SkipStatement();
}

// BA_ "GenMsgCycleTime" BO_ 823 1000;
void Parser::ParseAttribute() {
    const bool is_cycle = in_.token().kind == Kind::kText && in_.token().text == kCycleTime;
    in_.Advance();
    if (!is_cycle || !in_.token().IsWord("BO_")) return in_.SkipStatement();
    in_.Advance();
    const auto message =
        message_of_id_.find(ParsedNumber<std::uint32_t>(in_.token().text).value_or(UINT32_MAX));
    if (message == message_of_id_.end()) return in_.SkipStatement();
    in_.Advance();
    if (in_.TakeNumber<std::int64_t>(0, kLongestCycle_ms, cycle_ms_[message->second],
                                     "cycle time in ms"))
        in_.TakeSign(';');
}

void Parser::ParseDefaultAttribute() {
    const bool is_cycle = in_.token().kind == Kind::kText && in_.token().text == kCycleTime;
    in_.Advance();
    if (is_cycle) default_cycle_ms_ = ParsedNumber<std::int64_t>(in_.token().text);
    in_.SkipStatement();
}

// 0 is how files say that a message has no cycle.
void Parser::ApplyDefaultCycle() {
    for (std::size_t i = 0; i < dbc_.messages.size(); ++i) {
        const auto own = cycle_ms_.find(i);
        const std::int64_t cycle_ms =
            own != cycle_ms_.end() ? own->second : default_cycle_ms_.value_or(0);
        if (cycle_ms > 0 && cycle_ms <= kLongestCycle_ms)
            dbc_.messages[i].cycle_time = std::chrono::milliseconds(cycle_ms);
    }
}

}  // namespace

const DbcSignal* DbcMessage::FindMultiplexor() const {
    const auto found = std::ranges::find(signals, true, &DbcSignal::is_multiplexor);
    return found == signals.end() ? nullptr : &*found;
}

Checked<DbcFile> ParseDbc(std::string_view text, const std::string& file) {
    return Parser(text, file).Parse();
}

Checked<DbcFile> LoadDbc(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error) return file.string() + ": " + error.message();
    if (bytes > DbcFile::kMaxBytes) {
        return file.string() + ": has " + std::to_string(bytes) + " bytes, must be at most " +
               std::to_string(DbcFile::kMaxBytes);
    }
    std::string text(bytes, '\0');
    std::ifstream stream(file, std::ios::binary);
    if (!stream.read(text.data(), static_cast<std::streamsize>(bytes)))
        return file.string() + ": cannot be read";
    return ParseDbc(text, file.string());
}

}  // namespace hitchview::app

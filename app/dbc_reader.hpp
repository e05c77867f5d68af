#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "app/dbc_lexer.hpp"

namespace hitchview::app {

/// Empty unless all of `text` is one number.
template <typename Number>
std::optional<Number> ParsedNumber(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// Takes the pieces of statements off a DBC file, and keeps the first complaint about it.
class DbcReader {
 public:
    DbcReader(std::string_view text, const std::string& file) : file_(file), lexer_(text) {}

    [[nodiscard]] const DbcToken& token() const { return lexer_.token(); }
    void Advance() { lexer_.Advance(); }

    // Each takes what it names off the file, or complains and returns false.
    bool TakeSign(char sign);
    bool TakeName(std::string_view& name, const char* what);
    template <typename Number>
    bool TakeNumber(Number min, Number max, Number& number, const char* what);
    /// Finite.
    bool TakeReal(double& number, const char* what);
    bool TakeText(std::string_view& text, const char* what);

    void SkipLine();
    /// Past the next semicolon; complains where the next message or signal comes first.
    void SkipStatement();

    /// About the token; returns false.
    bool Refuse(const std::string& must_be);
    /// Returns false.
    bool Complain(int line, const std::string& what);
    /// `file:line: what is wrong`; empty while nothing is.
    [[nodiscard]] const std::string& error() const { return error_; }

 private:
    std::string file_;
    DbcLexer lexer_;
    std::string error_;
};

template <typename Number>
bool DbcReader::TakeNumber(Number min, Number max, Number& number, const char* what) {
    const auto parsed =
        token().kind == DbcToken::Kind::kWord ? ParsedNumber<Number>(token().text) : std::nullopt;
    if (!parsed || *parsed < min || *parsed > max) {
        return Refuse(std::string(what) + ", " + std::to_string(min) + " to " +
                      std::to_string(max));
    }
    number = *parsed;
    lexer_.Advance();
    return true;
}

}  // namespace hitchview::app

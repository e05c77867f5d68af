#include "app/dbc_reader.hpp"

#include <cctype>
#include <cmath>

namespace hitchview::app {
namespace {

using Kind = DbcToken::Kind;

std::string Shown(const DbcToken& token) {
    constexpr std::size_t kLongest = 40;
    if (token.kind == Kind::kEnd) return "the end of the file";
    if (token.kind == Kind::kOpenText) return "a text without its closing quote";
    std::string shown = "'";
    for (const char c : token.text.substr(0, kLongest))
        shown += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? '?' : c;
    return shown + "'";
}

}  // namespace

void DbcReader::SkipLine() {
    while (!token().starts_line && token().kind != Kind::kEnd) {
        if (token().kind == Kind::kOpenText) {
            Refuse("a closing quote");
            return;
        }
        lexer_.Advance();
    }
}

void DbcReader::SkipStatement() {
    while (!token().IsSign(';')) {
        const bool is_next =
            token().starts_line && (token().IsWord("BO_") || token().IsWord("SG_"));
        if (is_next || token().kind == Kind::kEnd || token().kind == Kind::kOpenText) {
            Refuse("the semicolon of the statement before");
            return;
        }
        lexer_.Advance();
    }
    lexer_.Advance();
}

bool DbcReader::TakeSign(char sign) {
    if (!token().IsSign(sign)) return Refuse(std::string(1, sign));
    lexer_.Advance();
    return true;
}

bool DbcReader::TakeName(std::string_view& name, const char* what) {
    if (token().kind != Kind::kWord) return Refuse(what);
    name = token().text;
    lexer_.Advance();
    return true;
}

bool DbcReader::TakeReal(double& number, const char* what) {
    const auto parsed =
        token().kind == Kind::kWord ? ParsedNumber<double>(token().text) : std::nullopt;
    if (!parsed || !std::isfinite(*parsed)) return Refuse(std::string(what) + ", a number");
    number = *parsed;
    lexer_.Advance();
    return true;
}

bool DbcReader::TakeText(std::string_view& text, const char* what) {
    if (token().kind != Kind::kText) return Refuse(what);
    text = token().text;
    lexer_.Advance();
    return true;
}

bool DbcReader::Refuse(const std::string& must_be) {
    return Complain(token().line, Shown(token()) + " stands where must be " + must_be);
}

bool DbcReader::Complain(int line, const std::string& what) {
    if (error_.empty()) error_ = file_ + ":" + std::to_string(line) + ": " + what;
    return false;
}

}  // namespace hitchview::app

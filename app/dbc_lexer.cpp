#include "app/dbc_lexer.hpp"

#include <algorithm>

namespace hitchview::app {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::string_view kSigns = ":;|@()[],";
constexpr std::string_view kWhiteSpace = " \t\r\n\v\f";
constexpr std::string_view kWordEnds = ":;|@()[],\" \t\r\n\v\f";

}  // namespace

DbcLexer::DbcLexer(std::string_view text) : text_(text) {
    if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
    Advance();
}

void DbcLexer::Advance() {
    const int line_before = line_;
    const bool first = at_ == 0;
    SkipWhiteSpace();
    token_ = {.line = line_, .starts_line = first || line_ != line_before};
    if (AtEnd()) return;
    if (text_[at_] == '"') return ReadText();
    if (kSigns.find(text_[at_]) == kSigns.npos) return ReadWord();
    token_.kind = DbcToken::Kind::kSign;
    token_.text = text_.substr(at_++, 1);
}

void DbcLexer::SkipWhiteSpace() {
    const std::size_t end = std::min(text_.find_first_not_of(kWhiteSpace, at_), text_.size());
    const std::string_view skipped = text_.substr(at_, end - at_);
    line_ += static_cast<int>(std::ranges::count(skipped, '\n'));
    at_ = end;
}

void DbcLexer::ReadText() {
    const std::size_t first = ++at_;
    while (!AtEnd() && text_[at_] != '"') {
        if (text_[at_] == '\n') ++line_;
        at_ += text_[at_] == '\\' && text_.substr(at_ + 1, 1) != "\n" ? 2 : 1;
    }
    token_.kind = AtEnd() ? DbcToken::Kind::kOpenText : DbcToken::Kind::kText;
    token_.text = text_.substr(first, at_ - first);
    at_ = std::min(at_ + 1, text_.size());
}

void DbcLexer::ReadWord() {
    const std::size_t end = std::min(text_.find_first_of(kWordEnds, at_), text_.size());
    token_.kind = DbcToken::Kind::kWord;
    token_.text = text_.substr(at_, end - at_);
    at_ = end;
}

}  // namespace hitchview::app

#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hitchview::app {

struct DbcToken {
    enum class Kind : std::uint8_t {
        kWord,      ///< names, keywords and numbers
        kText,      ///< without its quotes, escapes as they stand
        kSign,      ///< one of : ; | @ ( ) [ ] ,
        kOpenText,  ///< a text whose closing quote is missing
        kEnd,
    };

    Kind kind = Kind::kEnd;
    std::string_view text{};
    int line = 1;
    bool starts_line = true;  ///< nothing but white space stands before it in its line

    [[nodiscard]] bool IsWord(std::string_view word) const {
        return kind == Kind::kWord && text == word;
    }
    [[nodiscard]] bool IsSign(char sign) const {
        return kind == Kind::kSign && text.front() == sign;
    }
};

/// Takes a DBC file apart. Any bytes will do; each token has at least one of them but for kEnd and
/// empty texts. The tokens borrow the text. Takes no memory.
class DbcLexer {
 public:
    explicit DbcLexer(std::string_view text);

    /// The current token; kEnd for ever after the last.
    [[nodiscard]] const DbcToken& token() const { return token_; }
    void Advance();

 private:
    void SkipWhiteSpace();
    void ReadText();
    void ReadWord();
    [[nodiscard]] bool AtEnd() const { return at_ >= text_.size(); }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
    DbcToken token_;
};

}  // namespace hitchview::app

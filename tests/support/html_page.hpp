#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hitchview::tests {

/// Where the tag that begins at `begin` ends; a > in an attribute's quotes does not end it.
inline std::size_t EndOfTag(const std::string& html, std::size_t begin) {
    bool quoted = false;
    for (std::size_t i = begin; i < html.size(); ++i) {
        if (html[i] == '"') quoted = !quoted;
        if (html[i] == '>' && !quoted) return i;
    }
    return html.size();
}

/// What is wrong with the nesting of the tags; empty if nothing is.
inline std::string Unbalanced(const std::string& html) {
    std::vector<std::string> open;
    for (std::size_t begin = html.find('<'); begin != std::string::npos;
         begin = html.find('<', begin)) {
        const std::size_t end = EndOfTag(html, begin);
        const std::string tag = html.substr(begin + 1, end - begin - 1);
        begin = end;
        if (tag.empty()) return "a tag without a name";
        if (tag.front() == '!' || tag.back() == '/') continue;
        if (tag.front() != '/') {
            open.push_back(tag.substr(0, tag.find(' ')));
        } else if (open.empty() || open.back() != tag.substr(1)) {
            return '<' + tag + "> closes " + (open.empty() ? "nothing" : open.back());
        } else {
            open.pop_back();
        }
    }
    return open.empty() ? "" : open.back() + " is not closed";
}

inline int Count(const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + 1)) {
        ++count;
    }
    return count;
}

/// Nothing in it makes a browser fetch anything.
inline void ExpectSelfContained(const std::string& html) {
    for (const char* foreign : {"http", "<script", "<link", "<iframe", "url(", "@import"}) {
        EXPECT_EQ(html.find(foreign), std::string::npos) << foreign;
    }
    EXPECT_EQ(Count(html, "src="), Count(html, "src=\"data:image/jpeg;base64,"));
    EXPECT_EQ(Count(html, "href="), 0);
}

}  // namespace hitchview::tests

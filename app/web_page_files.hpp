#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace hitchview::app {

/// A file of the page, as it was when the program was built (app/web_page).
struct WebPageFile {
    std::string_view name{};
    std::string_view type{};  ///< for Content-Type
    std::string_view tag{};   ///< ETag, with its quotes
    std::span<const std::uint8_t> content{};
};

/// All of them.
std::span<const WebPageFile> WebPageFiles();

}  // namespace hitchview::app

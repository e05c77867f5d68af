#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace hitchview::calib {

/// Replaces `file` in one step: a reader sees the old or the new content, whole. `refusal` looks at
/// the new content before that, as a file of its own: what it complains about does not replace
/// anything. Empty on success, otherwise what went wrong. Throws nothing.
std::string ReplaceFile(const std::filesystem::path& file, const std::string& text,
                        const std::function<std::string(const std::filesystem::path&)>& refusal);

}  // namespace hitchview::calib

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "calib/intrinsics.hpp"

namespace hitchview::calib {

/// A lens that was measured before, or what is wrong with its file: one line
/// `file:line: key is VALUE, must be ...` for each mistake.
struct LoadedLens {
    std::optional<algo::CameraModel> model{};
    Verdict verdict = Verdict::kUnchecked;
    std::string error{};  ///< empty when there is a model
};

/// Strict. Throws nothing.
LoadedLens LoadLens(const std::filesystem::path& file);
/// The same of a file's content. `name`: what complaints call the file.
LoadedLens ParseLens(const std::string& text, const std::string& name);

/// Writes the lens with its verdict, quality, standard deviations and `written_by` (command, build
/// and date), in one step: a reader sees the old or the new content, whole. Empty on success,
/// otherwise what went wrong. Throws nothing.
std::string SaveLens(const Intrinsics& intrinsics, const std::string& written_by,
                     const std::filesystem::path& file);

/// The same of a lens that was not measured here: its verdict is kUnchecked.
std::string SaveUncheckedLens(const algo::CameraModel& model, const std::string& written_by,
                              const std::filesystem::path& file);

}  // namespace hitchview::calib

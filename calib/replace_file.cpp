#include "calib/replace_file.hpp"

#include <fstream>

namespace hitchview::calib {
namespace {

std::string WriteText(const std::string& text, const std::filesystem::path& file) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    stream.close();
    return stream ? "" : file.string() + ": the file cannot be written";
}

}  // namespace

std::string ReplaceFile(const std::filesystem::path& file, const std::string& text,
                        const std::function<std::string(const std::filesystem::path&)>& refusal) {
    std::filesystem::path fresh = file;
    fresh += ".new";
    std::string problem = WriteText(text, fresh);
    if (problem.empty()) problem = refusal(fresh);
    std::error_code error;
    if (problem.empty()) {
        std::filesystem::rename(fresh, file, error);
        if (error) problem = file.string() + ": the file cannot be replaced: " + error.message();
    }
    if (!problem.empty()) std::filesystem::remove(fresh, error);
    return problem;
}

}  // namespace hitchview::calib

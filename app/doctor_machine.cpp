#include "app/doctor_machine.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

namespace hitchview::app {
namespace {

/// What the mode of a file grants, as R_OK, W_OK and X_OK.
int Granted(const UserIds& ids, const struct stat& status) {
    if (ids.user == status.st_uid) return static_cast<int>(status.st_mode >> 6) & 7;
    const bool in_group = std::ranges::find(ids.groups, status.st_gid) != ids.groups.end();
    return static_cast<int>(in_group ? status.st_mode >> 3 : status.st_mode) & 7;
}

bool Grants(const UserIds& ids, const std::filesystem::path& file, int access) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0) return false;
    return ids.user == 0 || (Granted(ids, status) & access) == access;
}

}  // namespace

std::filesystem::path DoctorMachine::At(const std::filesystem::path& path) const {
    const bool is_there_already = std::ranges::mismatch(root, path).in1 == root.end();
    return is_there_already ? path : root / path.relative_path();
}

std::optional<std::string> ReadText(const std::filesystem::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) return std::nullopt;
    std::array<char, 16384> text{};
    struct stat status {};
    const bool is_file = fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
    const ssize_t bytes = is_file ? read(descriptor, text.data(), text.size()) : -1;
    close(descriptor);
    if (bytes < 0) return std::nullopt;
    std::string read_text(text.data(), static_cast<std::size_t>(bytes));
    read_text.erase(read_text.find_last_not_of(" \n\t\r") + 1);
    return read_text;
}

std::optional<std::int64_t> ReadNumber(const std::filesystem::path& file) {
    const auto text = ReadText(file);
    if (!text) return std::nullopt;
    std::int64_t number = 0;
    const char* const end = text->data() + text->size();
    const auto [rest, error] = std::from_chars(text->data(), end, number);
    if (error != std::errc{} || rest != end) return std::nullopt;
    return number;
}

bool MayAccess(const UserIds& ids, const std::filesystem::path& root,
               const std::filesystem::path& file, int access) {
    std::error_code no_root;
    std::error_code no_file;
    const auto top = std::filesystem::canonical(root, no_root);
    const auto target = std::filesystem::canonical(file, no_file);
    if (no_root || no_file || !Grants(ids, target, access)) return false;
    for (auto folder = target.parent_path(); folder != top && folder != folder.parent_path();
         folder = folder.parent_path()) {
        if (!Grants(ids, folder, X_OK)) return false;
    }
    return true;
}

}  // namespace hitchview::app

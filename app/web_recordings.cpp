#include "app/web_recordings.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/web_request.hpp"

namespace hitchview::app {
namespace {

using hal::Error;
using hal::Result;

constexpr std::size_t kMostFiles = 500;

struct ListedFile {
    std::string name;
    std::int64_t bytes;
    std::int64_t modified_ms;
};

std::int64_t ModifiedMs(const struct stat& file) {
    return file.st_mtim.tv_sec * 1000 + file.st_mtim.tv_nsec / 1'000'000;
}

std::vector<ListedFile> FilesIn(const std::filesystem::path& folder) {
    std::vector<ListedFile> files;
    std::error_code failed;
    std::filesystem::directory_iterator entry(folder, failed);
    for (; !failed && entry != std::filesystem::directory_iterator(); entry.increment(failed)) {
        struct stat file {};
        const std::string name = entry->path().filename().string();
        if (!IsRecordingName(name) || lstat(entry->path().c_str(), &file) != 0) continue;
        if (S_ISREG(file.st_mode)) files.push_back({name, file.st_size, ModifiedMs(file)});
    }
    return files;
}

std::string TagOf(const struct stat& file) {
    return '"' + std::to_string(file.st_ino) + '-' + std::to_string(file.st_size) + '-' +
           std::to_string(file.st_mtim.tv_sec) + '.' + std::to_string(file.st_mtim.tv_nsec) + '"';
}

}  // namespace

std::string WebRecordings::List() const {
    std::vector<ListedFile> files;
    if (!folder_.empty()) files = FilesIn(folder_);
    std::ranges::sort(files, [](const ListedFile& a, const ListedFile& b) {
        return std::pair(a.modified_ms, a.name) > std::pair(b.modified_ms, b.name);
    });
    files.resize(std::min(files.size(), kMostFiles));
    nlohmann::json list = nlohmann::json::array();
    for (const ListedFile& file : files) {
        list.push_back(
            {{"name", file.name}, {"bytes", file.bytes}, {"modified_ms", file.modified_ms}});
    }
    return nlohmann::json{{"folder", !folder_.empty()}, {"files", list}}.dump();
}

Result<WebRecording> WebRecordings::Open(std::string_view name) const {
    if (folder_.empty() || !IsRecordingName(name)) return Error::kNotFound;
    const std::filesystem::path path = folder_ / name;
    // Without O_NONBLOCK, opening somebody's pipe would wait for its writer.
    const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) return Error::kNotFound;
    struct stat file {};
    if (fstat(descriptor, &file) != 0 || !S_ISREG(file.st_mode)) {
        close(descriptor);
        return Error::kNotFound;
    }
    return WebRecording{descriptor, static_cast<std::uint64_t>(file.st_size), TagOf(file)};
}

}  // namespace hitchview::app

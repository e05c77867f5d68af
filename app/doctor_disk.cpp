#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "app/doctor.hpp"
#include "app/doctor_memory.hpp"
#include "app/record_folder.hpp"

namespace hitchview::app {
namespace {

using std::filesystem::path;

constexpr std::uint64_t kMegabyte = 1'000'000;
constexpr const char* kNothing = "the rig records nothing";

path Folder(const DoctorSubject& subject) {
    return subject.machine.At(subject.rig.config.record.folder);
}

/// The folder, or what it would be made in.
path Nearest(path folder) {
    std::error_code failed;
    while (!std::filesystem::exists(folder, failed) && folder != folder.parent_path())
        folder = folder.parent_path();
    return folder;
}

struct Room {
    std::uint64_t free_bytes = 0;  ///< for an ordinary user
    std::uint64_t all_bytes = 0;
    bool read_only = false;
};

std::optional<Room> RoomAt(const path& folder) {
    struct statvfs disk {};
    if (statvfs(folder.c_str(), &disk) != 0) return std::nullopt;
    return Room{std::uint64_t{disk.f_bavail} * disk.f_frsize,
                std::uint64_t{disk.f_blocks} * disk.f_frsize, (disk.f_flag & ST_RDONLY) != 0};
}

/// Of the recordings in the folder.
std::uint64_t RecordedBytes(const path& folder) {
    constexpr int kMostFiles = 100'000;
    std::uint64_t bytes = 0;
    std::error_code failed;
    std::filesystem::directory_iterator entry(folder, failed);
    for (int i = 0; i < kMostFiles && !failed; ++i) {
        if (entry == std::filesystem::directory_iterator()) break;
        std::error_code gone;
        if (IsSegmentName(entry->path().filename().string())) {
            const auto file_bytes = entry->file_size(gone);
            if (!gone) bytes += file_bytes;
        }
        entry.increment(failed);
    }
    return bytes;
}

bool IsBelow(const path& folder, const path& top) {
    return std::ranges::mismatch(top, folder).in1 == top.end();
}

/// What the service's sandbox leaves it to write to.
bool IsWithin(const SystemdUnit& service, const path& folder) {
    return std::ranges::any_of(service.writable, [&](const std::string& top) {
        return IsBelow(folder.lexically_normal(), top);
    });
}

std::string OwnRemedy(const DoctorSubject& subject, const path& folder) {
    const std::string user = subject.user().empty() ? "USER" : subject.user();
    return "install --directory --owner=" + user + " --group=" + user + " " + folder.string();
}

Diagnosis CheckFolder(const DoctorSubject& subject) {
    const path& asked = subject.rig.config.record.folder;
    if (asked.empty()) return {.what = kNothing};
    const path nearest = Nearest(Folder(subject));
    std::error_code failed;
    if (!std::filesystem::is_directory(nearest, failed))
        return {Finding::kBad, nearest.string() + " is no folder", "remove or rename that file"};
    const auto room = RoomAt(nearest);
    if (room && room->read_only) {
        return {Finding::kBad, nearest.string() + " is on a disk that is mounted read-only",
                "dmesg tells why; then: mount -o remount,rw " + nearest.string()};
    }
    if (subject.service.IsLoaded() && subject.service.is_confined &&
        !IsWithin(subject.service, asked)) {
        return {Finding::kBad, "the service may not write to " + asked.string(),
                "ReadWritePaths=" + asked.string() + " in systemctl edit hitchview"};
    }
    const auto ids = subject.user_ids();
    if (!ids) return {.what = "there is no user " + subject.user()};
    const std::string who = subject.who();
    if (!MayAccess(*ids, subject.machine.root, nearest, W_OK | X_OK))
        return {Finding::kBad, who + " may not write to " + nearest.string(),
                OwnRemedy(subject, asked)};
    const bool is_made = nearest == Folder(subject);
    return {Finding::kGood, who + (is_made ? " may write to " : " may make ") + asked.string()};
}

Diagnosis CheckSpace(const DoctorSubject& subject) {
    const RecordConfig& record = subject.rig.config.record;
    if (record.folder.empty()) return {.what = kNothing};
    const auto room = RoomAt(Nearest(Folder(subject)));
    if (!room) return {.what = "the disk of " + record.folder.string() + " does not tell its room"};
    const std::uint64_t least = static_cast<std::uint64_t>(record.min_free_mb) * kMegabyte;
    const std::string what = Megabytes(room->free_bytes) + " are free, recordings leave " +
                             Megabytes(least) + " (record.min_free_mb)";
    if (room->free_bytes > least) return {Finding::kGood, what};
    return {Finding::kBad, what + ": nothing is recorded",
            "remove old recordings in " + record.folder.string() +
                " or what else fills the disk, or set record.quota_mb"};
}

Diagnosis CheckQuota(const DoctorSubject& subject) {
    const RecordConfig& record = subject.rig.config.record;
    if (record.folder.empty()) return {.what = kNothing};
    if (record.quota_mb == 0) return {Finding::kGood, "recordings have no quota"};
    const auto room = RoomAt(Nearest(Folder(subject)));
    if (!room) return {.what = "the disk of " + record.folder.string() + " does not tell its room"};
    const std::uint64_t quota = static_cast<std::uint64_t>(record.quota_mb) * kMegabyte;
    const std::uint64_t least = static_cast<std::uint64_t>(record.min_free_mb) * kMegabyte;
    const std::uint64_t reach = room->free_bytes + RecordedBytes(Folder(subject));
    const std::string what = "recordings may have " + Megabytes(quota) + " (record.quota_mb) and " +
                             "leave " + Megabytes(least) + "; the disk has " + Megabytes(reach) +
                             " for both";
    if (quota + least <= reach) return {Finding::kGood, what};
    return {Finding::kBad, what + ": it fills up before old recordings go",
            "lower record.quota_mb, or make room"};
}

}  // namespace

std::vector<DoctorCheck> DiskChecks(const DoctorCase& subject) {
    return {{"record_folder", [subject] { return CheckFolder(*subject); }},
            {"record_space", [subject] { return CheckSpace(*subject); }},
            {"record_quota", [subject] { return CheckQuota(*subject); }, {"record_space"}}};
}

}  // namespace hitchview::app

#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "drivers/lcm_log_reader.hpp"

namespace hitchview::tests {

/// One event of a recording, and the file that it stands in.
struct EventInFile {
    std::string file;
    std::string channel;
    std::int64_t utime_us = 0;
    std::vector<std::uint8_t> data;
};

inline std::vector<std::filesystem::path> Segments(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".lcm") files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

/// What a recording holds, segment after segment. `torn`: the end of the last one may be.
inline std::vector<EventInFile> RecordedEvents(const std::filesystem::path& folder,
                                               bool torn = false) {
    std::vector<EventInFile> events;
    const auto files = Segments(folder);
    for (const auto& file : files) {
        auto reader = drivers::LcmLogReader::Open(file);
        EXPECT_TRUE(reader) << reader.error();
        if (!reader) continue;
        while (auto event = reader.value()->Next()) {
            const auto& [number, utime_us, channel, data, position] = event.value();
            events.push_back({file.filename().string(),
                              std::string(channel),
                              utime_us,
                              {data.begin(), data.end()}});
        }
        const drivers::LcmLogDamage& damage = reader.value()->damage();
        const bool may_be_torn = torn && file == files.back();
        EXPECT_EQ(damage.skipped_bytes, may_be_torn ? damage.torn_bytes : 0) << file;
    }
    return events;
}

}  // namespace hitchview::tests

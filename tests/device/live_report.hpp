#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace hitchview::tests {

inline std::uint64_t Count(const nlohmann::json& report, const char* key) {
    return report.at(key).get<std::uint64_t>();
}

/// Of `report.json`: what each camera delivered was shown, or it is said what became of it.
inline void ExpectFramesAccountedFor(const nlohmann::json& report) {
    for (const auto& [name, camera] : report.at("live").at("cameras").items()) {
        EXPECT_EQ(Count(camera, "delivered"), Count(camera, "taken") + Count(camera, "superseded") +
                                                  Count(camera, "set_aside") +
                                                  Count(camera, "pending"))
            << name;
    }
}

}  // namespace hitchview::tests

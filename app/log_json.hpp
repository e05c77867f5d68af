#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "drivers/lcm_log_messages.hpp"

namespace hitchview::app {

/// A message of a log as its JSON schema wants it; null for what is not known.
struct LogJson {
    std::uint32_t sequence = 0;  ///< 0 where the type has none
    nlohmann::json content;
};

/// How messages of a kind become JSON.
struct LogJsonKind {
    drivers::LoggedKind kind;
    const char* schema_name;
    const char* schema;
    /// Empty if the message is damaged.
    std::optional<LogJson> (*convert)(std::span<const std::uint8_t> message);
};

/// Null if there is none for the kind.
const LogJsonKind* LogJsonKindOf(drivers::LoggedKind kind);

}  // namespace hitchview::app

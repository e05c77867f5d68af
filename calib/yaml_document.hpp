#pragma once

#include <yaml-cpp/node/node.h>

#include <filesystem>
#include <optional>
#include <string>

namespace hitchview::calib {

/// The root of a file's one document, or what is wrong with the file.
struct YamlDocument {
    std::optional<YAML::Node> root{};
    int line = 0;             ///< of the complaint; 0 for the file as a whole
    std::string complaint{};  ///< `the file ..., must be ...`
};

/// At most 1 MiB. The only place where the YAML library may throw; nothing leaves it.
YamlDocument ReadYamlDocument(const std::filesystem::path& file);
/// The same of a file's content.
YamlDocument ParseYamlDocument(const std::string& text);

}  // namespace hitchview::calib

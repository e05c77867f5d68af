#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "calib/format.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::calib {

/// The root of a file of another program: YAML, JSON or XML as OpenCV writes it, of mrcal a Python
/// literal. What is wrong goes into `complaints`, with the file's own line numbers. At most 16 MiB.
/// Throws nothing.
YamlMap LoadForeign(Format format, const std::filesystem::path& file, YamlComplaints& complaints);
/// The same of a file's content.
YamlMap ParseForeign(Format format, const std::string& text, YamlComplaints& complaints);

/// OpenCV's XML as YAML with each value on the line where it was; empty: it is not such XML.
std::optional<std::string> XmlAsYaml(const std::string& xml);

/// A Python literal of a dictionary as YAML, line by line: what stands in b'...' is left out.
std::string PythonAsYaml(const std::string& python);

}  // namespace hitchview::calib

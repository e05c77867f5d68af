#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/format.hpp"
#include "calib/yaml_map.hpp"

/// What the readers and writers of other programs' files have in common.
namespace hitchview::calib {

/// The first of these keys that is given; a required one of the first name if none is.
YamlValue FirstOf(YamlMap& map, std::initializer_list<std::string_view> keys);

/// The numbers of a list, of a list of lists, or of a matrix {rows, cols, data}, row by row. Empty
/// with a complaint where they are not `min` to `max` finite numbers.
std::optional<std::vector<double>> ReadNumbers(const YamlValue& value,
                                               const Range<std::size_t>& length);

/// Focal lengths and centre: fx fy cx cy.
void ReadFourIntrinsics(const YamlValue& value, algo::CameraModel& model);
/// The same from a matrix [fx 0 cx, 0 fy cy, 0 0 1].
void ReadCameraMatrix(const YamlValue& value, algo::CameraModel& model);
/// Coefficients in OpenCV's order; those beyond our model's must be 0. `model.kind` is known.
void ReadCoefficients(const YamlValue& value, algo::CameraModel& model);
/// The same of numbers that `value` holds among others.
void SetIntrinsics(const YamlValue& value, const std::array<double, 4>& fxfycxcy,
                   algo::CameraModel& model);
void SetCoefficients(const YamlValue& value, const std::vector<double>& coefficients,
                     algo::CameraModel& model);
/// Width and height, two numbers.
void ReadSize(const YamlValue& value, algo::CameraModel& model);
/// Complains where the picture's size is another than the hint's.
void CheckSize(const YamlValue& value, const ImportHints& hints, const algo::CameraModel& model);

/// Gives a lens its field of view. Complains at `distortion` where the distortion has no
/// inverse.
void CompleteField(const YamlValue& distortion, algo::CameraModel& model);

/// A text as one name: other characters become _; `otherwise` where nothing is left.
std::string AsName(std::string_view text, std::string_view otherwise);

/// Exact coefficients of a lens: five of a pinhole, four of a fisheye.
std::vector<double> Coefficients(const algo::CameraModel& model);

/// `[1, 2]`.
std::string ListText(const std::vector<double>& numbers);

/// Text in quotes, as YAML and Python read it.
std::string QuotedText(std::string_view text);

}  // namespace hitchview::calib

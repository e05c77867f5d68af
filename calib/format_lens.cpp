#include "calib/format_lens.hpp"

#include <algorithm>
#include <cmath>

#include "calib/lens_field.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;

constexpr Range<double> kAnyNumber{-1e12, 1e12};
constexpr std::size_t kMostNumbers = 1 << 16;
constexpr double kNarrowestField_rad = 0.05;

bool IsIn(double number, double min, double max) {
    return number >= min && number <= max;
}

void Append(const YamlValue& value, std::vector<double>& numbers) {
    if (value.is_list()) {
        for (const YamlValue& item : value.List({0, kMostNumbers})) {
            double number = NAN;  // stays where it cannot be read
            if (item.is_list() && numbers.size() < kMostNumbers) {
                Append(item, numbers);
            } else {
                item.Read(kAnyNumber, number);
                numbers.push_back(number);
            }
        }
    }
}

/// Those of a matrix; complains where they are not as many as its size says.
std::vector<double> MatrixNumbers(const YamlValue& value) {
    YamlMap matrix = value.Map();
    std::vector<double> numbers;
    const YamlValue data = matrix.Required("data");
    Append(data, numbers);
    constexpr Range<int> kSize{0, kMostNumbers};
    int rows = 0;
    int columns = 0;
    matrix.Required("rows").Read(kSize, rows);
    matrix.Required("cols").Read(kSize, columns);
    const auto count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
    if (count != numbers.size())
        data.Refuse("a list of " + std::to_string(count) + ", its rows times cols");
    return numbers;
}

std::string Text(const Range<std::size_t>& length) {
    const std::string least = std::to_string(length.min);
    return length.min == length.max ? least : least + " to " + std::to_string(length.max);
}

}  // namespace

YamlValue FirstOf(YamlMap& map, std::initializer_list<std::string_view> keys) {
    for (const std::string_view key : keys) {
        if (const YamlValue value = map[key]; value.given()) return value;
    }
    return map.Required(*keys.begin());
}

std::optional<std::vector<double>> ReadNumbers(const YamlValue& value,
                                               const Range<std::size_t>& length) {
    std::vector<double> numbers;
    if (value.is_map()) {
        numbers = MatrixNumbers(value);
    } else if (value.is_list()) {
        Append(value, numbers);
    } else {
        (void)value.List(length);  // complains
        return std::nullopt;
    }
    if (std::ranges::any_of(numbers, [](double n) { return std::isnan(n); })) return std::nullopt;
    if (numbers.size() >= length.min && numbers.size() <= length.max) return numbers;
    value.Refuse(Text(length) + " numbers, not " + std::to_string(numbers.size()));
    return std::nullopt;
}

void SetIntrinsics(const YamlValue& value, const std::array<double, 4>& fxfycxcy,
                   CameraModel& model) {
    const auto& [fx, fy, cx, cy] = fxfycxcy;
    if (!IsIn(fx, 10, 20000) || !IsIn(fy, 10, 20000))
        return value.Refuse("one with focal lengths of 10 to 20000 px, not " + ExactText({fx, fy}));
    if (!IsIn(cx, 0, 8192) || !IsIn(cy, 0, 8192))
        return value.Refuse("one with a centre at 0 to 8192 px, not " + ExactText({cx, cy}));
    model.fx_px = fx;
    model.fy_px = fy;
    model.cx_px = cx;
    model.cy_px = cy;
}

void ReadFourIntrinsics(const YamlValue& value, CameraModel& model) {
    const auto read = ReadNumbers(value, {4, 4});
    if (!read) return;
    const std::vector<double>& n = *read;
    SetIntrinsics(value, {n[0], n[1], n[2], n[3]}, model);
}

void ReadCameraMatrix(const YamlValue& value, CameraModel& model) {
    const auto read = ReadNumbers(value, {9, 9});
    if (!read) return;
    const std::vector<double>& n = *read;
    if (n[1] != 0 || n[3] != 0 || n[6] != 0 || n[7] != 0 || n[8] != 1)
        return value.Refuse("a matrix [fx 0 cx, 0 fy cy, 0 0 1], without skew");
    SetIntrinsics(value, {n[0], n[4], n[2], n[5]}, model);
}

void ReadCoefficients(const YamlValue& value, CameraModel& model) {
    const bool pinhole = model.kind == CameraModel::Kind::kPinholeRadtan;
    constexpr Range<std::size_t> kPinhole{0, 14};
    constexpr Range<std::size_t> kFisheye{4, 4};
    if (const auto n = ReadNumbers(value, pinhole ? kPinhole : kFisheye))
        SetCoefficients(value, *n, model);
}

void SetCoefficients(const YamlValue& value, const std::vector<double>& n, CameraModel& model) {
    const bool pinhole = model.kind == CameraModel::Kind::kPinholeRadtan;
    if (!pinhole && n.size() != 4)
        return value.Refuse("4 numbers, not " + std::to_string(n.size()));
    const std::size_t used = std::min<std::size_t>(n.size(), pinhole ? 5 : 4);
    if (std::any_of(n.begin() + static_cast<std::ptrdiff_t>(used), n.end(),
                    [](double k) { return k != 0; }))
        return value.Refuse(
            "k1 k2 p1 p2 k3 and then zeros: rational, thin-prism and tilt terms have no place in "
            "pinhole_radtan; calibrate again without them");
    if (!std::all_of(n.begin(), n.end(), [](double k) { return IsIn(k, -100, 100); }))
        return value.Refuse("numbers from -100 to 100");
    std::copy_n(n.begin(), used, model.distortion.begin());
}

void ReadSize(const YamlValue& value, CameraModel& model) {
    const auto read = ReadNumbers(value, {2, 2});
    if (!read) return;
    const std::vector<double>& n = *read;
    const auto fits = [](double px) { return IsIn(px, 64, 8192) && px == std::floor(px); };
    if (!fits(n[0]) || !fits(n[1]))
        return value.Refuse("a width and a height of 64 to 8192 px, not " +
                            ExactText({n[0], n[1]}));
    model.width_px = static_cast<int>(n[0]);
    model.height_px = static_cast<int>(n[1]);
}

void CheckSize(const YamlValue& value, const ImportHints& hints, const CameraModel& model) {
    if (!hints.size_px ||
        (model.width_px == (*hints.size_px)[0] && model.height_px == (*hints.size_px)[1]))
        return;
    value.Refuse("as --size says, " + std::to_string((*hints.size_px)[0]) + "x" +
                 std::to_string((*hints.size_px)[1]));
}

void CompleteField(const YamlValue& distortion, CameraModel& model) {
    if (!(model.fx_px > 0) || model.width_px == 0) return;
    model.max_theta_rad = FieldOf(model);
    if (model.max_theta_rad < kNarrowestField_rad)
        distortion.Refuse("a distortion that grows from the centre on");
}

std::string AsName(std::string_view text, std::string_view otherwise) {
    std::string name(text.substr(0, 64));
    for (char& c : name) {
        if (!IsName(std::string_view(&c, 1))) c = '_';
    }
    const bool none = name.find_first_not_of('_') == name.npos;
    return none ? std::string(otherwise) : name;
}

std::vector<double> Coefficients(const CameraModel& model) {
    const bool pinhole = model.kind == CameraModel::Kind::kPinholeRadtan;
    return {model.distortion.begin(), model.distortion.begin() + (pinhole ? 5 : 4)};
}

std::string ListText(const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "[" : ", ") + ExactText(number);
    return text.empty() ? "[]" : text + "]";
}

std::string QuotedText(std::string_view text) {
    std::string quoted(1, '\'');
    return quoted.append(AsName(text, "camera")).append(1, '\'');
}

}  // namespace hitchview::calib

#include "calib/unit_session.hpp"

#include <array>
#include <numbers>

#include "calib/board_pattern.hpp"
#include "calib/lens_file.hpp"
#include "calib/rig_calibration.hpp"
#include "calib/session_board.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::array kUnitNames{Choice<algo::Unit>{"tractor", algo::Unit::kTractor},
                                Choice<algo::Unit>{"trailer", algo::Unit::kTrailer}};

/// Corner of the printed pattern: right and down as shares of its size.
struct PrintedCorner {
    double right = 0;
    double down = 0;
};
constexpr std::array kPrintedCorners{
    Choice<PrintedCorner>{"top_left", {0, 0}}, Choice<PrintedCorner>{"top_right", {1, 0}},
    Choice<PrintedCorner>{"bottom_right", {1, 1}}, Choice<PrintedCorner>{"bottom_left", {0, 1}}};

Vector3d PlaceOf(const PrintedCorner& corner, const Board& board) {
    const BoardRectangle area = PatternArea(board);
    return {area.from_m.x() + corner.right * area.size_m().x(),
            area.from_m.y() + corner.down * area.size_m().y(), 0};
}

Vector3d ReadPoint(const YamlValue& value) {
    std::array<double, 3> point{};
    value.Read(Range<double>{-200, 200}, point);
    return Vector3d(point.data());
}

MeasuredPose ReadPose(const YamlValue& value) {
    YamlMap map = value.Map();
    MeasuredPose pose;
    std::array<double, 3> rpy_deg{};
    double sigma_deg = 0;
    pose.T_unit_camera.translation() = ReadPoint(map.Required("position_m"));
    map.Required("rpy_deg").Read(Range<double>{-360, 360}, rpy_deg);
    map.Required("sigma_m").Read(Range<double>{0.0001, 1}, pose.sigma_m);
    map.Required("sigma_deg").Read(Range<double>{0.001, 45}, sigma_deg);
    map.Finish();
    pose.T_unit_camera.linear() = RotationFromRpy(Vector3d(rpy_deg.data())).toRotationMatrix();
    pose.sigma_rad = sigma_deg * kDegree;
    return pose;
}

/// Reads one session. `folder`: where names of files start.
class SessionReader {
 public:
    explicit SessionReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

    UnitSession Read(YamlMap& root) {
        int schema = 1;
        root.Required("schema").Read(Range<int>{1, 1}, schema);
        root.Required("unit").Read(kUnitNames, session_.unit);
        root.Required("vehicle").Read(session_.vehicle);
        const YamlValue cameras = root.Required("cameras");
        ReadEach(cameras,
                 [&](const YamlValue& value, const std::string& name) { ReadCamera(value, name); });
        const YamlValue targets = root.Required("targets");
        ReadEach(targets,
                 [&](const YamlValue& value, const std::string& name) { ReadTarget(value, name); });
        const YamlValue far = root["far"];
        if (far.given()) far.Read(session_.far_shot);
        root.Finish();
        return std::move(session_);
    }

 private:
    template <typename ReadOne>
    static void ReadEach(const YamlValue& value, const ReadOne& read) {
        YamlMap map = value.Map();
        if (value.given() && map.keys().empty()) value.Refuse("a map of at least one by name");
        for (const std::string& name : map.keys()) {
            const YamlValue one = map.Required(name);
            if (!IsName(name)) one.Refuse("named with letters, digits and _ only");
            read(one, name);
        }
    }

    void ReadCamera(const YamlValue& value, const std::string& name) {
        YamlMap map = value.Map();
        UnitCamera camera{.name = name};
        camera.model = ReadLens(map.Required("lens"));
        std::string pictures;
        double yaw_deg = 0;
        map.Required("pictures").Read(pictures);
        map.Required("yaw_deg").Read(Range<double>{-360, 360}, yaw_deg);
        camera.yaw_rad = yaw_deg * kDegree;
        const YamlValue pose = map["pose"];
        if (pose.given()) camera.pose = ReadPose(pose);
        map.Finish();
        session_.problem.cameras.push_back(std::move(camera));
        session_.pictures.push_back((folder_ / pictures).string());
    }

    algo::CameraModel ReadLens(const YamlValue& value) const {
        std::string name;
        value.Read(name);
        if (name.empty()) return {};
        const LoadedLens lens = LoadLens(folder_ / name);
        if (!lens.model) {
            value.Refuse("a lens file: " + lens.error);
            return {};
        }
        if (lens.verdict == Verdict::kFail) value.Refuse("a lens whose verdict is not fail");
        return *lens.model;
    }

    void ReadTarget(const YamlValue& value, const std::string& name) {
        YamlMap map = value.Map();
        UnitTarget target{.name = name};
        const YamlValue board = map.Required("board");
        const auto known = ReadSessionBoard(board, folder_, session_.problem.targets);
        target.board = known.value_or(Board{});
        const YamlValue moves = map["moves"];
        if (moves.given()) moves.Read(target.moves);
        const YamlValue surveyed = map["surveyed"];
        if (surveyed.given() && known) ReadSurvey(surveyed, target);
        if (surveyed.given() && target.moves)
            surveyed.Refuse("left out for a target that moves: it has no one place");
        const YamlValue sigma = map["sigma_m"];
        if (sigma.given()) sigma.Read(Range<double>{0.0001, 0.5}, target.sigma_m);
        if (sigma.given() && !surveyed.given())
            sigma.Refuse("left out where no corner is surveyed");
        map.Finish();
        session_.problem.targets.push_back(std::move(target));
    }

    static void ReadSurvey(const YamlValue& value, UnitTarget& target) {
        for (const YamlValue& item : value.List({1, kPrintedCorners.size()})) {
            YamlMap map = item.Map();
            PrintedCorner printed;
            const YamlValue name = map.Required("corner");
            name.Read(kPrintedCorners, printed);
            const SurveyedCorner corner{PlaceOf(printed, target.board),
                                        ReadPoint(map.Required("at_m"))};
            for (const SurveyedCorner& other : target.surveyed) {
                if (other.p_board_m == corner.p_board_m) name.Refuse("given once");
            }
            map.Finish();
            target.surveyed.push_back(corner);
        }
    }

    std::filesystem::path folder_;
    UnitSession session_;
};

}  // namespace

LoadedUnitSession LoadUnitSession(const std::filesystem::path& file) {
    YamlComplaints complaints(file.string());
    YamlMap root = LoadYaml(file, complaints);
    UnitSession session = SessionReader(file.parent_path()).Read(root);
    if (!complaints.empty()) return {std::nullopt, complaints.Text()};
    return {std::move(session), ""};
}

}  // namespace hitchview::calib

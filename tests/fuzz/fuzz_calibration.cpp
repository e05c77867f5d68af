#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "calib/board.hpp"
#include "calib/format.hpp"
#include "calib/lens_file.hpp"
#include "calib/rig_calibration.hpp"
#include "hal/expect.hpp"
#include "tests/fuzz/fuzz_bytes.hpp"
#include "tests/fuzz/fuzz_complaint.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace hitchview;
using algo::CameraModel;
using calib::Format;
using Kind = CameraModel::Kind;

bool IsIn(double number, double min, double max) {
    return number >= min && number <= max;
}

/// Within what a calibration may say of a lens.
void ExpectSound(const CameraModel& lens) {
    HV_EXPECT(IsIn(lens.width_px, 64, 8192) && IsIn(lens.height_px, 64, 8192));
    HV_EXPECT(IsIn(lens.fx_px, 10, 20000) && IsIn(lens.fy_px, 10, 20000));
    HV_EXPECT(IsIn(lens.cx_px, 0, 8192) && IsIn(lens.cy_px, 0, 8192));
    for (const double coefficient : lens.distortion) HV_EXPECT(IsIn(coefficient, -100, 100));
    HV_EXPECT(IsIn(lens.max_theta_rad, 0.05, lens.kind == Kind::kPinholeRadtan ? 1.58 : 3.15));
}

bool IsSame(const CameraModel& a, const CameraModel& b) {
    return a.kind == b.kind && a.width_px == b.width_px && a.height_px == b.height_px &&
           a.fx_px == b.fx_px && a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px &&
           a.distortion == b.distortion && a.max_theta_rad == b.max_theta_rad;
}

/// Written and read again it is the same, to the last digit.
void ReadRig(const std::string& text, int lines) {
    const auto loaded = calib::ParseCalibration(text, "rig");
    HV_EXPECT(loaded.calibration.has_value() == loaded.error.empty());
    if (!loaded.calibration) return tests::ExpectComplaint(loaded.error, "rig", lines);
    const calib::RigCalibration& rig = *loaded.calibration;
    HV_EXPECT(!rig.cameras.empty() && !rig.vehicle.empty());
    for (const auto& [name, camera] : rig.cameras) {
        HV_EXPECT(calib::IsName(name));
        ExpectSound(camera.model);
        HV_EXPECT(std::abs(camera.q_unit_camera.norm() - 1) <= 1.1e-6);
        HV_EXPECT(camera.position_m.cwiseAbs().maxCoeff() <= 50);
    }
    const std::string written = calib::ToYaml(rig);
    const auto again = calib::ParseCalibration(written, "again");
    HV_EXPECT(again.calibration && calib::ToYaml(*again.calibration) == written);
    HV_EXPECT(again.calibration->id() == rig.id());
}

void ReadLens(const std::string& text, int lines) {
    const auto lens = calib::ParseLens(text, "lens");
    HV_EXPECT(lens.model.has_value() == lens.error.empty());
    if (!lens.model) return tests::ExpectComplaint(lens.error, "lens", lines);
    ExpectSound(*lens.model);
}

void ReadBoard(const std::string& text, int lines) {
    const auto parsed = calib::ParseBoardFile(text, "board");
    HV_EXPECT(parsed.board.has_value() == parsed.error.empty());
    if (!parsed.board) return tests::ExpectComplaint(parsed.error, "board", lines);
    const calib::Board& board = *parsed.board;
    HV_EXPECT(IsIn(board.columns, 1, 50) && IsIn(board.rows, 1, 50));
    HV_EXPECT(IsIn(board.square_m, 0.001, 2) && board.tag_m < board.square_m);
    HV_EXPECT(std::ssize(board.Corners()) == board.count());
}

/// Exported and imported again it is the same lens.
void ExpectSameWhenExported(Format format, const calib::ForeignCamera& camera) {
    const auto exported = calib::ExportLens(format, camera.name, camera.model);
    if (!exported.error.empty()) return;
    const auto again = calib::ParseCameras(format, exported.files.front().text, "again", {});
    HV_EXPECT(again.error.empty() && again.cameras.size() == 1);
    HV_EXPECT(IsSame(again.cameras.front().model, camera.model));
}

void Import(Format format, const std::string& text, const calib::ImportHints& hints, int lines) {
    const auto read = calib::ParseCameras(format, text, "file.yaml", hints);
    HV_EXPECT(read.cameras.empty() != read.error.empty());
    if (!read.error.empty()) return tests::ExpectComplaint(read.error, "file.yaml", lines);
    for (const calib::ForeignCamera& camera : read.cameras) {
        HV_EXPECT(calib::IsName(camera.name));
        ExpectSound(camera.model);
        HV_EXPECT(!hints.kind || camera.model.kind == *hints.kind);
        HV_EXPECT(!camera.T_reference_camera || camera.T_reference_camera->matrix().allFinite());
        ExpectSameWhenExported(format, camera);
    }
}

}  // namespace

/// The first letter says which file it is.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string text(tests::TextOf({data + 1, size - 1}));
    const int lines = tests::LinesOf(text);
    switch (data[0]) {
        case 'l':
            ReadLens(text, lines);
            break;
        case 'b':
            ReadBoard(text, lines);
            break;
        case 'o':
            Import(Format::kOpenCv, text, {}, lines);
            break;
        case 'f':
            Import(Format::kOpenCv, text, {Kind::kKannalaBrandt4, std::array{1280, 720}}, lines);
            break;
        case 's':
            Import(Format::kRos, text, {}, lines);
            break;
        case 'k':
            Import(Format::kKalibr, text, {}, lines);
            break;
        case 'm':
            Import(Format::kMrcal, text, {}, lines);
            break;
        default:
            ReadRig(text, lines);
    }
    return 0;
}

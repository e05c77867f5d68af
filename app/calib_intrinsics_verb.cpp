#include "app/calib_intrinsics_verb.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/calib_pictures.hpp"
#include "app/report.hpp"
#include "calib/intrinsics.hpp"
#include "calib/lens_file.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

constexpr int kBad = 1;
constexpr int kWrongUse = 2;
constexpr int kMachineFailed = 3;
constexpr std::size_t kFewestViews = 3;

int Fail(int code, const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    return code;
}

calib::LensProblem Problem(const IntrinsicsOptions& options, const calib::Board& board,
                           const BoardPictures& pictures) {
    calib::LensProblem problem{.kind = options.model,
                               .width_px = pictures.width_px,
                               .height_px = pictures.height_px,
                               .board = board,
                               .views = {}};
    for (const calib::BoardView& view : pictures.views) problem.views.push_back(view.corners);
    return problem;
}

std::vector<std::string> Names(const BoardPictures& pictures) {
    std::vector<std::string> names;
    for (const calib::BoardView& view : pictures.views) names.push_back(view.name);
    return names;
}

json ViewsJson(const calib::Intrinsics& lens) {
    json views = json::array();
    for (const calib::ViewOutcome& view : lens.views) {
        views.push_back({{"name", view.name},
                         {"used", view.used},
                         {"rms_px", view.used ? json(view.rms_px) : json(nullptr)}});
    }
    return views;
}

json UncertaintyJson(const calib::Intrinsics& lens) {
    json places = json::array();
    for (const calib::PixelUncertainty& place : lens.uncertainty)
        places.push_back({place.at_px.x(), place.at_px.y(), place.sigma_px});
    return places;
}

json ModelJson(const calib::Intrinsics& lens) {
    const algo::CameraModel& m = lens.model;
    const bool pinhole = m.kind == algo::CameraModel::Kind::kPinholeRadtan;
    return {{"model", std::string(ToString(m.kind))},
            {"size_px", {m.width_px, m.height_px}},
            {"focal_px", {m.fx_px, m.fy_px}},
            {"centre_px", {m.cx_px, m.cy_px}},
            {"distortion",
             std::vector<double>(m.distortion.begin(), m.distortion.begin() + (pinhole ? 5 : 4))},
            {"max_theta_rad", m.max_theta_rad},
            {"sigma", lens.sigma}};
}

json Report(const calib::Intrinsics& lens, const BoardPictures& pictures) {
    const auto used = std::ranges::count_if(lens.views, &calib::ViewOutcome::used);
    return {{"verdict", std::string(ToString(lens.verdict))},
            {"reasons", lens.reasons},
            {"rms_px", lens.rms_px},
            {"heldout_rms_px", lens.heldout_rms_px ? json(*lens.heldout_rms_px) : json(nullptr)},
            {"pictures", pictures.pictures},
            {"views_found", pictures.views.size()},
            {"views_used", used},
            {"views", ViewsJson(lens)},
            {"board",
             {{"shape", lens.shape == calib::BoardShape::kFlat ? "flat" : "measured"},
              {"bulge_m", lens.bulge_m}}},
            {"covered", lens.spread.covered},
            {"most_tilt_rad", lens.spread.most_tilt_rad},
            {"lens", ModelJson(lens)},
            {"uncertainty", UncertaintyJson(lens)}};
}

void PrintLens(const calib::Intrinsics& lens) {
    const algo::CameraModel& m = lens.model;
    const auto plus_minus = [&](std::size_t i) {
        return i < lens.sigma.size() ? 2 * lens.sigma[i] : 0.0;
    };
    std::printf("focal   %.2f +- %.2f, %.2f +- %.2f px\n", m.fx_px, plus_minus(0), m.fy_px,
                plus_minus(1));
    std::printf("centre  %.2f +- %.2f, %.2f +- %.2f px\n", m.cx_px, plus_minus(2), m.cy_px,
                plus_minus(3));
    std::printf("field   %.1f degrees from the axis\n", m.max_theta_rad * 180 / std::numbers::pi);
    if (lens.shape == calib::BoardShape::kMeasured)
        std::printf("board   not flat, measured: up to %.1f mm\n", 1000 * lens.bulge_m);
}

void Print(const calib::Intrinsics& lens, const BoardPictures& pictures) {
    const auto used = std::ranges::count_if(lens.views, &calib::ViewOutcome::used);
    std::printf("views   %zu pictures, board found in %zu, used %zd\n", pictures.pictures,
                pictures.views.size(), used);
    for (const calib::ViewOutcome& view : lens.views) {
        if (!view.used)
            std::printf("        %s left out: far worse than the others\n", view.name.c_str());
    }
    std::printf("errors  %.3f px", lens.rms_px);
    if (lens.heldout_rms_px)
        std::printf(", %.3f px in views that were left out", *lens.heldout_rms_px);
    std::printf("\n");
    PrintLens(lens);
    std::printf("verdict: %s\n", std::string(ToString(lens.verdict)).c_str());
    for (const std::string& reason : lens.reasons) std::printf("  %s\n", reason.c_str());
}

/// Why there is nothing to solve; empty if there is.
std::string Refusal(const BoardPictures& pictures, const IntrinsicsOptions& options) {
    const std::string size = options.board.substr(0, options.board.find(','));
    if (pictures.views.size() >= kFewestViews && 2 * pictures.larger_boards > pictures.views.size())
        return "the board goes on beyond " + size +
               " inner corners: count the corners between four squares, all of them";
    if (pictures.views.size() >= kFewestViews) return "";
    return "a board of " + size + " inner corners is in " + std::to_string(pictures.views.size()) +
           " of " + std::to_string(pictures.pictures) + " pictures, at least " +
           std::to_string(kFewestViews) +
           " are needed: count the corners between four squares, and let the whole board be seen";
}

int Save(const calib::Intrinsics& lens, const BoardPictures& pictures,
         const IntrinsicsOptions& options) {
    std::string problem;
    if (!options.json.empty()) problem = WriteJson(Report(lens, pictures), options.json);
    if (problem.empty() && !options.out.empty())
        problem = calib::SaveLens(lens, options.command, options.out);
    return problem.empty() ? 0 : Fail(kMachineFailed, problem);
}

}  // namespace

int IntrinsicsVerb(const IntrinsicsOptions& options) {
    const calib::ParsedBoard board = calib::ParseBoard(options.board);
    if (!board.board) return Fail(kWrongUse, board.error);
    const auto found = FindBoards(options.images, *board.board);
    if (!found) return Fail(kWrongUse, found.error());
    const BoardPictures& pictures = found.value();
    if (const std::string why = Refusal(pictures, options); !why.empty())
        return Fail(kWrongUse, why);
    const auto lens =
        calib::MeasureIntrinsics(Problem(options, *board.board, pictures), Names(pictures));
    if (!lens) return Fail(kBad, "no lens of this model explains the pictures");
    Print(*lens, pictures);
    if (const int failed = Save(*lens, pictures, options); failed != 0) return failed;
    return lens->verdict == calib::Verdict::kPass ? 0 : kBad;
}

}  // namespace hitchview::app

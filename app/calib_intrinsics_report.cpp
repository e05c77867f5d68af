#include "app/calib_intrinsics_report.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>

namespace hitchview::app {
namespace {

using nlohmann::json;

const char* Words(calib::ViewOutcome::Fate fate) {
    switch (fate) {
        case calib::ViewOutcome::Fate::kUsed:
            return "used";
        case calib::ViewOutcome::Fate::kFewCorners:
            return "too little of the board is seen";
        case calib::ViewOutcome::Fate::kSmeared:
            return "smeared: it moved, or is out of focus";
        case calib::ViewOutcome::Fate::kOutlier:
            return "far worse than the others";
    }
    return "";
}

json ViewsJson(const calib::Intrinsics& lens) {
    json views = json::array();
    for (const calib::ViewOutcome& view : lens.views) {
        views.push_back({{"name", view.name},
                         {"used", view.is_used()},
                         {"fate", Words(view.fate)},
                         {"blur_px", view.blur_px ? json(*view.blur_px) : json(nullptr)},
                         {"rms_px", view.is_used() ? json(view.rms_px) : json(nullptr)}});
    }
    return views;
}

json UncertaintyJson(const calib::Intrinsics& lens) {
    json places = json::array();
    for (const calib::PixelUncertainty& place : lens.uncertainty)
        places.push_back({place.at_px.x(), place.at_px.y(), place.sigma_px});
    return places;
}

json ResidualsJson(const calib::Intrinsics& lens) {
    json residuals = json::array();
    for (const calib::CornerResidual& r : lens.residuals) {
        residuals.push_back({r.view, r.at_px.x(), r.at_px.y(), r.off_px.x(), r.off_px.y()});
    }
    return residuals;
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

}  // namespace

json IntrinsicsJson(const calib::Intrinsics& lens, const BoardPictures& pictures) {
    const auto used = std::ranges::count_if(lens.views, &calib::ViewOutcome::is_used);
    return {{"verb", "intrinsics"},
            {"verdict", std::string(ToString(lens.verdict))},
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
            {"residuals", ResidualsJson(lens)},
            {"coverage", lens.spread.corners},
            {"covered", lens.spread.covered},
            {"most_tilt_rad", lens.spread.most_tilt_rad},
            {"lens", ModelJson(lens)},
            {"uncertainty", UncertaintyJson(lens)}};
}

namespace {

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

}  // namespace

void PrintIntrinsics(const calib::Intrinsics& lens, const BoardPictures& pictures) {
    const auto used = std::ranges::count_if(lens.views, &calib::ViewOutcome::is_used);
    std::printf("views   %zu pictures, board found in %zu, used %zd\n", pictures.pictures,
                pictures.views.size(), used);
    for (const calib::ViewOutcome& view : lens.views) {
        if (!view.is_used())
            std::printf("        %s left out: %s\n", view.name.c_str(), Words(view.fate));
    }
    std::printf("errors  %.3f px", lens.rms_px);
    if (lens.heldout_rms_px)
        std::printf(", %.3f px in views that were left out", *lens.heldout_rms_px);
    std::printf("\n");
    PrintLens(lens);
    std::printf("verdict: %s\n", std::string(ToString(lens.verdict)).c_str());
    for (const std::string& reason : lens.reasons) std::printf("  %s\n", reason.c_str());
}

}  // namespace hitchview::app

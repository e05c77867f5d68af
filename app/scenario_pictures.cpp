#include "app/scenario_pictures.hpp"

#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "app/demo_picture.hpp"

namespace hitchview::app {
namespace {

/// Panoramas of one drive that are kept.
constexpr int kPanoramas = 6;
/// To each side of the seam.
constexpr int kHalfCrop_px = 128;
/// Seams are looked at closely.
constexpr int kZoom = 2;
constexpr int kGap_px = 8;

/// A part of the ring round a column.
cv::Mat CropRound(const cv::Mat& panorama, double column) {
    const int width = 2 * kHalfCrop_px;
    const int from = (static_cast<int>(column) - kHalfCrop_px + panorama.cols) % panorama.cols;
    cv::Mat twice;
    cv::hconcat(panorama, panorama, twice);
    cv::Mat crop;
    cv::resize(twice.colRange(from, from + width), crop, {}, kZoom, kZoom, cv::INTER_LINEAR);
    return crop;
}

cv::Mat SideBySide(const std::array<cv::Mat, 3>& crops) {
    const cv::Mat gap(crops[0].rows, kGap_px, CV_8UC3, cv::Scalar(0, 0, 255));
    cv::Mat all;
    cv::hconcat(std::vector<cv::Mat>{crops[0], gap, crops[1], gap, crops[2]}, all);
    return all;
}

}  // namespace

ScenarioPictures::ScenarioPictures(std::string name, std::filesystem::path out, int frames)
    : name_(std::move(name)), out_(std::move(out)), every_(std::max(1, frames / kPanoramas)) {}

void ScenarioPictures::OfferPanorama(const ShownPanorama& shown) {
    const int frame = static_cast<int>(shown.picture.header.sequence);
    if (out_.empty() || frame % every_ != every_ - 1) return;
    panoramas_[frame] = ToBgr(shown.picture);
}

void ScenarioPictures::OfferSeam(algo::Overlap overlap, double error_px, const ShownPanorama& shown,
                                 Pipeline& pipeline) {
    WorstSeam& worst = worst_[overlap];
    if (out_.empty() || error_px <= worst.error_px) return;
    const double seam_px = pipeline.map().seam_px()[overlap];
    const cv::Mat both = CropRound(ToBgr(shown.picture), seam_px);
    const cv::Mat tractor = CropRound(ToBgr(pipeline.RenderView(algo::Unit::kTractor)), seam_px);
    const cv::Mat trailer = CropRound(ToBgr(pipeline.RenderView(algo::Unit::kTrailer)), seam_px);
    worst = {error_px, SideBySide({tractor, trailer, both})};
    char caption[96];
    std::snprintf(caption, sizeof caption, "frame %u, %.1f px: tractor | trailer | panorama",
                  shown.picture.header.sequence, error_px);
    cv::putText(worst.picture, caption, {8, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.6, {0, 255, 255}, 2);
}

std::string ScenarioPictures::Write() const {
    if (out_.empty()) return "";
    std::error_code refused;
    std::filesystem::create_directories(out_, refused);
    std::map<std::string, cv::Mat> pictures;
    for (const auto& [frame, picture] : panoramas_)
        pictures[name_ + "_" + std::to_string(frame) + ".png"] = picture;
    for (const algo::Overlap overlap : algo::kOverlaps) {
        if (!worst_[overlap].picture.empty())
            pictures[name_ + "_seam_" + ToString(overlap) + ".png"] = worst_[overlap].picture;
    }
    for (const auto& [file, picture] : pictures) {
        if (!cv::imwrite((out_ / file).string(), picture))
            return (out_ / file).string() + ": cannot be written";
    }
    return "";
}

}  // namespace hitchview::app

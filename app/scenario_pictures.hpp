#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <string>

#include "app/pipeline.hpp"

namespace hitchview::app {

/// Pictures of one drive for the eye: a few panoramas, and of each overlap the frame whose seam is
/// worst, both units' layers and the panorama beside each other.
class ScenarioPictures {
 public:
    /// `out`: folder; empty: nothing is kept.
    ScenarioPictures(std::string name, std::filesystem::path out, int frames);

    void OfferPanorama(const ShownPanorama& shown);
    /// Kept if no frame offered before was worse.
    void OfferSeam(algo::Overlap overlap, double error_px, const ShownPanorama& shown,
                   Pipeline& pipeline);

    /// `out`/NAME_FRAME.png and `out`/NAME_seam_OVERLAP.png. Empty on success, otherwise what could
    /// not be written.
    [[nodiscard]] std::string Write() const;

 private:
    struct WorstSeam {
        double error_px = 0;
        cv::Mat picture;
    };

    std::string name_;
    std::filesystem::path out_;
    int every_;
    std::map<int, cv::Mat> panoramas_;  // by frame
    algo::PerOverlap<WorstSeam> worst_;
};

}  // namespace hitchview::app

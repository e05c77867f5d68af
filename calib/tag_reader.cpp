#include "calib/tag_reader.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;
using Tags = std::vector<SeenTag>;

/// Grey levels between a bit and the threshold, on average.
constexpr float kLeastMargin = 10;

struct Destroy {
    void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
    void operator()(apriltag_detector_t* detector) const { apriltag_detector_destroy(detector); }
    void operator()(zarray_t* detections) const { apriltag_detections_destroy(detections); }
};

/// Cheap to make, as no wrong bits are looked up.
class Reader {
 public:
    Reader() : family_(tag36h11_create()), detector_(apriltag_detector_create()) {
        apriltag_detector_add_family_bits(detector_.get(), family_.get(), 0);
        detector_->quad_decimate = 1;
    }

    /// Adds what `grey` shows.
    void Read(const cv::Mat& grey, Tags& tags) const {
        image_u8_t image = {grey.cols, grey.rows, static_cast<std::int32_t>(grey.step), grey.data};
        const std::unique_ptr<zarray_t, Destroy> found(
            apriltag_detector_detect(detector_.get(), &image));
        for (int i = 0; i < zarray_size(found.get()); ++i) {
            apriltag_detection_t* tag = nullptr;
            zarray_get(found.get(), i, static_cast<void*>(&tag));
            if (tag->hamming == 0 && tag->decision_margin >= kLeastMargin)
                tags.push_back(Seen(*tag));
        }
    }

 private:
    /// Theirs run from the bottom left counter-clockwise, and count from the edge of a pixel.
    static SeenTag Seen(const apriltag_detection_t& tag) {
        SeenTag seen{.number = tag.id};
        for (std::size_t i = 0; i < 4; ++i)
            seen.corners_px[i] = {tag.p[3 - i][0] - 0.5, tag.p[3 - i][1] - 0.5};
        return seen;
    }

    std::unique_ptr<apriltag_family_t, Destroy> family_;
    std::unique_ptr<apriltag_detector_t, Destroy> detector_;
};

bool IsSame(const SeenTag& a, const SeenTag& b) {
    return (a.middle_px() - b.middle_px()).norm() < 0.5 * a.side_px();
}

/// Sorted by number, each place once, without numbers that are at two places.
Tags Unambiguous(Tags tags) {
    std::ranges::stable_sort(tags, {}, &SeenTag::number);
    Tags kept;
    for (auto first = tags.begin(); first != tags.end();) {
        const auto end = std::find_if(
            first, tags.end(), [&](const SeenTag& tag) { return tag.number != first->number; });
        if (std::all_of(first, end, [&](const SeenTag& tag) { return IsSame(*first, tag); }))
            kept.push_back(*first);
        first = end;
    }
    return kept;
}

}  // namespace

Vector2d SeenTag::middle_px() const {
    return (corners_px[0] + corners_px[1] + corners_px[2] + corners_px[3]) / 4;
}

double SeenTag::side_px() const {
    double sum_px = 0;
    for (std::size_t i = 0; i < 4; ++i) sum_px += (corners_px[i] - corners_px[(i + 1) % 4]).norm();
    return sum_px / 4;
}

Tags ReadTags(const cv::Mat& grey) {
    const Reader reader;
    Tags tags;
    reader.Read(grey, tags);
    // Where dark squares touch the corners of a tag, blur may join them with its frame: a second
    // look with white grown by a pixel parts them.
    cv::Mat parted;
    cv::dilate(grey, parted, cv::Mat());
    reader.Read(parted, tags);
    return Unambiguous(std::move(tags));
}

}  // namespace hitchview::calib

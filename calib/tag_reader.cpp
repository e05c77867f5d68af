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

/// Where a tag's frame lies after its white surroundings have grown into it by `grown_px`.
SeenTag Regrown(const SeenTag& tag, double grown_px) {
    SeenTag regrown{.number = tag.number};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vector2d& at = tag.corners_px[i];
        const Vector2d outwards = (at - tag.corners_px[(i + 1) % 4]).normalized() +
                                  (at - tag.corners_px[(i + 3) % 4]).normalized();
        regrown.corners_px[i] = at + grown_px * outwards;
    }
    return regrown;
}

/// A part of a picture, perhaps enlarged, in which white has grown.
struct Part {
    cv::Mat grey{};
    cv::Point origin_px{};
    int enlarged = 1;
    double grown_px = 0;  ///< of `grey`
};

/// Cheap to make, as no wrong bits are looked up.
class Reader {
 public:
    Reader() : family_(tag36h11_create()), detector_(apriltag_detector_create()) {
        apriltag_detector_add_family_bits(detector_.get(), family_.get(), 0);
        detector_->quad_decimate = 1;
    }

    /// Adds what the part shows, in pixels of the whole picture.
    void Read(const Part& part, Tags& tags) const {
        image_u8_t image = {part.grey.cols, part.grey.rows,
                            static_cast<std::int32_t>(part.grey.step), part.grey.data};
        const std::unique_ptr<zarray_t, Destroy> found(
            apriltag_detector_detect(detector_.get(), &image));
        for (int i = 0; i < zarray_size(found.get()); ++i) {
            apriltag_detection_t* tag = nullptr;
            zarray_get(found.get(), i, static_cast<void*>(&tag));
            if (tag->hamming == 0 && tag->decision_margin >= kLeastMargin)
                tags.push_back(Seen(*tag, part));
        }
    }

 private:
    /// Theirs run from the bottom left counter-clockwise, and count from the edge of a pixel.
    static SeenTag Seen(const apriltag_detection_t& tag, const Part& part) {
        SeenTag seen{.number = tag.id};
        for (std::size_t i = 0; i < 4; ++i) seen.corners_px[i] = {tag.p[3 - i][0], tag.p[3 - i][1]};
        seen = Regrown(seen, part.grown_px);
        for (Vector2d& at : seen.corners_px)
            at = at / part.enlarged + Vector2d(part.origin_px.x - 0.5, part.origin_px.y - 0.5);
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

/// What lies around the tags, where more of them may be.
cv::Rect Surroundings(const Tags& tags, const cv::Size& size) {
    cv::Rect box;
    for (const SeenTag& tag : tags) {
        const int reach = static_cast<int>(4 * tag.side_px());
        const Vector2d at = tag.middle_px();
        box |= cv::Rect(static_cast<int>(at.x()) - reach, static_cast<int>(at.y()) - reach,
                        2 * reach, 2 * reach);
    }
    return box & cv::Rect({0, 0}, size);
}

Part WithWhiteGrown(const Part& part, cv::MorphShapes shape, int by_px) {
    Part grown{.origin_px = part.origin_px, .enlarged = part.enlarged, .grown_px = 1.0 * by_px};
    cv::dilate(part.grey, grown.grey,
               cv::getStructuringElement(shape, {2 * by_px + 1, 2 * by_px + 1}));
    return grown;
}

Part Enlarged(const cv::Mat& grey, const cv::Rect& box) {
    Part part{.origin_px = box.tl(), .enlarged = 2};
    cv::resize(grey(box), part.grey, {}, part.enlarged, part.enlarged, cv::INTER_CUBIC);
    return part;
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
    constexpr double kSmall_px = 30;  // bits of a few pixels are read better when enlarged
    const Reader reader;
    Tags tags;
    reader.Read({.grey = grey}, tags);
    const bool small =
        std::ranges::any_of(tags, [](const SeenTag& tag) { return tag.side_px() < kSmall_px; });
    if (small) reader.Read(Enlarged(grey, Surroundings(tags, grey.size())), tags);
    return Unambiguous(std::move(tags));
}

Tags ReadJoinedTags(const cv::Mat& grey) {
    const Reader reader;
    Tags tags;
    reader.Read(WithWhiteGrown({.grey = grey}, cv::MORPH_CROSS, 1), tags);
    const cv::Rect box = Surroundings(tags, grey.size());
    if (box.empty()) return tags;
    const Part enlarged = Enlarged(grey, box);
    reader.Read(WithWhiteGrown(enlarged, cv::MORPH_RECT, 1), tags);
    reader.Read(WithWhiteGrown(enlarged, cv::MORPH_RECT, 2), tags);
    return Unambiguous(std::move(tags));
}

}  // namespace hitchview::calib

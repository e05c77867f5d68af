#include "algo/semi_surround_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

/// Features keep this far from where two cameras meet and from where the view ends, analysis px.
constexpr int kJointMargin_px = 7;

/// Camera pixels per radian near the optical axis over analysis pixels per radian, as a power of 2.
int ReductionFor(const UnitGeometry& geometry, double scale) {
    const Projection& view = geometry.view();
    double ratio = 1 / scale;
    if (view.IsRing()) {
        Eigen::Vector2d a;
        Eigen::Vector2d b;
        UnitGeometry::Sights sights;
        for (double x = 0; x < view.width_px; x += 1) {
            geometry.See(view.Ray({x, view.horizon_y_px}), sights);
            if (sights.empty() || sights[0].weight < 0.5) continue;
            const int camera = sights[0].camera;
            if (!geometry.Project(camera, view.Ray({x, view.horizon_y_px}), a) ||
                !geometry.Project(camera, view.Ray({x + 1, view.horizon_y_px}), b)) {
                continue;
            }
            ratio = (a - b).norm() / scale;
            break;
        }
    }
    int reduction = 1;
    while (reduction < 8 && reduction * 1.5 < ratio) reduction *= 2;
    return reduction;
}

/// Pixels that are blended at a time.
constexpr int kBlock = 128;
constexpr int kFractionBits = 5;
constexpr int kOne = 1 << kFractionBits;

/// Pixels and their right neighbours, in the high byte, of two rows, and where between them.
struct Block {
    std::array<std::uint16_t, kBlock> upper;
    std::array<std::uint16_t, kBlock> lower;
    std::array<std::uint8_t, kBlock> right;
    std::array<std::uint8_t, kBlock> below;
};

inline std::uint16_t PairAt(const std::uint8_t* pixel) {
    return static_cast<std::uint16_t>(pixel[0] | pixel[1] << 8);
}

HV_MULTIVERSION
void Blend(const Block& block, int count, std::uint8_t* __restrict out) {
    for (int i = 0; i < count; ++i) {
        const int right = block.right[i];
        const int below = block.below[i];
        const auto along = [&](int pair) {
            return (pair & 0xFF) * (kOne - right) + (pair >> 8) * right;
        };
        const int sum = along(block.upper[i]) * (kOne - below) + along(block.lower[i]) * below;
        out[i] = static_cast<std::uint8_t>((sum + kOne * kOne / 2) >> (2 * kFractionBits));
    }
}

int WidestCamera_px(const UnitGeometry& geometry) {
    int widest = 0;
    for (int i = 0; i < geometry.cameras(); ++i)
        widest = std::max(widest, geometry.camera_width_px(i));
    return widest;
}

}  // namespace

SemiSurroundView::SemiSurroundView(const UnitGeometry& geometry, double scale)
    : cameras_(geometry.cameras()),
      scale_(scale),
      reduction_(ReductionFor(geometry, scale)),
      reducer_(reduction_, WidestCamera_px(geometry) / reduction_) {
    const Projection analysis = geometry.view().Scaled(scale);
    camera_ = cv::Mat_<std::uint8_t>(analysis.height_px, analysis.width_px, kNoCamera);
    sources_.resize(camera_.total());
    for (int i = 0; i < geometry.cameras(); ++i) {
        reduced_[static_cast<std::size_t>(i)] =
            cv::Mat1b(geometry.camera_height_px(i) / reduction_,
                      geometry.camera_width_px(i) / reduction_, std::uint8_t{0});
    }
    BuildMap(geometry);
    MaskJoints();
    FindRuns();
    FindUsed();
    mask_ = calibrated_mask_.clone();
}

std::optional<int> SemiSurroundView::CameraAt(const Eigen::Vector2f& analysis) const {
    const auto x = static_cast<int>(std::lround(analysis.x()));
    const auto y = static_cast<int>(std::lround(analysis.y()));
    const bool inside = x >= 0 && y >= 0 && x < camera_.cols && y < camera_.rows;
    if (!inside || camera_(y, x) == kNoCamera) return std::nullopt;
    return camera_(y, x);
}

void SemiSurroundView::BuildMap(const UnitGeometry& geometry) {
    UnitGeometry::Sights sights;
    for (int y = 0; y < camera_.rows; ++y) {
        for (int x = 0; x < camera_.cols; ++x) {
            const Eigen::Vector2d view = ToView({static_cast<float>(x), static_cast<float>(y)});
            geometry.See(geometry.view().Ray(view), sights);
            const auto best = std::max_element(
                sights.begin(), sights.end(),
                [](const CameraSight& a, const CameraSight& b) { return a.weight < b.weight; });
            if (best == sights.end() || best->weight <= 0) continue;
            const Eigen::Vector2d pixel = (best->pixel.array() + 0.5) / reduction_ - 0.5;
            const cv::Mat1b& reduced = reduced_[static_cast<std::size_t>(best->camera)];
            // So that a right and a lower neighbour exist, also after rounding.
            if (pixel.minCoeff() < 0 || pixel.x() > reduced.cols - 1 - 1.0 / kOne ||
                pixel.y() > reduced.rows - 1 - 1.0 / kOne) {
                continue;
            }
            camera_(y, x) = static_cast<std::uint8_t>(best->camera);
            const Eigen::Vector2i at = (kOne * pixel).array().round().cast<int>();
            sources_[static_cast<std::size_t>(y * camera_.cols + x)] = {
                (at.y() >> kFractionBits) * reduced.cols + (at.x() >> kFractionBits),
                static_cast<std::uint8_t>(at.x() % kOne), static_cast<std::uint8_t>(at.y() % kOne)};
        }
    }
}

void SemiSurroundView::MaskJoints() {
    cv::Mat lowest;
    cv::Mat highest;
    const cv::Mat window = cv::Mat::ones(2 * kJointMargin_px + 1, 2 * kJointMargin_px + 1, CV_8U);
    cv::erode(camera_, lowest, window);
    cv::dilate(camera_, highest, window);
    calibrated_mask_ = (lowest == highest) & (camera_ != kNoCamera);
}

void SemiSurroundView::FindRuns() {
    for (int y = 0; y < camera_.rows; ++y) {
        for (int x = 0; x < camera_.cols;) {
            const Run run = RunFrom(y, x);
            if (run.camera != kNoCamera) runs_.push_back(run);
            x = run.end;
        }
    }
}

SemiSurroundView::Run SemiSurroundView::RunFrom(int y, int first) const {
    const std::uint8_t* camera = camera_[y];
    const Source* source = sources_.data() + static_cast<std::ptrdiff_t>(y) * camera_.cols;
    Run run{y, first, first, camera[first], true};
    for (; run.end < camera_.cols && camera[run.end] == run.camera; ++run.end) {
        const Source& at = source[run.end];
        const bool whole = at.right == 0 && at.below == 0;
        const bool beside = run.end == first || at.offset == source[run.end - 1].offset + 1;
        run.copied = run.copied && whole && beside;
    }
    return run;
}

/// What the runs read, with the right and lower neighbours.
void SemiSurroundView::FindUsed() {
    for (const Run& run : runs_) {
        cv::Rect& used = used_[static_cast<std::size_t>(run.camera)];
        const int width = reduced_[static_cast<std::size_t>(run.camera)].cols;
        for (int x = run.first; x < run.end; ++x) {
            const Source& at = sources_[static_cast<std::size_t>(run.y * camera_.cols + x)];
            used |= cv::Rect(at.offset % width, at.offset / width, 2, 2);
        }
    }
}

void SemiSurroundView::Compose(const UnitFrames& frames, cv::Mat1b& view) {
    for (int i = 0; i < cameras_; ++i) {
        const CameraFrame& frame = frames[static_cast<std::size_t>(i)];
        if (frame.present()) Reduce(frame, i);
    }
    for (int y = 0; y < view.rows; ++y)
        std::memset(view[y], 0, static_cast<std::size_t>(view.cols));
    for (const Run& run : runs_) {
        if (frames[static_cast<std::size_t>(run.camera)].present()) ComposeRun(run, view);
    }
    UpdateMask(frames);
}

void SemiSurroundView::ComposeRun(const Run& run, cv::Mat1b& view) const {
    const cv::Mat1b& reduced = reduced_[static_cast<std::size_t>(run.camera)];
    const std::uint8_t* from = reduced[0];
    const Source* source = sources_.data() + static_cast<std::ptrdiff_t>(run.y) * camera_.cols;
    std::uint8_t* out = view[run.y];
    if (run.copied) {
        std::copy_n(from + source[run.first].offset, run.end - run.first, out + run.first);
        return;
    }
    Block block;
    for (int first = run.first; first < run.end; first += kBlock) {
        const int count = std::min(kBlock, run.end - first);
        for (int i = 0; i < count; ++i) {
            const Source& at = source[first + i];
            const auto k = static_cast<std::size_t>(i);
            block.upper[k] = PairAt(from + at.offset);
            block.lower[k] = PairAt(from + at.offset + reduced.cols);
            block.right[k] = at.right;
            block.below[k] = at.below;
        }
        Blend(block, count, out + first);
    }
}

/// A limited range is left as it is: what is tracked and matched are differences, and these come
/// out one seventh smaller.
void SemiSurroundView::Reduce(const CameraFrame& frame, int camera) {
    const auto i = static_cast<std::size_t>(camera);
    reducer_.Reduce(frame.LumaSamples(), used_[i], reduced_[i]);
}

void SemiSurroundView::UpdateMask(const UnitFrames& frames) {
    unsigned missing = 0;
    for (int i = 0; i < cameras_; ++i) {
        if (!frames[static_cast<std::size_t>(i)].present()) missing |= 1U << i;
    }
    if (missing == masked_cameras_) return;
    masked_cameras_ = missing;
    for (int y = 0; y < mask_.rows; ++y) {
        for (int x = 0; x < mask_.cols; ++x) {
            const bool gone = camera_(y, x) != kNoCamera && ((missing >> camera_(y, x)) & 1U) != 0;
            mask_(y, x) = gone ? std::uint8_t{0} : calibrated_mask_(y, x);
        }
    }
}

}  // namespace hitchview::algo

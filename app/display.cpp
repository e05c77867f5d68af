#include "app/display.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "app/jpeg_picture.hpp"

namespace hitchview::app {
namespace {

using std::chrono::nanoseconds;

const cv::Size kUsualSize_px{2048, 360};
const cv::Scalar kBackground{96, 32, 0};  // dark blue: no camera gives it from edge to edge
const cv::Scalar kLettering{255, 255, 255};
constexpr char kNoImage[] = "NO IMAGE";

cv::Mat NoImage(cv::Size size_px) {
    constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
    constexpr double kShareOfSide = 0.5;
    const cv::Size unit_px = cv::getTextSize(kNoImage, kFont, 1, 1, nullptr);
    const double scale = kShareOfSide * std::min(double(size_px.width) / unit_px.width,
                                                 double(size_px.height) / unit_px.height);
    const int stroke_px = std::max(1, cvRound(2 * scale));
    const cv::Size text_px = cv::getTextSize(kNoImage, kFont, scale, stroke_px, nullptr);
    const cv::Point left_bottom_px{(size_px.width - text_px.width) / 2,
                                   (size_px.height + text_px.height) / 2};
    cv::Mat shown(size_px, CV_8UC3, kBackground);
    cv::putText(shown, kNoImage, left_bottom_px, kFont, scale, kLettering, stroke_px, cv::LINE_AA);
    return shown;
}

}  // namespace

Display::Display(nanoseconds stale_after) : stale_after_(stale_after) {}

bool Display::Update(const hal::PanoramaImage& image, hal::Instant now) {
    const bool repeated =
        maybe_arrived_at_ && image.sequence == sequence_ && image.captured_until == captured_until_;
    if (!DecodeJpeg(image.jpeg, {image.width_px, image.height_px}, picture_)) return false;
    sequence_ = image.sequence;
    captured_until_ = image.captured_until;
    if (!repeated) maybe_arrived_at_ = now;
    return true;
}

nanoseconds Display::Age(hal::Instant now) const {
    return maybe_arrived_at_ ? now - *maybe_arrived_at_ : nanoseconds::max();
}

cv::Mat Display::Shown(hal::Instant now) const {
    return Compose(picture_, Age(now), stale_after_);
}

bool Display::IsLive(hal::Instant now) const {
    return Age(now) <= stale_after_;
}

cv::Mat Display::Compose(const cv::Mat& picture, nanoseconds age, nanoseconds stale_after) {
    if (picture.empty()) return NoImage(kUsualSize_px);
    return age <= stale_after ? picture : NoImage(picture.size());
}

}  // namespace hitchview::app

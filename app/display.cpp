#include "app/display.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "app/jpeg_picture.hpp"

namespace hitchview::app {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
const cv::Size kUsualSize_px{2048, 360};
const cv::Scalar kBackground{96, 32, 0};  // dark blue: no camera gives it from edge to edge
const cv::Scalar kLettering{255, 255, 255};

/// A line of text as large as it may be.
struct Line {
    std::string text;
    double scale = 1;
    int stroke_px = 1;
    cv::Size size_px{};
};

Line Fitted(const std::string& text, double width_px, double height_px) {
    const cv::Size unit_px = cv::getTextSize(text, kFont, 1, 1, nullptr);
    Line line{.text = text};
    line.scale = std::min(width_px / unit_px.width, height_px / unit_px.height);
    line.stroke_px = std::max(1, cvRound(2 * line.scale));
    line.size_px = cv::getTextSize(text, kFont, line.scale, line.stroke_px, nullptr);
    return line;
}

void Write(cv::Mat& picture, const Line& line, cv::Point left_bottom_px) {
    cv::putText(picture, line.text, left_bottom_px, kFont, line.scale, kLettering, line.stroke_px,
                cv::LINE_AA);
}

void WriteCentred(cv::Mat& picture, const Line& line, double middle_share) {
    Write(picture, line,
          {(picture.cols - line.size_px.width) / 2,
           cvRound(middle_share * picture.rows) + line.size_px.height / 2});
}

cv::Mat NoImage(cv::Size size_px, const std::string& reason) {
    cv::Mat shown(size_px, CV_8UC3, kBackground);
    WriteCentred(shown, Fitted("NO IMAGE", 0.5 * size_px.width, 0.35 * size_px.height), 0.4);
    WriteCentred(shown, Fitted(reason, 0.6 * size_px.width, 0.1 * size_px.height), 0.75);
    return shown;
}

/// The picture with a line of text on a plain strip at its lower edge.
cv::Mat WithStrip(const cv::Mat& picture, const std::string& text) {
    cv::Mat shown = picture.clone();
    const int strip_px = std::max(8, picture.rows / 10);
    shown.rowRange(shown.rows - strip_px, shown.rows).setTo(kBackground);
    const Line line = Fitted(text, 0.95 * picture.cols, 0.6 * strip_px);
    Write(shown, line, {strip_px / 2, shown.rows - (strip_px - line.size_px.height) / 2});
    return shown;
}

/// As '1.2 s'.
std::string Seconds(hal::Instant duration) {
    const auto tenths = duration / std::chrono::milliseconds(100);
    return std::to_string(tenths / 10) + '.' + std::to_string(tenths % 10) + " s";
}

}  // namespace

bool Display::Update(const hal::PanoramaImage& image, hal::Instant now) {
    damaged_ = !DecodeJpeg(image.jpeg, {image.width_px, image.height_px}, picture_);
    if (damaged_) return false;
    cameras_missing_ = image.cameras_missing;
    age_.Note(image.captured_until, now);
    return true;
}

bool Display::IsLive(hal::Instant now) const {
    const auto age = age_.At(now);
    return age && *age <= max_age_;
}

std::string Display::Reason(hal::Instant now) const {
    if (IsLive(now)) return "";
    if (damaged_) return "what comes is damaged";
    if (const auto age = age_.At(now)) return "the newest picture is " + Seconds(*age) + " old";
    return camera_names_.empty() ? "no publisher" : "the publisher sends no pictures";
}

std::string Display::MissingCameras() const {
    std::string text;
    for (std::size_t i = 0; i < 32; ++i) {
        if ((cameras_missing_ >> i & 1U) == 0) continue;
        if (!text.empty()) text += ", ";
        text += i < camera_names_.size() ? camera_names_[i] : "camera " + std::to_string(i);
    }
    return text;
}

cv::Mat Display::Shown(hal::Instant now) const {
    const cv::Size size_px = picture_.empty() ? kUsualSize_px : picture_.size();
    if (!IsLive(now)) return NoImage(size_px, Reason(now));
    if (cameras_missing_ == 0) return picture_;
    return WithStrip(picture_, "no picture of " + MissingCameras());
}

}  // namespace hitchview::app

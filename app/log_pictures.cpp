#include "app/log_pictures.hpp"

#include "app/log_channels.hpp"
#include "app/log_picture.hpp"

namespace hitchview::app {

LogPictures::LogPictures(std::vector<std::filesystem::path> files, std::string camera)
    : recording_(std::move(files), stop_), camera_(std::move(camera)) {}

std::optional<cv::Mat> LogPictures::Next() {
    while (const auto event = recording_.Next()) {
        const drivers::LcmLogEvent& message = event.value();
        if (message.channel != camera_ && message.channel != CameraChannel(camera_)) continue;
        const auto image = drivers::ParseLoggedImage(message.data);
        if (!image) continue;
        cv::Mat picture = PictureOf(image.value());
        if (!picture.empty()) return picture;
    }
    return std::nullopt;
}

}  // namespace hitchview::app

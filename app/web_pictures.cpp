#include "app/web_pictures.hpp"

#include <algorithm>

#include "drivers/lcm_image_message.hpp"
#include "drivers/lcm_log_messages.hpp"
#include "lcmtypes/bot_core_image_t.h"

namespace hitchview::app {
namespace {

bool IsJpeg(std::span<const std::uint8_t> bytes) {
    return bytes.size() > 3 && bytes[0] == 0xFF && bytes[1] == 0xD8;
}

void AppendNumber(std::vector<std::uint8_t>& bytes, std::uint64_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<std::uint8_t>(value >> shift));
    }
}

void AppendPreview(std::vector<std::uint8_t>& bytes, const std::string& name,
                   const WebPicture& picture, hal::Instant now) {
    bytes.push_back(static_cast<std::uint8_t>(name.size()));
    bytes.insert(bytes.end(), name.begin(), name.end());
    const auto age =
        std::chrono::duration_cast<std::chrono::milliseconds>(now - picture.arrived_at);
    AppendNumber(bytes, static_cast<std::uint64_t>(age.count()));
    AppendNumber(bytes, picture.jpeg->size());
    bytes.insert(bytes.end(), picture.jpeg->begin(), picture.jpeg->end());
}

}  // namespace

WebBytes WebPictures::Hold(std::span<const std::uint8_t> jpeg) {
    std::erase_if(held_, [](const auto& held) { return held.expired(); });
    if (!IsJpeg(jpeg) || HeldBytes() + jpeg.size() > kMostHeldBytes) return nullptr;
    auto bytes = std::make_shared<const std::vector<std::uint8_t>>(jpeg.begin(), jpeg.end());
    held_.push_back(bytes);
    return bytes;
}

std::size_t WebPictures::HeldBytes() const {
    std::size_t sum = 0;
    for (const auto& held : held_) {
        if (const auto bytes = held.lock()) sum += bytes->size();
    }
    return sum;
}

bool WebPictures::TakePanorama(std::span<const std::uint8_t> message, hal::Instant now) {
    const auto image = drivers::ParseImageMessage(message);
    if (!image) return false;
    const hal::PanoramaImage& panorama = image.value();
    const bool repeated = panorama_.serial > 0 && panorama.sequence == panorama_.sequence &&
                          panorama.captured_until == panorama_.captured_until;
    if (repeated) return false;
    const WebBytes jpeg = Hold(panorama.jpeg);
    if (!jpeg) return false;
    panorama_ = {
        panorama_.serial + 1, now, panorama.sequence, panorama.captured_until, panorama.width_px,
        panorama.height_px,   jpeg};
    return true;
}

bool WebPictures::TakePreview(std::string_view name, std::span<const std::uint8_t> message,
                              hal::Instant now) {
    const auto image = drivers::ParseLoggedImage(message);
    if (!image || image.value().fourcc != BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG) return false;
    const bool known = previews_.contains(name);
    if (image.value().data.size() > kMostPreviewBytes || name.empty() || name.size() > 63 ||
        (!known && previews_.size() >= kMostPreviews))
        return false;
    const WebBytes jpeg = Hold(image.value().data);
    if (!jpeg) return false;
    previews_.insert_or_assign(std::string(name),
                               WebPicture{.serial = ++newest_preview_,
                                          .arrived_at = now,
                                          .sequence = image.value().sequence.value_or(0),
                                          .width_px = image.value().width_px,
                                          .height_px = image.value().height_px,
                                          .jpeg = jpeg});
    return true;
}

std::vector<std::uint8_t> WebPictures::PreviewsAfter(std::uint64_t after, hal::Instant now) const {
    std::vector<std::uint8_t> bytes;
    for (const auto& [name, picture] : previews_) {
        if (picture.serial <= after || now - picture.arrived_at > kWebPreviewStaleAfter) continue;
        AppendPreview(bytes, name, picture, now);
    }
    return bytes;
}

}  // namespace hitchview::app

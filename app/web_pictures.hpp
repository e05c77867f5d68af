#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/frame.hpp"

namespace hitchview::app {

using WebBytes = std::shared_ptr<const std::vector<std::uint8_t>>;

/// A compressed picture as it came. A client may still be reading it when newer ones have come.
struct WebPicture {
    std::uint64_t serial = 0;  ///< 0: none has come
    hal::Instant arrived_at{};
    std::uint32_t sequence = 0;
    hal::Instant captured_until{};
    int width_px = 0;
    int height_px = 0;
    WebBytes jpeg{};
};

/// Older pictures are shown to nobody: what stands still must never look live.
inline constexpr std::chrono::milliseconds kWebPictureStaleAfter{500};
inline constexpr std::chrono::milliseconds kWebPreviewStaleAfter{3000};

/// The newest panorama and the newest thumbnail of each camera, straight from the network.
class WebPictures {
 public:
    static constexpr std::size_t kMostPreviews = 32;
    static constexpr std::size_t kMostPreviewBytes = 256 << 10;
    /// All pictures that exist, among them those that slow clients still read: above, no new one
    /// is taken until some of those are done.
    static constexpr std::size_t kMostHeldBytes = 64 << 20;

    /// A bot_core.image_t with a panorama. False: it is not sound, came before, or finds no room.
    bool TakePanorama(std::span<const std::uint8_t> message, hal::Instant now);

    /// A bot_core.image_t with a JPEG picture of a camera. False as above.
    bool TakePreview(std::string_view name, std::span<const std::uint8_t> message,
                     hal::Instant now);

    [[nodiscard]] const WebPicture& panorama() const { return panorama_; }

    /// Serial of the newest thumbnail; 0 without one.
    [[nodiscard]] std::uint64_t newest_preview() const { return newest_preview_; }

    /// The thumbnails behind `after` that are not stale, each as: length of its name (1 byte),
    /// name, age in ms (4 bytes, highest first), length (4 bytes), JPEG.
    [[nodiscard]] std::vector<std::uint8_t> PreviewsAfter(std::uint64_t after,
                                                          hal::Instant now) const;

    /// Bytes of all pictures that somebody still holds.
    [[nodiscard]] std::size_t HeldBytes() const;

 private:
    /// Nothing without room.
    WebBytes Hold(std::span<const std::uint8_t> jpeg);

    WebPicture panorama_{};
    std::map<std::string, WebPicture, std::less<>> previews_{};
    std::uint64_t newest_preview_ = 0;
    std::vector<std::weak_ptr<const std::vector<std::uint8_t>>> held_{};
};

}  // namespace hitchview::app

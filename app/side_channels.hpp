#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "app/jpeg_encoder.hpp"
#include "app/overlay_maker.hpp"
#include "app/preview_thread.hpp"
#include "app/viewport.hpp"
#include "hal/publisher.hpp"

namespace hitchview::app {

/// Messages handed to the network. Any thread.
struct PublishCounts {
    std::atomic<std::uint64_t> published{0};
    std::atomic<std::uint64_t> refused{0};

    void Count(const hal::Result<hal::Done>& outcome) {
        (outcome ? published : refused).fetch_add(1, std::memory_order_relaxed);
    }
};

/// Where the pictures beside the panorama come from; null: none of the kind.
struct SideSources {
    std::vector<Viewport> viewports{};
    int highest_quality = 85;  ///< JPEG quality of the viewports
    OverlayMaker* overlay = nullptr;
    PreviewThread* previews = nullptr;
};

/// Sends what goes beside the panorama: viewports of it, overlays, previews of the cameras. Memory
/// is taken at construction. Thread: publisher.
class SideChannels {
 public:
    /// What is referred to must outlive it.
    SideChannels(hal::Publisher& publisher, const SideSources& sources, PublishCounts& counts);

    /// The viewports of a panorama, of which every so many-th is sent. `like`: the panorama as it
    /// was sent.
    void SendViewports(const hal::FrameView& panorama, const hal::PanoramaImage& like,
                       algo::TaskRunner& runner);
    /// What has come meanwhile.
    void SendPending();

 private:
    struct Window {
        Window(const Viewport& shown, int highest_quality);

        Viewport viewport;
        hal::FrameFormat format;
        std::vector<std::uint8_t> crop;
        JpegEncoder encoder;
    };
    void Send(Window& window, const hal::FrameView& panorama, const hal::PanoramaImage& like,
              algo::TaskRunner& runner);

    hal::Publisher& publisher_;
    PublishCounts& counts_;
    OverlayMaker* overlay_;
    PreviewThread* previews_;
    std::vector<std::unique_ptr<Window>> windows_;
    std::uint64_t panoramas_ = 0;
};

}  // namespace hitchview::app

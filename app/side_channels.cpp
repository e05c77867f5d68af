#include "app/side_channels.hpp"

namespace hitchview::app {

SideChannels::Window::Window(const Viewport& shown, int highest_quality)
    : viewport(shown),
      format{shown.width_px, shown.height_px, hal::PixelFormat::kI420, hal::Range::kFull},
      crop(hal::FrameBytes(format)),
      encoder(format, {.budget_bytes = shown.max_bytes, .highest_quality = highest_quality}) {}

SideChannels::SideChannels(hal::Publisher& publisher, const SideSources& sources,
                           PublishCounts& counts)
    : publisher_(publisher),
      counts_(counts),
      overlay_(sources.overlay),
      previews_(sources.previews) {
    for (const Viewport& viewport : sources.viewports)
        windows_.push_back(std::make_unique<Window>(viewport, sources.highest_quality));
}

void SideChannels::SendViewports(const hal::FrameView& panorama, const hal::PanoramaImage& like,
                                 algo::TaskRunner& runner) {
    for (const auto& window : windows_) {
        if (panoramas_ % static_cast<std::uint64_t>(window->viewport.every) == 0)
            Send(*window, panorama, like, runner);
    }
    ++panoramas_;
}

void SideChannels::Send(Window& window, const hal::FrameView& panorama,
                        const hal::PanoramaImage& like, algo::TaskRunner& runner) {
    CropViewport(panorama, window.viewport, window.crop);
    const auto jpeg = window.encoder.Encode(
        {window.format, {}, hal::PackedPlanes(window.format, window.crop.data())}, runner);
    if (!jpeg) {
        counts_.Count(jpeg.error());
        return;
    }
    hal::ViewportImage part{.channel = window.viewport.channel.c_str(), .image = like};
    part.image.width_px = window.format.width_px;
    part.image.height_px = window.format.height_px;
    part.image.jpeg = jpeg.value();
    counts_.Count(publisher_.Publish(part));
}

void SideChannels::SendPending() {
    if (overlay_ != nullptr) {
        if (const auto overlay = overlay_->Take()) counts_.Count(publisher_.Publish(*overlay));
    }
    if (previews_ == nullptr) return;
    const auto previews = previews_->Take();
    for (const hal::PreviewImage& preview : previews) counts_.Count(publisher_.Publish(preview));
    if (!previews.empty()) previews_->Done();
}

}  // namespace hitchview::app

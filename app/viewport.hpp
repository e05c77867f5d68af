#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "algo/projection.hpp"
#include "app/config.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// A named part of the panorama, whole chroma samples. On a ring it may reach across the right
/// edge.
struct Viewport {
    std::string channel;
    int x_px = 0;  ///< left edge, even
    int y_px = 0;  ///< top edge, even
    int width_px = 0;
    int height_px = 0;
    int every = 1;  ///< panorama that it is taken of
    int max_bytes = 0;
};

/// The viewports of a rig file on its canvas. Columns and rows are rounded to whole chroma samples.
/// Error: a viewport that reaches beyond the canvas or is smaller than 16 pixels.
hal::Checked<std::vector<Viewport>> MakeViewports(const PublishConfig& publish,
                                                  const algo::Projection& canvas);

/// Copies the viewport's pixels of an I420 panorama to `crop`, packed I420 of the viewport's size.
void CropViewport(const hal::FrameView& panorama, const Viewport& viewport,
                  std::span<std::uint8_t> crop);

}  // namespace hitchview::app

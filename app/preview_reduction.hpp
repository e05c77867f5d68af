#pragma once

#include <span>

#include "hal/frame.hpp"

namespace hitchview::app {

/// Size of a camera's preview.
inline constexpr int kPreviewWidth_px = 192;
inline constexpr int kPreviewHeight_px = 108;
inline constexpr hal::FrameFormat kPreviewFormat{kPreviewWidth_px, kPreviewHeight_px,
                                                 hal::PixelFormat::kI420, hal::Range::kFull};

/// Reduces a camera's frame of any format to a preview: each pixel is the mean of those it stands
/// for. `preview`: packed I420, full range, of kPreviewFormat.
void ReduceToPreview(const hal::FrameView& frame, std::span<std::uint8_t> preview);

}  // namespace hitchview::app

#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "app/run_loop.hpp"

namespace hitchview::tests {

/// One panorama of a run, kept.
struct KeptPanorama {
    std::uint32_t sequence = 0;
    int width_px = 0;
    std::vector<std::uint8_t> bytes;  ///< I420, packed
    algo::Composition composition;

    [[nodiscard]] int Luma(int x, int y) const {
        return bytes[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
                     static_cast<std::size_t>(x)];
    }
};

/// Panoramas of a rig; a failure of the test when it could not be loaded or cannot be run.
inline std::vector<KeptPanorama> RunAndKeep(const hal::Checked<app::RigConfig>& config,
                                            const app::RunOptions& options = {}) {
    std::vector<KeptPanorama> kept;
    EXPECT_TRUE(config) << config.error();
    if (!config) return kept;
    const std::atomic<bool> stop{false};
    const auto keep = [&](const app::ShownPanorama& shown, const app::Pipeline&) {
        const hal::FrameView& picture = shown.picture;
        const std::uint8_t* const bytes = picture.planes[0].data;
        kept.push_back({.sequence = picture.header.sequence,
                        .width_px = picture.format.width_px,
                        .bytes = {bytes, bytes + hal::FrameBytes(picture.format)},
                        .composition = *shown.composition});
    };
    const auto summary = app::RunRig(config.value(), options, stop, keep);
    EXPECT_TRUE(summary) << summary.error();
    return kept;
}

/// Of the rig in `rig_file`.
inline std::vector<KeptPanorama> RunAndKeep(const std::string& rig_file,
                                            const app::RunOptions& options = {}) {
    return RunAndKeep(app::LoadRigConfig(rig_file), options);
}

}  // namespace hitchview::tests

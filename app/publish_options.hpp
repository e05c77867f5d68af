#pragma once

#include "app/config.hpp"
#include "drivers/lcm_encoder.hpp"

namespace hitchview::app {

/// How the rig file wants its messages.
inline drivers::LcmEncoderOptions EncoderOptionsOf(const PublishConfig& config) {
    return {.panorama_channel = config.panorama_channel,
            .status_channel = config.status_channel,
            .hitch_angle_channel = config.hitch_angle_channel,
            .event_channel = config.event_channel,
            .health_channel = config.health_channel,
            .overlay_channel = config.overlay.channel,
            .max_image_bytes = config.max_bytes};
}

}  // namespace hitchview::app

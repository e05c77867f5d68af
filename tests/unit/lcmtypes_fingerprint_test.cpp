#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/bot_core_image_t.h"
#include "lcmtypes/hitchview_event_t.h"
#include "lcmtypes/hitchview_health_t.h"
#include "lcmtypes/hitchview_hitch_angle_t.h"
#include "lcmtypes/hitchview_overlay_t.h"
#include "lcmtypes/hitchview_panorama_status_t.h"

// The first eight bytes of every LCM message are a hash of its type. Receivers built from their
// own copy of a type drop a message whose hash differs, so these numbers are part of the contract.
// They are computed here from LCM's description of the hash, not by its generator.
namespace {

struct Member {
    std::string_view type;  ///< empty for a nested type: its own hash is added instead
    std::string_view name;
    std::string_view dimension;  ///< empty for a scalar
    bool fixed = false;          ///< the dimension is a number, not the name of a member
};

class TypeHash {
 public:
    explicit TypeHash(const std::vector<Member>& members) {
        for (const Member& member : members) {
            Add(member.name);
            if (!member.type.empty()) Add(member.type);
            Add(member.dimension.empty() ? 0 : 1);
            if (member.dimension.empty()) continue;
            Add(member.fixed ? 0 : 1);
            Add(member.dimension);
        }
    }

    /// Hash of the members alone.
    [[nodiscard]] std::uint64_t base() const { return static_cast<std::uint64_t>(value_); }
    /// What stands on the wire.
    [[nodiscard]] std::uint64_t Fingerprint(std::uint64_t nested = 0) const {
        return std::rotl(base() + nested, 1);
    }

 private:
    void Add(int byte) {
        const auto bits = static_cast<std::uint64_t>(value_);
        const auto high = static_cast<std::uint64_t>(value_ >> 55);  // the sign is carried along
        value_ = static_cast<std::int64_t>(((bits << 8) ^ high) + static_cast<std::uint64_t>(byte));
    }
    void Add(std::string_view text) {
        Add(static_cast<int>(text.size()));
        for (const char letter : text) Add(static_cast<int>(letter));
    }

    std::int64_t value_ = 0x12345678;
};

template <typename Message>
std::uint64_t WireFingerprint(int (*encode)(void*, int, int, const Message*),
                              const Message& message = {}) {
    std::array<std::uint8_t, 256> bytes{};
    EXPECT_GT(encode(bytes.data(), 0, static_cast<int>(bytes.size()), &message), 8);
    std::uint64_t fingerprint = 0;
    for (int i = 0; i < 8; ++i) fingerprint = fingerprint << 8 | bytes.at(i);
    return fingerprint;
}

TEST(FingerprintTest, TheImageIsTheOneOfLibbot) {
    const TypeHash metadata({{"string", "key", ""}, {"int32_t", "n", ""}, {"byte", "value", "n"}});
    const TypeHash image({{"int64_t", "utime", ""},
                          {"int32_t", "width", ""},
                          {"int32_t", "height", ""},
                          {"int32_t", "row_stride", ""},
                          {"int32_t", "pixelformat", ""},
                          {"int32_t", "size", ""},
                          {"byte", "data", "size"},
                          {"int32_t", "nmetadata", ""},
                          {"", "metadata", "nmetadata"}});

    // Also found in code that others generated from libbot's image_t.
    EXPECT_EQ(image.base(), 0x6fee6cb20472ff6aULL);
    EXPECT_EQ(image.Fingerprint(metadata.Fingerprint()), 0x14739ffe13d5f5f0ULL);
    EXPECT_EQ(WireFingerprint(bot_core_image_t_encode), 0x14739ffe13d5f5f0ULL);
}

TEST(FingerprintTest, ThePanoramaStatusHasNotChanged) {
    const TypeHash status({{"int32_t", "sequence", ""},
                           {"int64_t", "utime", ""},
                           {"int64_t", "capture_ns", ""},
                           {"int64_t", "publish_ns", ""},
                           {"int64_t", "spread_ns", ""},
                           {"int32_t", "cameras_missing", ""},
                           {"int8_t", "seam_state", "2", true},
                           {"int32_t", "seam_matches", "2", true},
                           {"int32_t", "unit_features", "2", true},
                           {"double", "total_ms", ""},
                           {"int64_t", "deadline_misses", ""},
                           {"int64_t", "dropped", ""},
                           {"double", "articulation_rad", ""},
                           {"double", "articulation_sigma_rad", ""}});

    EXPECT_EQ(WireFingerprint(hitchview_panorama_status_t_encode), status.Fingerprint());
}

TEST(FingerprintTest, TheHitchAngleHasNotChanged) {
    const TypeHash angle({{"int32_t", "sequence", ""},
                          {"int64_t", "utime", ""},
                          {"int64_t", "capture_ns", ""},
                          {"boolean", "valid", ""},
                          {"int8_t", "quality", ""},
                          {"double", "angle_rad", ""}});

    EXPECT_EQ(WireFingerprint(hitchview_hitch_angle_t_encode), angle.Fingerprint());
}

TEST(FingerprintTest, TheEventHasNotChanged) {
    const TypeHash event({{"int32_t", "sequence", ""},
                          {"int64_t", "utime", ""},
                          {"int64_t", "monotonic_ns", ""},
                          {"int16_t", "code", ""},
                          {"string", "subject", ""},
                          {"string", "text", ""}});
    std::string none;  // the generated code needs text to measure
    hitchview_event_t message{};
    message.subject = message.text = none.data();

    EXPECT_EQ(WireFingerprint(hitchview_event_t_encode, message), event.Fingerprint());
}

TEST(FingerprintTest, HealthHasNotChanged) {
    const TypeHash camera({{"string", "name", ""},
                           {"string", "unit", ""},
                           {"boolean", "shown", ""},
                           {"int8_t", "state", ""},
                           {"double", "frames_per_s", ""},
                           {"double", "age_ms", ""},
                           {"int64_t", "delivered", ""},
                           {"int64_t", "lost", ""},
                           {"int64_t", "corrupted", ""},
                           {"int64_t", "reopened", ""}});
    const TypeHash stage({{"string", "name", ""},
                          {"double", "last_ms", ""},
                          {"double", "p50_ms", ""},
                          {"double", "p99_ms", ""},
                          {"double", "max_ms", ""}});
    const TypeHash health({{"int32_t", "sequence", ""},
                           {"int64_t", "utime", ""},
                           {"int64_t", "monotonic_ns", ""},
                           {"string", "version", ""},
                           {"string", "calibration_id", ""},
                           {"double", "uptime_s", ""},
                           {"double", "panoramas_per_s", ""},
                           {"int64_t", "panoramas", ""},
                           {"int64_t", "dropped", ""},
                           {"int64_t", "deadline_misses", ""},
                           {"int64_t", "events_lost", ""},
                           {"int32_t", "image_bytes", ""},
                           {"int32_t", "image_budget_bytes", ""},
                           {"int32_t", "image_quality", ""},
                           {"int32_t", "receive_buffer_bytes", ""},
                           {"string", "warning", ""},
                           {"int64_t", "rss_bytes", ""},
                           {"int64_t", "minor_faults", ""},
                           {"int64_t", "major_faults", ""},
                           {"int64_t", "heap_calls", ""},
                           {"int8_t", "recording", ""},
                           {"int64_t", "recorded_bytes", ""},
                           {"int64_t", "recording_dropped", ""},
                           {"int64_t", "disk_free_bytes", ""},
                           {"int32_t", "ncameras", ""},
                           {"", "cameras", "ncameras"},
                           {"int32_t", "nstages", ""},
                           {"", "stages", "nstages"}});
    std::string none;
    hitchview_health_t message{};
    message.version = message.calibration_id = message.warning = none.data();

    EXPECT_EQ(WireFingerprint(hitchview_health_t_encode, message),
              health.Fingerprint(camera.Fingerprint() + stage.Fingerprint()));
}

TEST(FingerprintTest, TheOverlayHasNotChanged) {
    const TypeHash overlay({{"int32_t", "sequence", ""},
                            {"int64_t", "utime", ""},
                            {"int64_t", "capture_ns", ""},
                            {"int32_t", "width", ""},
                            {"int32_t", "height", ""},
                            {"int32_t", "mesh_rows", ""},
                            {"int32_t", "mesh_cols", ""},
                            {"int32_t", "nvertices", ""},
                            {"float", "mesh_x", "nvertices"},
                            {"float", "mesh_y", "nvertices"},
                            {"int32_t", "seam_rows", ""},
                            {"float", "seam_y", "seam_rows"},
                            {"float", "left_seam_x", "seam_rows"},
                            {"float", "right_seam_x", "seam_rows"}});

    EXPECT_EQ(WireFingerprint(hitchview_overlay_t_encode), overlay.Fingerprint());
}

}  // namespace

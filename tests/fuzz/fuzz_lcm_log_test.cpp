#include "tests/fuzz/fuzz_lcm_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>

#include "lcmtypes/hitchview_can_frame_t.h"
#include "lcmtypes/hitchview_rig_t.h"
#include "tests/support/image_message.hpp"
#include "tests/support/jpeg_picture.hpp"
#include "tests/support/random_log.hpp"
#include "tests/support/rig_messages.hpp"

namespace hitchview::tests {
namespace {

template <typename Message>
LogBytes Encoded(const Message& message, int (*size)(const Message*),
                 int (*encode)(void*, int, int, const Message*)) {
    LogBytes bytes(static_cast<std::size_t>(size(&message)));
    encode(bytes.data(), 0, static_cast<int>(bytes.size()), &message);
    return bytes;
}

LogBytes RigBytes() {
    std::string text = "schema: 1\n";
    std::string name = "front";
    std::string channel = "CAM_FRONT";
    std::array<char*, 2> names{name.data(), name.data()};
    std::array<char*, 2> channels{channel.data(), channel.data()};
    const hitchview_rig_t rig{.utime = 1,
                              .rig_yaml = text.data(),
                              .calibration_yaml = text.data(),
                              .calibration_id = name.data(),
                              .ncameras = 2,
                              .camera = names.data(),
                              .camera_channel = channels.data(),
                              .period_ms = 33.3};
    return Encoded(rig, hitchview_rig_t_encoded_size, hitchview_rig_t_encode);
}

LogBytes CanBytes() {
    std::string bus = "can0";
    std::array<std::uint8_t, 3> data{1, 2, 3};
    hitchview_can_frame_t frame{};
    frame.bus = bus.data();
    frame.size = 3;
    frame.ndata = 3;
    frame.data = data.data();
    return Encoded(frame, hitchview_can_frame_t_encoded_size, hitchview_can_frame_t_encode);
}

LogBytes JpegBytes() {
    ImageMessage message;
    message.width_px = 32;
    message.height_px = 16;
    message.data = JpegPicture(32, 16, TJSAMP_422, 1);
    return message.Encode();
}

RandomLog LogOfMessages() {
    RandomLog log(3, 5);
    log.Append(1'700'000'002'000'000, "RIG", RigBytes());
    log.Append(1'700'000'002'000'100, "CAM_FRONT", ImageMessage{}.Encode());
    log.Append(1'700'000'002'000'200, "CAN_RX", CanBytes());
    log.Append(1'700'000'002'000'300, "CAM_FRONT", JpegBytes());
    return log;
}

/// Changes, cuts out or repeats a few bytes.
void Mutate(LogBytes& bytes, std::mt19937& random) {
    const std::size_t at = random() % bytes.size();
    const std::size_t count = std::min<std::size_t>(1 + random() % 64, bytes.size() - at);
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto last = first + static_cast<std::ptrdiff_t>(count);
    const LogBytes piece(first, last);
    switch (random() % 4) {
        case 0:
            *first = static_cast<std::uint8_t>(random());
            break;
        case 1:
            std::fill(first, last, random() % 2 == 0 ? 0 : 0xFF);
            break;
        case 2:
            if (count < bytes.size()) bytes.erase(first, last);
            break;
        default:
            bytes.insert(first, piece.begin(), piece.end());
    }
}

TEST(FuzzLcmLogTest, NoMutationOfALogBreaksAPromiseOfTheReader) {
    const RandomLog log = LogOfMessages();
    std::mt19937 random(1);
    for (int i = 0; i < 3000; ++i) {
        LogBytes bytes = log.bytes;
        for (unsigned n = random() % 8; n <= 8; ++n) Mutate(bytes, random);
        ASSERT_EQ(LLVMFuzzerTestOneInput(bytes.data(), bytes.size()), 0);
    }
}

TEST(FuzzLcmLogTest, NoMutationOfAMessageReachesPastIt) {
    std::mt19937 random(2);
    for (const LogBytes& message :
         {RigBytes(), CanBytes(), ImageMessage{}.Encode(), JpegBytes(),
          HealthBytes(1, {.cameras = {"front", "left"}}), OverlayBytes(1, 64, 32, 0)}) {
        for (int i = 0; i < 2000; ++i) {
            LogBytes bytes = message;
            Mutate(bytes, random);
            ASSERT_EQ(LLVMFuzzerTestOneInput(bytes.data(), bytes.size()), 0);
        }
    }
}

}  // namespace
}  // namespace hitchview::tests

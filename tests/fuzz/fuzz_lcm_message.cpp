#include "tests/fuzz/fuzz_lcm_message.hpp"

#include "drivers/lcm_camera_names.hpp"
#include "drivers/lcm_image_message.hpp"
#include "hal/expect.hpp"

namespace {

using Bytes = std::span<const std::uint8_t>;

void ReadImage(Bytes message) {
    const auto image = hitchview::drivers::ParseImageMessage(message);
    if (!image) return;
    const auto& jpeg = image.value().jpeg;
    HV_EXPECT(!jpeg.empty() && jpeg.data() >= message.data());
    HV_EXPECT(jpeg.data() + jpeg.size() <= message.data() + message.size());
    HV_EXPECT(image.value().width_px >= 1 && image.value().width_px <= 16384);
    HV_EXPECT(image.value().height_px >= 1 && image.value().height_px <= 16384);
}

void ReadHealth(Bytes message) {
    const auto names = hitchview::drivers::ParseCameraNames(message);
    if (!names) return;
    HV_EXPECT(names.value().size() <= 8);
    for (const std::string& name : names.value()) HV_EXPECT(name.size() <= 63);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    ReadImage({data, size});
    ReadHealth({data, size});
    return 0;
}

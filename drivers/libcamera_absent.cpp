#include "drivers/libcamera_camera.hpp"

namespace hitchview::drivers {

hal::Checked<std::unique_ptr<hal::Camera>> OpenLibcamera(const LibcameraOptions& options) {
    return options.id + ": this program was built without libcamera";
}

}  // namespace hitchview::drivers

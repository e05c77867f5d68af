#include "drivers/replay_source.hpp"

// Linked into a program that reads neither videos nor pictures, in place of replay_video_source and
// replay_image_source, whose libraries it then does not load.
namespace hitchview::drivers {

hal::Checked<std::unique_ptr<ReplaySource>> OpenVideoSource(const std::string& path) {
    return path + ": this program reads no videos: use hitchview replay";
}

hal::Checked<std::unique_ptr<ReplaySource>> OpenImageSource(const std::string& path) {
    return path + ": this program reads no pictures: use hitchview replay";
}

}  // namespace hitchview::drivers

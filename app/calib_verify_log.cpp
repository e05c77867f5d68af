#include "app/calib_verify_log.hpp"

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>

#include "app/log_pictures.hpp"

namespace hitchview::app {
namespace {

constexpr int kMostPictures = 3;
/// Frames from one picture to the next: some seconds, so that the vehicle is elsewhere.
constexpr int kEvery = 100;

/// Empty, or what went wrong.
std::string TakeOf(const std::vector<std::filesystem::path>& files, const std::string& camera,
                   const std::filesystem::path& folder) {
    std::error_code refused;
    std::filesystem::create_directories(folder, refused);
    LogPictures pictures(files, camera);
    int taken = 0;
    for (int frame = 0; taken < kMostPictures; ++frame) {
        const auto picture = pictures.Next();
        if (!picture) break;
        if (frame % kEvery != 0) continue;
        const std::filesystem::path file = folder / (std::to_string(++taken) + ".png");
        if (!cv::imwrite(file.string(), *picture)) return file.string() + ": cannot be written";
    }
    if (!pictures.failure().empty()) return pictures.failure();
    return taken > 0 ? "" : "camera " + camera + ": the recording has no picture of it";
}

}  // namespace

hal::Checked<DrivePictures> DrivePictures::Take(const std::vector<std::filesystem::path>& logs,
                                                const std::vector<std::string>& cameras) {
    const auto files = LogFiles(logs);
    if (!files) return files.error();
    std::string pattern = std::filesystem::temp_directory_path() / "hitchview-verify-XXXXXX";
    if (mkdtemp(pattern.data()) == nullptr) return pattern + ": cannot be made";
    DrivePictures pictures{std::filesystem::path(pattern)};
    for (const std::string& camera : cameras) {
        const std::string why = TakeOf(files.value(), camera, pictures.folder_ / camera);
        if (!why.empty()) return why;
    }
    return pictures;
}

DrivePictures::DrivePictures(DrivePictures&& other) noexcept
    : folder_(std::exchange(other.folder_, {})) {}

DrivePictures::~DrivePictures() {
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

}  // namespace hitchview::app

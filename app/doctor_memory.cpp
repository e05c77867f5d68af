#include "app/doctor_memory.hpp"

#include <algorithm>
#include <sstream>

#include "app/doctor.hpp"

namespace hitchview::app {
namespace {

constexpr std::uint64_t kMegabyte = 1'000'000;
/// Code, libraries and stacks, all of it locked, estimation, and what compression takes whatever
/// the canvas: 147 MB were measured.
constexpr std::uint64_t kProgram = 160 * kMegabyte;
/// Panoramas that are drawn, sent or compressed, of 1.5 bytes a pixel, and the tables of the map.
constexpr std::uint64_t kBytesPerCanvasPixel = 24;
constexpr std::uint64_t kBytesPerCameraPixel = 2;
/// Of a camera: what the program holds, and what the device needs.
constexpr int kUsualBuffers = 12;
/// Of a camera whose frames are recorded, beyond these.
constexpr int kRecordedBuffers = 5;
constexpr std::uint64_t kPerCompressor = 8 * (std::uint64_t{1} << 20);

std::uint64_t Pixels(const Size& size) {
    return static_cast<std::uint64_t>(size.width_px) * static_cast<std::uint64_t>(size.height_px);
}

Size SizeOf(const RigConfig& rig, const CameraConfig& camera) {
    if (camera.source == CameraConfig::Source::kSimulated && rig.simulation.camera_size_px)
        return *rig.simulation.camera_size_px;
    return camera.live.size_px;
}

std::uint64_t MemoryOfCamera(const RigConfig& rig, const CameraConfig& camera) {
    int buffers = std::max(camera.live.buffers, kUsualBuffers);
    if (!rig.record.folder.empty()) buffers += kRecordedBuffers;
    if (camera.source == CameraConfig::Source::kSimulated)
        buffers += rig.simulation.loop_frames.value_or(0);
    return Pixels(SizeOf(rig, camera)) * kBytesPerCameraPixel * static_cast<std::uint64_t>(buffers);
}

std::uint64_t MemoryOfRecorder(const RecordConfig& record) {
    if (record.folder.empty()) return 0;
    return (static_cast<std::uint64_t>(record.memory_mb) << 20) +
           static_cast<std::uint64_t>(record.threads) * kPerCompressor + kMegabyte;
}

/// MemAvailable of /proc/meminfo.
std::optional<std::uint64_t> AvailableBytes(const DoctorMachine& machine) {
    std::istringstream lines(ReadText(machine.At("/proc/meminfo")).value_or(""));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string key;
        std::uint64_t kilobytes = 0;
        if (words >> key >> kilobytes && key == "MemAvailable:") return kilobytes << 10;
    }
    return std::nullopt;
}

Diagnosis CheckAvailable(const DoctorSubject& subject) {
    const auto available = AvailableBytes(subject.machine);
    if (!available) return {.what = "the kernel does not tell how much memory is available"};
    const std::string free = Megabytes(*available) + " are available";
    if (subject.MakesPanoramas()) return {Finding::kGood, "the service has its memory; " + free};
    const std::uint64_t needed = MemoryOfRun(subject.rig.config);
    const std::string what = free + ", a run of this rig takes up to " + Megabytes(needed);
    if (*available >= needed) return {Finding::kGood, what};
    return {Finding::kBad, what,
            "end what takes it (systemd-cgtop --order=memory), or lower record.memory_mb, buffers "
            "or size_px in the rig file"};
}

Diagnosis CheckLimit(const DoctorSubject& subject) {
    if (!subject.service.IsLoaded()) return {.what = "there is no service to limit it"};
    const auto limit = subject.service.memory_limit_bytes;
    if (!limit) return {Finding::kGood, "the service's memory is not limited"};
    const std::uint64_t needed = MemoryOfRun(subject.rig.config);
    const std::string what = "the service may have " + Megabytes(*limit) +
                             ", a run of this rig takes up to " + Megabytes(needed);
    if (*limit >= needed) return {Finding::kGood, what};
    return {Finding::kBad, what,
            "MemoryMax= in systemctl edit hitchview, or lower record.memory_mb, buffers or size_px "
            "in the rig file"};
}

}  // namespace

std::string Megabytes(std::uint64_t bytes) {
    return std::to_string((bytes + kMegabyte - 1) / kMegabyte) + " MB";
}

std::uint64_t MemoryOfRun(const RigConfig& rig) {
    std::uint64_t bytes =
        kProgram + kBytesPerCanvasPixel * Pixels(rig.canvas.size_px) + MemoryOfRecorder(rig.record);
    for (const algo::Unit unit : algo::kUnits) {
        for (const CameraConfig& camera : rig.units[unit].cameras)
            bytes += MemoryOfCamera(rig, camera);
    }
    return bytes;
}

std::vector<DoctorCheck> MemoryChecks(const DoctorCase& subject) {
    return {{"memory", [subject] { return CheckAvailable(*subject); }},
            {"memory_limit", [subject] { return CheckLimit(*subject); }}};
}

}  // namespace hitchview::app

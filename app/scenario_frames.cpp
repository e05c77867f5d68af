#include "app/scenario_frames.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace hitchview::app {
namespace {

using drivers::SimulatedRig;

/// Frames of the drive by which a cache is told from another one's.
constexpr int kProbeEvery = 10;

bool ReadBytes(const std::filesystem::path& file, std::span<std::uint8_t> bytes) {
    std::ifstream in(file, std::ios::binary);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return static_cast<bool>(in);
}

/// In one step: a run that is stopped leaves no half frame. A cache that cannot be written is none.
void WriteBytes(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
    const std::filesystem::path part = file.string() + ".part";
    std::ofstream out(part, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    out.close();
    std::error_code refused;
    if (out) std::filesystem::rename(part, file, refused);
}

/// FNV-1a.
std::uint64_t HashBytes(std::span<const std::uint8_t> bytes, std::uint64_t hash) {
    for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3ULL;
    return hash;
}

/// Where the set keeps the frame of a camera of the rig.
hal::FrameLease& LeaseOf(const SimulatedRig& rig, int camera, FrameSet& set) {
    const algo::Unit unit = rig.camera(camera).unit;
    int in_unit = 0;
    for (int i = 0; i < camera; ++i) in_unit += rig.camera(i).unit == unit ? 1 : 0;
    return set.leases[unit][static_cast<std::size_t>(in_unit)];
}

}  // namespace

ScenarioFrames::ScenarioFrames(const SimulatedRig& rig, int held_sets, std::filesystem::path cache,
                               algo::TaskRunner& runner)
    : rig_(rig), cache_(std::move(cache)), runner_(runner) {
    for (Camera& camera : cameras_)
        camera.pool = std::make_unique<hal::FramePool>(rig.format(), kBatch + held_sets);
    if (cache_.empty()) return;
    std::error_code refused;
    std::filesystem::create_directories(cache_, refused);
}

FrameSet& ScenarioFrames::At(int frame) {
    const bool in_batch = frame >= first_ && frame < first_ + static_cast<int>(batch_.size());
    if (!in_batch) FillBatch(frame);
    return batch_[static_cast<std::size_t>(frame - first_)];
}

const FrameSet& ScenarioFrames::Peek(int frame) {
    return At(frame);
}

FrameSet ScenarioFrames::Take(int frame) {
    return std::move(At(frame));
}

void ScenarioFrames::FillBatch(int first) {
    batch_.clear();
    first_ = first;
    const int count = std::min(kBatch, rig_.options().frames - first);
    for (int i = 0; i < count; ++i) {
        FrameSet set;
        set.sequence = static_cast<std::uint32_t>(first + i);
        set.captured_from = set.captured_until = FrameTime(rig_.options(), first + i);
        batch_.push_back(std::move(set));
    }
    runner_.Run(SimulatedRig::kCameras, [&](int camera) { FillCamera(camera); });
    for (FrameSet& set : batch_) {
        for (int camera = 0; camera < SimulatedRig::kCameras; ++camera) {
            if (!LeaseOf(rig_, camera, set)) set.cameras_missing |= 1U << camera;
        }
    }
}

void ScenarioFrames::FillCamera(int camera) {
    hal::FramePool& pool = *cameras_[static_cast<std::size_t>(camera)].pool;
    for (FrameSet& set : batch_) {
        const int frame = static_cast<int>(set.sequence);
        if (!rig_.CameraPresent(camera, frame)) continue;
        const auto slot = pool.Take();
        HV_EXPECT(slot.has_value());
        Fill(camera, frame, slot->bytes);
        LeaseOf(rig_, camera, set) = pool.Lease(*slot, {set.sequence, set.captured_from});
    }
}

void ScenarioFrames::Fill(int camera, int frame, std::span<std::uint8_t> bytes) {
    char name[32];
    std::snprintf(name, sizeof name, "%05d_%d.nv12", frame, camera);
    if (!cache_.empty() && ReadBytes(cache_ / name, bytes)) return;
    rig_.Render(camera, frame, cameras_[static_cast<std::size_t>(camera)].workspace, bytes);
    if (!cache_.empty()) WriteBytes(cache_ / name, bytes);
}

std::string CacheKey(const SimulatedRig& rig) {
    drivers::SimulationOptions tiny = rig.options();
    tiny.width_px = 64;
    tiny.height_px = 36;
    const auto probe = SimulatedRig::Create(tiny);
    HV_EXPECT(probe.ok());  // smaller than what was allowed already
    std::vector<std::uint8_t> bytes(hal::FrameBytes(probe.value()->format()));
    drivers::Renderer::Workspace workspace;
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (int frame = 0; frame < tiny.frames; frame += kProbeEvery) {
        for (int camera = 0; camera < SimulatedRig::kCameras; ++camera) {
            probe.value()->Render(camera, frame, workspace, bytes);
            hash = HashBytes(bytes, hash);
        }
    }
    char name[48];
    std::snprintf(name, sizeof name, "%dx%d-%016llx", rig.format().width_px, rig.format().height_px,
                  static_cast<unsigned long long>(hash));
    return name;
}

}  // namespace hitchview::app

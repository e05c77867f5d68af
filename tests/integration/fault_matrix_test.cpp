#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "algo/unified_vertex_motion.hpp"
#include "app/camera_watch.hpp"
#include "app/faulty_camera.hpp"
#include "app/pipeline.hpp"
#include "app/recorded_frame_synchronizer.hpp"
#include "app/simulated_geometry.hpp"
#include "app/worker_pool.hpp"
#include "drivers/looped_camera.hpp"
#include "drivers/simulated_rig.hpp"
#include "drivers/steady_clock.hpp"
#include "tests/support/fault_states.hpp"

/// Every fault on every camera, and every two of them on pairs of cameras, through the whole
/// pipeline: named, told, not shown where it must not be, of no consequence elsewhere, and over
/// within a second.
namespace hitchview::app {
namespace {

using drivers::SimulatedRig;
using hal::CameraState;
using hal::Instant;

constexpr int kLoopFrames = 90;
constexpr int kLoopTurns = kLoopFrames - 1;  // and goes back
constexpr int kSecond = 30;
constexpr int kGap = 10;  // frames from one case to the next
constexpr Instant kPeriod{33'333'333};
constexpr int kCanvasWidth_px = 1024;
constexpr int kCameras = SimulatedRig::kCameras;
// Positions in the simulated rig.
constexpr int kFront = 0, kLeftFront = 1, kLeft = 3, kRear = 5;

/// Who is befallen by what.
struct Case {
    struct One {
        int camera;
        FaultKind kind;
    };
    std::vector<One> faults;
};

/// How long a fault lasts until it must have been named: see CameraJudge.
int FramesOf(FaultKind kind) {
    switch (kind) {
        case FaultKind::kDirty:
            return 5 * kSecond;
        case FaultKind::kBlurred:
            return 2 * kSecond;
        default:
            return kSecond;
    }
}

int FramesOf(const Case& one) {
    int frames = 0;
    for (const auto& fault : one.faults) frames = std::max(frames, FramesOf(fault.kind));
    return frames;
}

/// The drive that all of them see.
const SimulatedRig& Drive() {
    static const std::unique_ptr<SimulatedRig> rig = [] {
        drivers::SimulationOptions options;
        options.frames = kLoopFrames;
        options.width_px = 320;
        options.height_px = 180;
        options.profile = drivers::DriveProfile::kStraight;
        options.render_threads = 1;
        return std::move(*SimulatedRig::Create(options));
    }();
    return *rig;
}

const drivers::LoopedFrames& Film() {
    static const drivers::LoopedFrames film = [] {
        constexpr std::array<int, kCameras> kAll{0, 1, 2, 3, 4, 5, 6, 7};
        std::array<drivers::Renderer::Workspace, kCameras> workspaces;
        return drivers::LoopedFrames(
            Drive().format(), kAll, kLoopFrames,
            [&](int camera, int frame, std::span<std::uint8_t> out) {
                Drive().Render(camera, frame, workspaces[static_cast<std::size_t>(camera)], out);
                return true;
            });
    }();
    return film;
}

const RigGeometry& Geometry() {
    static const RigGeometry geometry = *GeometryOf(Drive(), kCanvasWidth_px, kCameras);
    return geometry;
}

/// The whole of a run, one case after another: cameras with their faults, sets, watch, pipeline.
class FaultyRun {
 public:
    /// Of each case, the frame at which it begins, after the second in which all must be well again
    /// after the one before.
    explicit FaultyRun(const std::vector<Case>& cases, int least_frames = 0) {
        std::array<std::vector<CameraFault>, kCameras> faults;
        int at = kStart;
        for (const Case& one : cases) {
            starts_.push_back(at);
            for (const auto& [camera, kind] : one.faults)
                faults[static_cast<std::size_t>(camera)].push_back({kind, at, at + FramesOf(one)});
            at += FramesOf(one) + kSecond + kGap;
        }
        std::vector<WatchedPicture> pictures;
        for (int i = 0; i < kCameras; ++i) {
            const auto& [name, unit, geometry] = Drive().camera(i);
            auto looped = std::make_unique<drivers::LoopedCamera>(
                Film(), drivers::LoopedCameraOptions{.camera = i,
                                                     .period = kPeriod,
                                                     .frames = static_cast<std::uint32_t>(
                                                         std::max(at, least_frames) + 1)});
            pictures.push_back({std::string(name), unit, cameras_[unit].size()});
            cameras_[unit].push_back(std::make_unique<FaultyCamera>(
                std::move(looped), std::move(faults[static_cast<std::size_t>(i)]),
                FaultyCamera::Pace{nullptr, kPeriod}, 4));
        }
        sets_.emplace(cameras_);
        watch_.emplace(std::move(pictures), kPeriod, events_, clock_);
        pipeline_.SetWatch(&*watch_);
    }
    ~FaultyRun() { pipeline_.Start(); }
    FaultyRun(const FaultyRun&) = delete;
    FaultyRun& operator=(const FaultyRun&) = delete;

    const ShownPanorama& Next() {
        auto set = sets_->WaitSet();
        if (!set) throw std::runtime_error("the film is over");
        const ShownPanorama* const shown = pipeline_.Process(std::move(*set));
        slowest_ms_ = std::max(
            slowest_ms_, pipeline_.times()[static_cast<std::size_t>(Stage::kTotal)].last_ms());
        ++frame_;
        return *shown;
    }
    void SkipTo(int frame) {
        while (frame_ < frame) Next();
    }
    [[nodiscard]] int StartOf(std::size_t one) const { return starts_[one]; }
    [[nodiscard]] int frame() const { return frame_; }
    [[nodiscard]] const Pipeline& pipeline() const { return pipeline_; }
    std::optional<hal::Event> TakeEvent() { return events_.Take(); }

    /// Until then the estimation settles.
    static constexpr int kStart = 40;

 private:
    drivers::SteadyClock clock_;
    EventQueue events_;
    Cameras cameras_;
    WorkerPool workers_{2};
    algo::UnifiedVertexMotion motion_{Geometry().canvas, Geometry().units, {}};
    Pipeline pipeline_{Geometry(), motion_, workers_};
    std::optional<RecordedFrameSynchronizer> sets_;
    std::optional<CameraWatch> watch_;
    std::vector<int> starts_;
    int frame_ = 0;
    double slowest_ms_ = 0;
};

/// The luma of all panoramas of a run without faults, and where the map shows each camera in it.
class SoundRun {
 public:
    static const SoundRun& Get() {
        static const SoundRun run;
        return run;
    }

    [[nodiscard]] const std::vector<std::uint8_t>& Luma(int frame) const {
        return luma_[static_cast<std::size_t>(frame)];
    }
    /// These, and the columns that both units see: a seam may pass a thing on its other side for a
    /// frame or two where it would have done so a little later.
    [[nodiscard]] std::vector<bool> WithOverlaps(std::vector<bool> columns) const {
        for (std::size_t x = 0; x < columns.size(); ++x)
            columns[x] = columns[x] || (of_unit_[0][x] && of_unit_[1][x]);
        return columns;
    }
    /// Canvas columns in which one of these cameras, and nobody else, is seen in most rows.
    [[nodiscard]] std::vector<bool> ColumnsOf(const Case& one) const {
        std::vector<bool> columns(kCanvasWidth_px);
        for (const auto& fault : one.faults)
            for (int x = 0; x < kCanvasWidth_px; ++x)
                columns[static_cast<std::size_t>(x)] =
                    columns[static_cast<std::size_t>(x)] ||
                    seen_[static_cast<std::size_t>(fault.camera)][static_cast<std::size_t>(x)];
        return columns;
    }

 private:
    SoundRun() {
        FaultyRun run({}, FaultyRun::kStart + kLongest);
        while (run.frame() < FaultyRun::kStart + kLongest) {
            const ShownPanorama& shown = run.Next();
            const hal::Plane& luma = shown.picture.planes[0];
            luma_.emplace_back(luma.data, luma.data + static_cast<std::ptrdiff_t>(luma.stride_bytes) *
                                                          shown.picture.format.height_px);
            NoteSeen(run.pipeline().map());
        }
    }
    void NoteSeen(const algo::ComposedMap& map) {
        for (int source = 0; source < map.cameras(); ++source) {
            const int camera = (map.unit_of(source) == algo::Unit::kTractor ? 0 : 3) +
                               map.camera_of(source);
            for (int row = 0; row <= map.block_rows(); ++row)
                for (int col = 0; col <= map.block_cols(); ++col)
                    NoteCorner(map.corner(source, row, col), camera, col * map.block_px(),
                               map.block_px());
        }
    }
    /// With a block on each side.
    void NoteCorner(const algo::ComposedMap::Corner& corner, int camera, int x, int block_px) {
        for (int at = x - 2 * block_px; at <= x + 2 * block_px; ++at) {
            const auto column = static_cast<std::size_t>((at + kCanvasWidth_px) % kCanvasWidth_px);
            if (corner.weight > 0) seen_[static_cast<std::size_t>(camera)][column] = true;
            if (corner.sees) of_unit_[camera < 3 ? 0 : 1][column] = true;
        }
    }

    static constexpr int kLongest = 5 * kSecond;

    std::vector<std::vector<std::uint8_t>> luma_;
    std::array<std::array<bool, kCanvasWidth_px>, kCameras> seen_{};
    std::array<std::array<bool, kCanvasWidth_px>, 2> of_unit_{};
};

std::string NameOf(const Case& one) {
    std::string name;
    for (const auto& [camera, kind] : one.faults)
        name += std::string(Drive().camera(camera).name) + ' ' + ToString(kind) + ' ';
    return name;
}

constexpr int kTile_px = 32;

/// Mean difference of grey levels to the sound run, in the tile of those that the case does not
/// concern where it is largest.
double DifferenceElsewhere(const ShownPanorama& shown, const std::vector<bool>& concerned,
                           int frame) {
    const std::vector<std::uint8_t>& sound = SoundRun::Get().Luma(frame);
    const hal::Plane& luma = shown.picture.planes[0];
    const int rows = shown.picture.format.height_px;
    double largest = 0;
    for (int tile_x = 0; tile_x < kCanvasWidth_px; tile_x += kTile_px) {
        const auto columns = concerned.begin() + tile_x;
        if (std::find(columns, columns + kTile_px, true) != columns + kTile_px) continue;
        int sum = 0;
        for (int y = 0; y < rows; ++y) {
            for (int x = tile_x; x < tile_x + kTile_px; ++x) {
                const int at = y * luma.stride_bytes + x;
                sum += std::abs(luma.data[at] - sound[static_cast<std::size_t>(at)]);
            }
        }
        largest = std::max(largest, static_cast<double>(sum) / (kTile_px * rows));
    }
    return largest;
}

std::uint32_t MissingIn(const Case& one) {
    std::uint32_t missing = 0;
    for (const auto& [camera, kind] : one.faults)
        if (!hal::IsShown(tests::StateOf(kind))) missing |= 1U << camera;
    return missing;
}

/// What was told while a case lasted: pairs of a camera's name and a code.
std::vector<std::pair<std::string, std::string>> Told(FaultyRun& run) {
    std::vector<std::pair<std::string, std::string>> told;
    while (const auto event = run.TakeEvent())
        told.emplace_back(std::string(event->subject.view()), ToString(event->code));
    std::ranges::sort(told);
    return told;
}

std::vector<std::pair<std::string, std::string>> Expected(const Case& one, bool over) {
    std::vector<std::pair<std::string, std::string>> told;
    for (const auto& [camera, kind] : one.faults) {
        const char* const state = over ? "back" : ToString(tests::StateOf(kind));
        told.emplace_back(std::string(Drive().camera(camera).name), std::string("camera_") + state);
    }
    std::ranges::sort(told);
    return told;
}

struct Figures {
    double difference = 0;                ///< the largest outside the overlaps
    std::vector<double> in_overlaps{};    ///< of each panorama, everywhere
    double slowest_ms = 0;
};

void Follow(FaultyRun& run, const Case& one, std::size_t index, bool with_pictures,
            Figures& figures) {
    SCOPED_TRACE(NameOf(one));
    const std::vector<bool> concerned = SoundRun::Get().ColumnsOf(one);
    const std::vector<bool> apart_from_overlaps = SoundRun::Get().WithOverlaps(concerned);
    run.SkipTo(run.StartOf(index));
    EXPECT_TRUE(Told(run).empty()) << "before";
    const int end = run.StartOf(index) + FramesOf(one);
    while (run.frame() < end) {
        const int frame = run.frame();
        const ShownPanorama& shown = run.Next();
        if (with_pictures && frame < kLoopTurns) {
            figures.difference = std::max(
                figures.difference, DifferenceElsewhere(shown, apart_from_overlaps, frame));
            figures.in_overlaps.push_back(DifferenceElsewhere(shown, concerned, frame));
        }
        figures.slowest_ms = std::max(
            figures.slowest_ms,
            run.pipeline().times()[static_cast<std::size_t>(Stage::kTotal)].last_ms());
        if (frame == end - 1) {
            EXPECT_EQ(shown.cameras_missing, MissingIn(one));
            for (const auto& [camera, kind] : one.faults)
                EXPECT_EQ(shown.camera_states[static_cast<std::size_t>(camera)],
                          tests::StateOf(kind));
        }
    }
    EXPECT_EQ(Told(run), Expected(one, false));
    run.SkipTo(end + kSecond - 1);
    const ShownPanorama& recovered = run.Next();
    EXPECT_EQ(recovered.cameras_missing, 0U);
    for (const CameraState state : recovered.camera_states) EXPECT_EQ(state, CameraState::kGood);
    EXPECT_EQ(Told(run), Expected(one, true));
}

/// Of the 95th of 100 panoramas.
double InOverlaps(Figures& figures) {
    if (figures.in_overlaps.empty()) return 0;
    std::ranges::sort(figures.in_overlaps);
    return figures.in_overlaps[figures.in_overlaps.size() * 95 / 100];
}

std::vector<Case> SinglesOf(int camera) {
    std::vector<Case> cases;
    for (const FaultKind kind : kFaultKinds) cases.push_back({{{camera, kind}}});
    return cases;
}

/// Every two kinds, alike ones among them; `half`: every second of these.
std::vector<Case> PairsOf(int first, int second, std::size_t half) {
    std::vector<Case> cases;
    std::size_t count = 0;
    for (std::size_t i = 0; i < kFaultKinds.size(); ++i)
        for (std::size_t j = i; j < kFaultKinds.size(); ++j)
            if (count++ % 2 == half)
                cases.push_back({{{first, kFaultKinds[i]}, {second, kFaultKinds[j]}}});
    return cases;
}

class OneFaultTest : public testing::TestWithParam<int> {};

/// Each in a run of its own, so that its past is that of the sound run.
TEST_P(OneFaultTest, OfEveryKind) {
    Figures figures;
    const std::vector<Case> cases = SinglesOf(GetParam());
    for (const Case& one : cases) {
        FaultyRun run({one});
        Follow(run, one, 0, true, figures);
    }
    std::printf("%zu cases; elsewhere at most %.2f grey levels, in overlaps 95 of 100 below %.2f; "
                "slowest set %.1f ms\n",
                cases.size(), figures.difference, InOverlaps(figures), figures.slowest_ms);
    EXPECT_LT(figures.difference, 4);
    EXPECT_LT(InOverlaps(figures), 15);
}
INSTANTIATE_TEST_SUITE_P(FaultMatrix, OneFaultTest, testing::Range(0, kCameras));

class TwoFaultsTest : public testing::TestWithParam<std::size_t> {
 protected:
    /// One after another in one run.
    static void FollowAll(const std::vector<Case>& cases) {
        FaultyRun run(cases);
        Figures figures;
        for (std::size_t i = 0; i < cases.size(); ++i) Follow(run, cases[i], i, false, figures);
        std::printf("%zu cases; slowest set %.1f ms\n", cases.size(), figures.slowest_ms);
    }
};

TEST_P(TwoFaultsTest, OnNeighbours) {
    FollowAll(PairsOf(kFront, kLeftFront, GetParam()));
}

TEST_P(TwoFaultsTest, FarApartOnOneUnit) {
    FollowAll(PairsOf(kLeft, kRear, GetParam()));
}

TEST_P(TwoFaultsTest, AcrossASeam) {
    FollowAll(PairsOf(kLeftFront, kLeft, GetParam()));
}
INSTANTIATE_TEST_SUITE_P(FaultMatrix, TwoFaultsTest, testing::Values(0, 1));

}  // namespace
}  // namespace hitchview::app

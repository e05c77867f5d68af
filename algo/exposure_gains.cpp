#include "algo/exposure_gains.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hitchview::algo {
namespace {

constexpr int kStride = 4;       // corners of the map
constexpr int kPhases = 4;       // corners that are looked at in turn lie half of that apart
constexpr int kPatch = 8;        // px of the camera, averaged over
constexpr int kPatchStep = 2;    // every second one, across and down
constexpr double kDark = 12;     // grey levels where noise rules
constexpr double kBright = 243;  // and where the sensor is full
constexpr double kPrior = 0.02;  // weight of "gain 1" against all shared corners together

int SourceIndex(Unit unit, int camera) {
    return static_cast<int>(unit) * static_cast<int>(kMaxCameras) + camera;
}

/// Mean grey around (x, y); negative when it does not lie inside. What a lens says of directions
/// far beyond its picture may be no number of pixels at all.
double MeanAround(const CameraFrame& frame, float x, float y) {
    constexpr float kHalf = kPatch / 2;
    const auto lies_inside = [](float at, int size_px) {
        return at >= kHalf && at < static_cast<float>(size_px) - kHalf + 1;
    };
    if (!lies_inside(x, frame.width_px) || !lies_inside(y, frame.height_px)) return -1;
    const int x0 = static_cast<int>(x) - kPatch / 2;
    const int y0 = static_cast<int>(y) - kPatch / 2;
    const SamplePlane luma = frame.LumaSamples();
    int sum = 0;
    for (int r = 0; r < kPatch; r += kPatchStep) {
        const std::uint8_t* row = luma.row(y0 + r) + x0 * luma.step_bytes;
        for (int c = 0; c < kPatch; c += kPatchStep) sum += row[c * luma.step_bytes];
    }
    constexpr int kRead = (kPatch / kPatchStep) * (kPatch / kPatchStep);
    return FullLuma(frame.range, static_cast<float>(sum) / kRead);
}

struct SeenGrey {
    int source;
    double log_grey;
};
using SeenGreys = FixedVector<SeenGrey, 2 * kMaxCameras>;

bool SharesCorner(const ComposedMap& map, int row, int col) {
    int seeing = 0;
    for (int s = 0; s < map.cameras(); ++s) seeing += map.corner(s, row, col).sees ? 1 : 0;
    return seeing > 1;
}

/// What the cameras show at a corner; nothing where only one sees it.
SeenGreys SeenAt(const ComposedMap& map, const RigFrames& frames, int row, int col) {
    SeenGreys seen;
    if (!SharesCorner(map, row, col)) return seen;
    for (int s = 0; s < map.cameras(); ++s) {
        const ComposedMap::Corner& corner = map.corner(s, row, col);
        const CameraFrame& frame =
            frames[map.unit_of(s)][static_cast<std::size_t>(map.camera_of(s))];
        if (!corner.sees || !frame.present()) continue;
        const double grey = MeanAround(frame, corner.x, corner.y);
        if (grey < kDark || grey > kBright) continue;
        seen.push_back({SourceIndex(map.unit_of(s), map.camera_of(s)), std::log(grey)});
    }
    return seen;
}

}  // namespace

void ExposureGains::Collect(const ComposedMap& map, const RigFrames& frames, Table& sum,
                            Table& count) const {
    for (int row = first_row_; row <= map.block_rows(); row += kStride) {
        for (int col = first_col_; col <= map.block_cols(); col += kStride) {
            const SeenGreys seen = SeenAt(map, frames, row, col);
            for (const SeenGrey& i : seen) {
                for (const SeenGrey& j : seen) {
                    if (i.source == j.source) continue;
                    sum(i.source, j.source) += i.log_grey;
                    count(i.source, j.source) += 1;
                }
            }
        }
    }
}

void ExposureGains::Update(const ComposedMap& map, const RigFrames& frames) {
    Table sum = Table::Zero();
    Table count = Table::Zero();
    for (int looks = known_ ? 1 : kPhases; looks > 0; --looks) {
        Collect(map, frames, sum, count);
        MoveOn();
    }
    const double total = count.sum();
    if (total < 16) return;
    Table normal = kPrior * Table::Identity();
    Eigen::Matrix<double, kSources, 1> right = Eigen::Matrix<double, kSources, 1>::Zero();
    for (int i = 0; i < kSources; ++i) {
        for (int j = 0; j < kSources; ++j) {
            if (i == j || count(i, j) == 0) continue;
            const double n = count(i, j) / total;
            const double difference = (sum(j, i) - sum(i, j)) / count(i, j);
            normal(i, i) += n;
            normal(i, j) -= n;
            right(i) += n * difference;
        }
    }
    const Eigen::Matrix<double, kSources, 1> wanted = normal.ldlt().solve(right);
    log_gain_ += (known_ ? follow_ : 1.0) * (wanted - log_gain_);
    known_ = true;
}

/// To the corners where the next pictures are looked at.
void ExposureGains::MoveOn() {
    first_col_ = kStride / 2 - first_col_;
    if (first_col_ == 0) first_row_ = kStride / 2 - first_row_;
}

void ExposureGains::Reset() {
    *this = ExposureGains(follow_);
}

CameraGains ExposureGains::gains() const {
    CameraGains gains;
    for (const Unit unit : kUnits) {
        for (std::size_t i = 0; i < kMaxCameras; ++i) {
            const double g = log_gain_(SourceIndex(unit, static_cast<int>(i)));
            gains[unit][i] = static_cast<float>(std::exp(std::clamp(g, -1.0, 1.0)));
        }
    }
    return gains;
}

}  // namespace hitchview::algo

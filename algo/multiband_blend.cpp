#include "algo/multiband_blend.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace hitchview::algo {
namespace {

/// Below this the rest of the picture is another camera's.
constexpr float kWhole = 0.999F;
/// Samples to a side of the square whose mean is level 0, and canvas px from one to the next.
constexpr int kSamples = 4;
constexpr int kSampleStep = 3;

bool Inside(const CameraFrame& frame, const ComposedMap::Corner& corner) {
    return corner.sees && frame.present() && corner.x >= 0 && corner.y >= 0 &&
           corner.x <= static_cast<float>(frame.width_px - 1) &&
           corner.y <= static_cast<float>(frame.height_px - 1);
}

/// Camera px from one sample to the next, from how far the camera moves over one block.
int StepAt(const ComposedMap& map, int source, int row, int col) {
    const ComposedMap::Corner& here = map.corner(source, row, col);
    const ComposedMap::Corner& beside =
        map.corner(source, row, col < map.block_cols() ? col + 1 : col - 1);
    if (!beside.sees) return 1;
    const float across = beside.x - here.x;
    const float down = beside.y - here.y;
    const float moved_px = std::sqrt(across * across + down * down);
    const float step = moved_px * kSampleStep / static_cast<float>(map.block_px());
    return std::clamp(static_cast<int>(step + 0.5F), 1, 2 * map.block_px());
}

/// Sum of kN x kN values `step` apart, from the one at (x, y) on.
template <int kN>
int SumFrom(const SamplePlane& plane, int x, int y, int step) {
    const std::uint8_t* row = plane.row(y) + x * plane.step_bytes;
    const int across = step * plane.step_bytes;
    const std::ptrdiff_t down = static_cast<std::ptrdiff_t>(step) * plane.stride_bytes;
    int sum = 0;
    for (int r = 0; r < kN; ++r, row += down) {
        for (int c = 0; c < kN; ++c) sum += row[c * across];
    }
    return sum;
}

/// Mean of kN x kN values round (x, y), of the nearest ones where the square reaches outside.
template <int kN>
float MeanOf(const SamplePlane& plane, const Eigen::Vector2f& centre, int step) {
    const int reach = (kN - 1) * step;
    const float half = 0.5F * static_cast<float>(reach);
    const int left = static_cast<int>(centre.x() - half + 0.5F);
    const int top = static_cast<int>(centre.y() - half + 0.5F);
    if (left >= 0 && top >= 0 && left + reach < plane.cols && top + reach < plane.rows)
        return static_cast<float>(SumFrom<kN>(plane, left, top, step)) / (kN * kN);
    std::array<int, kN> bytes;
    for (int c = 0; c < kN; ++c) {
        const int x = left + c * step;
        bytes[static_cast<std::size_t>(c)] = plane.step_bytes * std::clamp(x, 0, plane.cols - 1);
    }
    int sum = 0;
    for (int r = 0; r < kN; ++r) {
        const int y = top + r * step;
        const std::uint8_t* row = plane.row(std::clamp(y, 0, plane.rows - 1));
        for (const int byte : bytes) sum += row[byte];
    }
    return static_cast<float>(sum) / (kN * kN);
}

/// Mean of one colour channel as it is shown; grey where the camera has no colour.
float MeanChroma(const CameraFrame& frame, int channel, float gain,
                 const ComposedMap::Corner& corner, int step) {
    if (!frame.has_chroma()) return 128;
    const Eigen::Vector2f centre(CameraFrame::ChromaX(corner.x), frame.ChromaY(corner.y));
    const float mean = MeanOf<kSamples / 2>(frame.ChromaSamples(channel), centre, step);
    return 128 + gain * FullChroma(frame.range, mean - 128);
}

MultibandBlend::Colour MeanColour(const CameraFrame& frame, float gain,
                                  const ComposedMap::Corner& corner, int step) {
    const float y = MeanOf<kSamples>(frame.LumaSamples(), {corner.x, corner.y}, step);
    return {std::clamp(gain * FullLuma(frame.range, y), 0.0F, 255.0F),
            MeanChroma(frame, 0, gain, corner, step), MeanChroma(frame, 1, gain, corner, step), 0};
}

}  // namespace

MultibandBlend::MultibandBlend(const ComposedMap& map)
    : ring_(map.is_ring()),
      sources_(std::min(map.cameras(), kSources)),
      rows_(map.block_rows() + 1),
      cols_(map.block_cols() + (ring_ ? 0 : 1)) {
    const auto corners = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_);
    most_.assign(corners, -1);
    joint_.assign(corners, Joint::kFar);
    shown_.assign(corners, 0);
    for (std::vector<Masks>& mask : mask_) mask.assign(corners, Masks::Zero());
    const Layer empty(corners, Colour::Zero());
    finest_.assign(static_cast<std::size_t>(sources_), empty);
    level_ = next_level_ = finest_;
    coarse_ = empty;
}

void MultibandBlend::Update(const ComposedMap& map, const RigPictures& pictures,
                            TaskRunner& runner) {
    runner.Run(rows_, [&](int row) { ReadMasks(map, pictures.frames, row); });
    FindJoints();
    for (int level = 1; level <= kLevels; ++level)
        runner.Run(rows_, [&](int row) { BlurMasks(level, row); });
    runner.Run(rows_, [&](int row) { ReadColours(map, pictures, row); });
    for (int level = 0; level + 1 < kLevels; ++level) {
        runner.Run(rows_, [&](int row) { AddBand(level, row); });
        std::swap(level_, next_level_);
    }
}

void MultibandBlend::ReadMasks(const ComposedMap& map, const RigFrames& frames, int row) {
    const std::size_t start = At(row, 0);
    std::fill_n(mask_[0].begin() + static_cast<std::ptrdiff_t>(start), cols_, Masks::Zero());
    for (int s = 0; s < sources_; ++s) {
        const CameraFrame& frame =
            frames[map.unit_of(s)][static_cast<std::size_t>(map.camera_of(s))];
        const ComposedMap::Columns& used = map.used(s, row);
        for (int col = used.first; col <= std::min(used.last, cols_ - 1); ++col) {
            const ComposedMap::Corner& corner = map.corner(s, row, col);
            if (corner.weight > 0 && Inside(frame, corner))
                mask_[0][At(row, col)][s] = corner.weight;
        }
    }
    for (std::size_t at = start; at < start + static_cast<std::size_t>(cols_); ++at) {
        Masks& mask = mask_[0][at];
        const float sum = mask.sum();
        if (sum > 0) mask /= sum;
        int most = 0;
        mask.maxCoeff(&most);
        most_[at] = static_cast<std::int8_t>(sum > 0 ? most : -1);
    }
}

void MultibandBlend::FindJoints() {
    for (int row = 0; row < rows_; ++row) {
        for (int col = 0; col < cols_; ++col)
            joint_[At(row, col)] = IsJoint(row, col) ? Joint::kHere : Joint::kFar;
        WidenJoints(At(row, 0), 1, cols_, ring_);
    }
    for (int col = 0; col < cols_; ++col)
        WidenJoints(At(0, col), static_cast<std::size_t>(cols_), rows_, false);
}

bool MultibandBlend::IsJoint(int row, int col) const {
    const std::size_t at = At(row, col);
    if (most_[at] < 0) return false;
    const auto differs = [&](std::size_t other) {
        return most_[other] >= 0 && most_[other] != most_[at];
    };
    return mask_[0][at][most_[at]] < kWhole ||
           ((ring_ || col + 1 < cols_) && differs(At(row, col + 1))) ||
           (row + 1 < rows_ && differs(At(row + 1, col)));
}

/// Along a line of corners: marks what lies within reach of what was marked before.
void MultibandBlend::WidenJoints(std::size_t first, std::size_t step, int count, bool round) {
    const Joint mark = step == 1 ? Joint::kBeside : Joint::kAbove;
    const auto sweep = [&](bool forward) {
        int left = 0;
        for (int i = 0; i < (round ? 2 : 1) * count; ++i) {
            const int along = forward ? i % count : count - 1 - i % count;
            Joint& joint = joint_[first + static_cast<std::size_t>(along) * step];
            if (joint != Joint::kFar && joint != mark) {
                left = kReach;
            } else if (left > 0) {
                joint = mark;
                --left;
            }
        }
    };
    sweep(true);
    sweep(false);
}

MultibandBlend::Neighbours MultibandBlend::NeighboursOf(int row, int col, int spacing) const {
    int left = col - spacing;
    int right = col + spacing;
    if (ring_ && left < 0) left += cols_;
    if (ring_ && right >= cols_) right -= cols_;
    Neighbours neighbours;
    for (const int down : {-1, 0, 1}) {
        const int other_row = row + down * spacing;
        if (other_row < 0 || other_row >= rows_) continue;
        const float weight = down == 0 ? 2.0F : 1.0F;
        if (left >= 0) neighbours.push_back({At(other_row, left), weight});
        neighbours.push_back({At(other_row, col), 2 * weight});
        if (right < cols_) neighbours.push_back({At(other_row, right), weight});
    }
    return neighbours;
}

void MultibandBlend::BlurMasks(int level, int row) {
    const std::vector<Masks>& sharper = mask_[static_cast<std::size_t>(level - 1)];
    for (int col = 0; col < cols_; ++col) {
        const std::size_t at = At(row, col);
        if (!NearJoint(at)) continue;
        Masks sum = Masks::Zero();
        float weight = 0;
        for (const Neighbour& neighbour : NeighboursOf(row, col, 1 << (level - 1))) {
            // Far from every joint no blur changes anything, and none was made.
            const bool blurred = NearJoint(neighbour.at);
            sum += neighbour.weight * (blurred ? sharper : mask_[0])[neighbour.at];
            weight += neighbour.weight;
        }
        mask_[static_cast<std::size_t>(level)][at] = sum / weight;
    }
}

void MultibandBlend::ReadColours(const ComposedMap& map, const RigPictures& pictures, int row) {
    for (int col = 0; col < cols_; ++col) {
        const std::size_t at = At(row, col);
        shown_[at] = 0;
        coarse_[at].setZero();
        if (!NearJoint(at)) continue;
        for (int s = 0; s < sources_; ++s) {
            if (mask_[kLevels][at][s] <= 0) continue;
            const Unit unit = map.unit_of(s);
            const auto camera = static_cast<std::size_t>(map.camera_of(s));
            const CameraFrame& frame = pictures.frames[unit][camera];
            const ComposedMap::Corner& corner = map.corner(s, row, col);
            if (!Inside(frame, corner)) continue;
            const auto source = static_cast<std::size_t>(s);
            finest_[source][at] = level_[source][at] =
                MeanColour(frame, pictures.gains[unit][camera], corner, StepAt(map, s, row, col));
            shown_[at] |= 1U << s;
        }
    }
}

MultibandBlend::Colour MultibandBlend::Blurred(int source, const Neighbours& neighbours) const {
    const Layer& layer = level_[static_cast<std::size_t>(source)];
    Colour sum = Colour::Zero();
    float weight = 0;
    for (const Neighbour& neighbour : neighbours) {
        if (!Shown(source, neighbour.at)) continue;
        sum += neighbour.weight * layer[neighbour.at];
        weight += neighbour.weight;
    }
    return sum / weight;
}

/// Level `level` less the next one; with the last of them also what is left.
void MultibandBlend::AddBand(int level, int row) {
    const bool last = level + 2 == kLevels;
    for (int col = 0; col < cols_; ++col) {
        const std::size_t at = At(row, col);
        if (shown_[at] == 0) continue;
        const Masks& mask = mask_[static_cast<std::size_t>(level + 1)][at];
        const Neighbours neighbours = NeighboursOf(row, col, 1 << level);
        Colour band = Colour::Zero();
        Colour rest = Colour::Zero();
        float band_weight = 0;
        float rest_weight = 0;
        for (int s = 0; s < sources_; ++s) {
            if (!Shown(s, at)) continue;
            const auto source = static_cast<std::size_t>(s);
            const Colour blurred = Blurred(s, neighbours);
            next_level_[source][at] = blurred;
            band += mask[s] * (level_[source][at] - blurred);
            band_weight += mask[s];
            rest += mask_[kLevels][at][s] * blurred;
            rest_weight += mask_[kLevels][at][s];
        }
        if (band_weight > 0) coarse_[at] += band / band_weight;
        if (last) coarse_[at] += rest / rest_weight;
    }
}

}  // namespace hitchview::algo

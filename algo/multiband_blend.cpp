#include "algo/multiband_blend.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "algo/camera_patch.hpp"
#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

/// A camera with less than this of the coarsest blend is not looked at: less than one grey level of
/// what the exposure of two cameras may differ by.
constexpr float kLeastShare = 1.0F / 60;
/// Canvas px from one of a patch's samples to the next.
constexpr int kSampleStep_px = 3;

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
    const float step = moved_px * kSampleStep_px / static_cast<float>(map.block_px());
    const auto most = static_cast<float>(2 * map.block_px());
    return static_cast<int>(std::clamp(step + 0.5F, 1.0F, most));
}

/// Of `count` values and those `spacing` beside them.
HV_MULTIVERSION void BlurLine(const float* above, const float* here, const float* below,
                              int spacing, int count, float* to) {
    for (int i = 0; i < count; ++i) {
        const float left = above[i - spacing] + 2 * here[i - spacing] + below[i - spacing];
        const float middle = above[i] + 2 * here[i] + below[i];
        const float right = above[i + spacing] + 2 * here[i + spacing] + below[i + spacing];
        to[i] = (left + 2 * middle + right) * (1.0F / 16);
    }
}

/// Adds `bit` where a share counts.
HV_MULTIVERSION void MarkShares(const float* share, int count, std::uint32_t bit,
                                std::uint32_t* marks) {
    for (int i = 0; i < count; ++i) marks[i] |= share[i] > kLeastShare ? bit : 0;
}

bool IsOneBit(std::uint32_t bits) {
    return (bits & (bits - 1)) == 0;
}

/// Reads patches some time after they were asked for.
class PatchReader {
 public:
    void Add(const CameraPatch& patch, float gain, MultibandBlend::Colour& to) {
        if (waiting_.full()) ReadAll();
        patch.Prefetch();
        waiting_.push_back({patch, gain, &to});
    }
    void ReadAll() {
        for (const Wanted& wanted : waiting_) *wanted.to = wanted.patch.Mean(wanted.gain);
        waiting_.clear();
    }

 private:
    struct Wanted {
        CameraPatch patch;
        float gain;
        MultibandBlend::Colour* to;
    };
    FixedVector<Wanted, 32> waiting_;
};

}  // namespace

MultibandBlend::MultibandBlend(const ComposedMap& map)
    : ring_(map.is_ring()),
      sources_(std::min(map.cameras(), kSources)),
      rows_(map.block_rows() + 1),
      cols_(map.block_cols() + (ring_ ? 0 : 1)),
      stride_(cols_ + 2 * kPad) {
    const auto corners = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(stride_);
    const auto sources = static_cast<std::size_t>(sources_);
    shown_.assign(corners, 0);
    coarse_.assign(corners, Colour::Zero());
    for (auto& masks : mask_) masks.assign(sources, std::vector<float>(corners, 0));
    for (auto& layers : level_) layers.assign(sources, Layer(corners, Colour::Zero()));
}

void MultibandBlend::Update(const ComposedMap& map, const RigPictures& pictures,
                            TaskRunner& runner) {
    runner.Run(rows_, [&](int row) { ReadMasks(map, pictures.frames, row); });
    runner.Run(sources_, [&](int source) { BlurMasks(static_cast<std::size_t>(source)); });
    runner.Run(rows_, [&](int row) {
        FindShown(row);
        ReadColours(map, pictures, row);
    });
    for (int level = 0; level < kLevels - 1; ++level)
        runner.Run(rows_, [&](int row) { AddBand(static_cast<std::size_t>(level), row); });
}

void MultibandBlend::ReadMasks(const ComposedMap& map, const RigFrames& frames, int row) {
    const std::size_t start = At(row, 0);
    const auto cols = static_cast<std::size_t>(cols_);
    float* sum = mask_[kLevels][0].data() + start;  // not used otherwise until there are all masks
    std::fill_n(sum, cols, 0.0F);
    for (int s = 0; s < sources_; ++s) {
        const CameraFrame& frame =
            frames[map.unit_of(s)][static_cast<std::size_t>(map.camera_of(s))];
        float* mask = mask_[0][static_cast<std::size_t>(s)].data() + start;
        std::fill_n(mask, cols, 0.0F);
        const ComposedMap::Columns& used = map.used(s, row);
        for (int col = used.first; col <= std::min(used.last, cols_ - 1); ++col) {
            const ComposedMap::Corner& corner = map.corner(s, row, col);
            if (corner.weight <= 0 || !Inside(frame, corner)) continue;
            mask[col] = corner.weight;
            sum[col] += corner.weight;
        }
    }
    for (std::size_t i = 0; i < cols; ++i) sum[i] = sum[i] > 0 ? 1 / sum[i] : 0;
    for (std::vector<float>& masks : mask_[0]) {
        float* mask = masks.data() + start;
        for (std::size_t i = 0; i < cols; ++i) mask[i] *= sum[i];
        Continue(mask);
    }
}

/// The columns beside the first and the last one: of a ring those that follow, elsewhere the same.
template <typename T>
void MultibandBlend::Continue(T* row) const {
    for (int i = 1; i <= kPad; ++i) {
        row[-i] = row[ring_ ? cols_ - i : 0];
        row[cols_ - 1 + i] = row[ring_ ? i - 1 : cols_ - 1];
    }
}

void MultibandBlend::BlurMasks(std::size_t source) {
    for (std::size_t level = 1; level <= kLevels; ++level) {
        const int spacing = 1 << (level - 1);
        const float* from = mask_[level - 1][source].data();
        float* to = mask_[level][source].data();
        for (int row = 0; row < rows_; ++row) {
            const Around around = AroundRow(row, spacing);
            BlurLine(from + around.above, from + around.here, from + around.below, spacing, cols_,
                     to + around.here);
            Continue(to + around.here);
        }
    }
}

/// Two cameras share the coarsest blend; elsewhere there is nothing to add.
void MultibandBlend::FindShown(int row) {
    const std::size_t start = At(row, 0);
    for (std::size_t at = start; at < start + static_cast<std::size_t>(cols_); ++at) {
        for (std::uint32_t bits = shown_[at]; bits != 0; bits &= bits - 1) {
            const auto s = static_cast<std::size_t>(std::countr_zero(bits));
            for (auto& layers : level_) layers[s][at].setZero();
        }
        shown_[at] = 0;
    }
    for (std::size_t s = 0; s < mask_[kLevels].size(); ++s)
        MarkShares(mask_[kLevels][s].data() + start, cols_, 1U << s, shown_.data() + start);
}

void MultibandBlend::ReadColours(const ComposedMap& map, const RigPictures& pictures, int row) {
    PatchReader reader;
    for (int col = 0; col < cols_; ++col) {
        const std::size_t at = At(row, col);
        std::uint32_t& shown = shown_[at];
        if (IsOneBit(shown)) shown = 0;
        for (std::uint32_t bits = shown; bits != 0; bits &= bits - 1) {
            const int s = std::countr_zero(bits);
            const Unit unit = map.unit_of(s);
            const auto camera = static_cast<std::size_t>(map.camera_of(s));
            const CameraFrame& frame = pictures.frames[unit][camera];
            const ComposedMap::Corner& corner = map.corner(s, row, col);
            if (Inside(frame, corner)) {
                reader.Add({&frame, corner.x, corner.y, StepAt(map, s, row, col)},
                           pictures.gains[unit][camera],
                           level_[0][static_cast<std::size_t>(s)][at]);
            } else {
                shown &= ~(1U << s);
            }
        }
    }
    reader.ReadAll();
    for (Layer& layer : level_[0]) Continue(layer.data() + At(row, 0));
}

MultibandBlend::Around MultibandBlend::AroundRow(int row, int spacing) const {
    return {At(std::max(row - spacing, 0), 0), At(row, 0),
            At(std::min(row + spacing, rows_ - 1), 0)};
}

/// Of what the source shows by (1 2 1) x (1 2 1), `spacing` corners apart.
MultibandBlend::Colour MultibandBlend::Blurred(const Layer& layer, const Around& around, int col,
                                               int spacing) {
    const Colour* above = layer.data() + around.above + col;
    const Colour* here = layer.data() + around.here + col;
    const Colour* below = layer.data() + around.below + col;
    const Colour diagonal = above[-spacing] + above[spacing] + below[-spacing] + below[spacing];
    const Colour beside = above[0] + below[0] + here[-spacing] + here[spacing];
    const Colour sum = diagonal + 2 * beside + 4 * here[0];
    return sum / sum[3];  // the corners that it does not show count nothing
}

/// Level `level` less the next one; with the last of them also what is left.
void MultibandBlend::AddBand(std::size_t level, int row) {
    const bool last = level + 2 == kLevels;
    const int spacing = 1 << level;
    const Around around = AroundRow(row, spacing);
    for (int col = 0; col < cols_; ++col) {
        const std::size_t at = At(row, col);
        Colour band = Colour::Zero();
        Colour rest = Colour::Zero();
        float band_weight = 0;
        float rest_weight = 0;
        for (std::uint32_t bits = shown_[at]; bits != 0; bits &= bits - 1) {
            const auto s = static_cast<std::size_t>(std::countr_zero(bits));
            const Layer& layer = level_[level][s];
            const Colour blurred = Blurred(layer, around, col, spacing);
            const float share = mask_[level + 1][s][at];
            band += share * (layer[at] - blurred);
            band_weight += share;
            if (!last) level_[level + 1][s][at] = blurred;
            if (!last) continue;
            rest += mask_[kLevels][s][at] * blurred;
            rest_weight += mask_[kLevels][s][at];
        }
        if (level == 0) coarse_[at].setZero();
        if (band_weight > 0) coarse_[at] += band / band_weight;
        if (last && rest_weight > 0) coarse_[at] += rest / rest_weight;
    }
    if (last) return;
    for (Layer& layer : level_[level + 1]) Continue(layer.data() + around.here);
}

}  // namespace hitchview::algo

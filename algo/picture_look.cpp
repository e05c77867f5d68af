#include "algo/picture_look.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace hitchview::algo {
namespace {

constexpr int kSamplesPerSide = 12;  // of a cell
constexpr float kSamplesPerCell = kSamplesPerSide * kSamplesPerSide;

/// Distances between the pixels that are compared.
struct Distances {
    int fine, coarse;

    explicit Distances(int width_px)
        : fine(std::max(1, width_px / 640)), coarse(width_px < 640 ? 4 : 8 * fine) {}
};

class Print {
 public:
    void Add(std::uint64_t word) { value_ = std::rotl((value_ ^ word) * kOddRandom, 29); }
    [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
    static constexpr std::uint64_t kOddRandom = 0x9E3779B97F4A7C15;
    std::uint64_t value_ = 0;
};

constexpr float Square(float value) {
    return value * value;
}

/// Where sample `index` of `count` lies among `pixels`.
int At(int index, int count, int pixels) {
    return (2 * index + 1) * pixels / (2 * count);
}

class Looker {
 public:
    explicit Looker(const CameraFrame& picture)
        : luma_(picture.LumaSamples()), range_(picture.range), distances_(picture.width_px) {}

    PictureLook Look() {
        PictureLook look;
        for (int y = 0; y < PictureLook::kRows * kSamplesPerSide; ++y) LookAlong(y, look);
        constexpr float kSamples = kSamplesPerCell * PictureLook::kCells;
        look.mean /= kSamples;
        look.dark_share /= kSamples;
        look.bright_share /= kSamples;
        for (PictureLook::Cell& cell : look.cells) {
            cell.fine /= kSamplesPerCell;
            cell.coarse /= kSamplesPerCell;
        }
        look.print = print_.value();
        return look;
    }

 private:
    void LookAlong(int sample_row, PictureLook& look) {
        const std::uint8_t* const row =
            luma_.row(At(sample_row, PictureLook::kRows * kSamplesPerSide, luma_.rows));
        const auto grey = [&](int x) { return static_cast<float>(row[x * luma_.step_bytes]); };
        constexpr int kAcross = PictureLook::kCols * kSamplesPerSide;
        for (int i = 0; i < kAcross; ++i) {
            const int x = At(i, kAcross, luma_.cols - distances_.coarse);
            const float here = grey(x);
            const float level = FullLuma(range_, here);
            look.mean += level;
            if (level <= PictureLook::kDark) ++look.dark_share;
            if (level >= PictureLook::kBright) ++look.bright_share;
            print_.Add(row[x * luma_.step_bytes]);
            PictureLook::Cell& cell =
                look.cells[static_cast<std::size_t>(sample_row / kSamplesPerSide *
                                                        PictureLook::kCols +
                                                    i / kSamplesPerSide)];
            cell.fine += Square(grey(x + distances_.fine) - here);
            cell.coarse += Square(grey(x + distances_.coarse) - here);
        }
    }

    SamplePlane luma_;
    SampleRange range_;
    Distances distances_;
    Print print_;
};

}  // namespace

PictureLook LookAt(const CameraFrame& picture) {
    return Looker(picture).Look();
}

std::uint64_t PrintOf(const CameraFrame& picture) {
    const std::size_t row_bytes =
        static_cast<std::size_t>(picture.width_px) * (picture.is_packed() ? 2 : 1);
    Print print;
    for (int y = 0; y < picture.height_px; ++y) {
        const std::uint8_t* const row =
            picture.luma + static_cast<std::ptrdiff_t>(y) * picture.luma_stride_bytes;
        for (std::size_t x = 0; x < row_bytes; x += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, row + x, std::min(sizeof word, row_bytes - x));
            print.Add(word);
        }
    }
    return print.value();
}

}  // namespace hitchview::algo

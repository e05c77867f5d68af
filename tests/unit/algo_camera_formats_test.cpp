#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <random>

#include "algo/panorama_renderer.hpp"
#include "tests/support/camera_picture.hpp"
#include "tests/support/nv12_picture.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using tests::CameraPicture;
using tests::PanoramaPicture;

struct Format {
    PixelLayout layout;
    SampleRange range;
};

constexpr std::array<Format, 8> kFormats{{{PixelLayout::kNv12, SampleRange::kFull},
                                          {PixelLayout::kNv12, SampleRange::kLimited},
                                          {PixelLayout::kUyvy, SampleRange::kFull},
                                          {PixelLayout::kUyvy, SampleRange::kLimited},
                                          {PixelLayout::kYuyv, SampleRange::kFull},
                                          {PixelLayout::kYuyv, SampleRange::kLimited},
                                          {PixelLayout::kGrey, SampleRange::kFull},
                                          {PixelLayout::kGrey, SampleRange::kLimited}}};

/// A plane rig with one camera, moved on the canvas.
class MovedCamera {
 public:
    MovedCamera(cv::Size camera, cv::Size canvas, const Matrix3d& M_canvas_camera)
        : canvas_(canvas), M_camera_canvas_(M_canvas_camera.inverse()) {
        rig_[Unit::kTractor] = UnitGeometry::Plane(camera.width, camera.height);
        map_.emplace(Projection::Plane(canvas.width, canvas.height), rig_, SeamOptions{});
        Composition composition;
        composition.M_canvas_view[Unit::kTractor] = M_canvas_camera;
        SerialRunner runner;
        map_->Build(composition, runner);
    }

    PanoramaPicture Render(const CameraFrame& frame, float gain = 1) const {
        RigFrames frames;
        frames[Unit::kTractor][0] = frame;
        CameraGains gains{};
        gains[Unit::kTractor][0] = gain;
        PanoramaRenderer renderer;
        renderer.SetGains(gains);
        PanoramaPicture panorama(canvas_);
        SerialRunner runner;
        renderer.Render(*map_, frames, NoData::kBlack, panorama.planes(), runner);
        return panorama;
    }
    [[nodiscard]] Eigen::Vector2d CameraPixel(double x, double y) const {
        return (M_camera_canvas_ * Eigen::Vector3d(x, y, 1)).hnormalized();
    }
    [[nodiscard]] cv::Size canvas() const { return canvas_; }

 private:
    cv::Size canvas_;
    Matrix3d M_camera_canvas_;
    PerUnit<std::optional<UnitGeometry>> rig_;
    std::optional<ComposedMap> map_;
};

Matrix3d Similarity(double zoom, double turn_rad, double dx, double dy) {
    Matrix3d m;
    const double c = zoom * std::cos(turn_rad);
    const double s = zoom * std::sin(turn_rad);
    m << c, -s, dx, s, c, dy, 0, 0, 1;
    return m;
}

/// The exact bilinear value between four samples, in doubles; outside the picture its edge's.
double Between(const SamplePlane& plane, double x, double y) {
    x = std::clamp(x, 0.0, plane.cols - 1.0);
    y = std::clamp(y, 0.0, plane.rows - 1.0);
    const int left = static_cast<int>(x);
    const int top = static_cast<int>(y);
    const double fx = x - left;
    const double fy = y - top;
    const auto at = [&](int col, int row) {
        return double{plane.row(std::min(
                          row, plane.rows - 1))[std::min(col, plane.cols - 1) * plane.step_bytes] *
                      1.0};
    };
    return (1 - fy) * ((1 - fx) * at(left, top) + fx * at(left + 1, top)) +
           fy * ((1 - fx) * at(left, top + 1) + fx * at(left + 1, top + 1));
}

double FullRange(SampleRange range, double value, bool colour) {
    if (range == SampleRange::kFull) return value;
    return colour ? 128 + (value - 128) * 255 / 224 : (value - 16) * 255 / 219;
}

double Shown(double value, double gain, bool colour) {
    return std::clamp(colour ? 128 + gain * (value - 128) : gain * value, 0.0, 255.0);
}

/// Most that any pixel differs from the exact value, by channel: in the picture from what lies
/// there, outside from black. Only on the very edge between them anything goes.
std::array<double, 3> WorstError(const MovedCamera& moved, const CameraFrame& frame, double gain,
                                 int* compared) {
    const PanoramaPicture panorama = moved.Render(frame, static_cast<float>(gain));
    std::array<double, 3> worst{};
    *compared = 0;
    const auto compare = [&](std::size_t channel, int shown, double exact) {
        worst[channel] = std::max(worst[channel], std::abs(shown - exact));
    };
    const auto inside = [&](const Eigen::Vector2d& p) {
        return p.minCoeff() > 0.01 && p.x() < frame.width_px - 1.01 &&
               p.y() < frame.height_px - 1.01;
    };
    const auto outside = [&](const Eigen::Vector2d& p) {
        return p.minCoeff() < -0.01 || p.x() > frame.width_px - 0.99 ||
               p.y() > frame.height_px - 0.99;
    };
    for (int y = 0; y < moved.canvas().height; ++y) {
        for (int x = 0; x < moved.canvas().width; ++x) {
            const Eigen::Vector2d p = moved.CameraPixel(x, y);
            if (outside(p)) compare(0, panorama.y()(y, x), 0);
            if (!inside(p)) continue;
            const double exact = Between(frame.LumaSamples(), p.x(), p.y());
            compare(0, panorama.y()(y, x),
                    Shown(FullRange(frame.range, exact, false), gain, false));
            ++*compared;
        }
    }
    for (int y = 0; y < moved.canvas().height / 2; ++y) {
        for (int x = 0; x < moved.canvas().width / 2; ++x) {
            const Eigen::Vector2d p = moved.CameraPixel(2 * x + 0.5, 2 * y + 0.5);
            for (const int channel : {0, 1}) {
                const auto at = static_cast<std::size_t>(1 + channel);
                const int shown = (channel == 0 ? panorama.u() : panorama.v())(y, x);
                if (outside(p)) compare(at, shown, 128);
                if (!inside(p)) continue;
                double exact = 128;
                if (frame.has_chroma()) {
                    const auto px = static_cast<float>(p.x());
                    exact = Between(frame.ChromaSamples(channel), CameraFrame::ChromaX(px),
                                    frame.ChromaY(static_cast<float>(p.y())));
                    exact = Shown(FullRange(frame.range, exact, true), gain, true);
                }
                compare(at, shown, exact);
            }
        }
    }
    return worst;
}

struct Case {
    cv::Size camera;
    cv::Size canvas;
    Matrix3d M_canvas_camera;
};

/// Ordinary ones, steep ones, strongly reduced ones, pictures smaller than the kernel's window, and
/// canvases so wide that the map's corners lie 16 px apart.
std::vector<Case> Cases() {
    return {{{160, 96}, {202, 106}, Similarity(1.05, 0.02, 3.3, 2.6)},
            {{160, 96}, {202, 106}, Similarity(1, 0, 17, -9)},
            {{160, 96}, {128, 96}, Similarity(0.55, -0.4, 31.7, 40.2)},
            {{160, 96}, {96, 128}, Similarity(0.6, 1.5, 80.1, 10.4)},
            {{160, 96}, {128, 96}, Similarity(0.7, 3.1, 120, 90)},
            {{320, 192}, {80, 48}, Similarity(0.23, 0.1, 4, 3)},
            {{160, 96}, {480, 256}, Similarity(2.7, -0.05, 6, 20)},
            {{30, 18}, {64, 48}, Similarity(1.3, 0.05, 8.2, 7.9)},
            {{4, 2}, {32, 16}, Similarity(3.1, 0, 2, 2)},
            {{160, 96}, {2050, 106}, Similarity(1.05, 0.02, 1903.3, 2.6)},
            {{160, 96}, {2064, 130}, Similarity(0.6, 1.5, 280.1, 10.4)}};
}

class CameraFormatsTest : public testing::TestWithParam<Format> {};

TEST_P(CameraFormatsTest, EveryPixelIsWithinOneLevelOfTheExactBilinearValue) {
    std::uint64_t seed = 11;
    for (const Case& world : Cases()) {
        const CameraPicture::Content content = CameraPicture::RandomContent(world.camera, seed++);
        const MovedCamera moved(world.camera, world.canvas, world.M_canvas_camera);
        for (const double gain : {1.0, 0.71, 1.43}) {
            const CameraPicture picture(content, GetParam().layout, GetParam().range,
                                        static_cast<int>(seed % 7));
            int compared = 0;
            const auto worst = WorstError(moved, picture.frame(), gain, &compared);
            EXPECT_GE(compared, world.camera.area() > 100 ? 400 : 0);
            for (const double error : worst)
                EXPECT_LE(error, 1.0) << world.camera << " gain " << gain;
        }
    }
}

TEST_P(CameraFormatsTest, AllFormatsShowTheSamePicture) {
    const cv::Size size(160, 96);
    CameraPicture::Content content = CameraPicture::RandomContent(size, 5);
    cv::GaussianBlur(content.u, content.u, {}, 3);  // rows of colour differ in number
    cv::GaussianBlur(content.v, content.v, {}, 3);
    const MovedCamera moved(size, {202, 106}, Similarity(1.05, 0.02, 3.3, 2.6));
    const CameraPicture first(content, PixelLayout::kNv12, SampleRange::kFull);
    const CameraPicture other(content, GetParam().layout, GetParam().range);
    const PanoramaPicture expected = moved.Render(first.frame());
    const PanoramaPicture shown = moved.Render(other.frame());
    const double tolerance = GetParam().range == SampleRange::kFull ? 0 : 1;
    EXPECT_LE(cv::norm(expected.y(), shown.y(), cv::NORM_INF), tolerance);
    if (GetParam().layout == PixelLayout::kGrey) {
        EXPECT_EQ(cv::countNonZero(shown.u() != 128), 0);
        EXPECT_EQ(cv::countNonZero(shown.v() != 128), 0);
    } else {
        EXPECT_LE(cv::norm(expected.u(), shown.u(), cv::NORM_INF), 3);
        EXPECT_LE(cv::norm(expected.v(), shown.v(), cv::NORM_INF), 3);
    }
}

/// Memory whose last byte lies before a page that must not be touched.
class GuardedBytes {
 public:
    explicit GuardedBytes(std::size_t bytes) {
        const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
        const std::size_t pages = (bytes + page - 1) / page * page;
        length_ = pages + page;
        memory_ =
            mmap(nullptr, length_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        auto* const first = static_cast<std::uint8_t*>(memory_);
        mprotect(first + pages, page, PROT_NONE);
        begin_ = first + pages - bytes;
    }
    GuardedBytes(const GuardedBytes&) = delete;
    GuardedBytes& operator=(const GuardedBytes&) = delete;
    ~GuardedBytes() { munmap(memory_, length_); }
    [[nodiscard]] std::uint8_t* begin() { return begin_; }

 private:
    void* memory_ = nullptr;
    std::size_t length_ = 0;
    std::uint8_t* begin_ = nullptr;
};

TEST_P(CameraFormatsTest, NothingIsReadBeyondTheLastPixel) {
    for (const Case& world : Cases()) {
        const CameraPicture picture(CameraPicture::RandomContent(world.camera, 3),
                                    GetParam().layout, GetParam().range, 0);
        CameraFrame frame = picture.frame();
        GuardedBytes guarded(picture.bytes());
        std::memcpy(guarded.begin(), frame.luma, picture.bytes());
        frame.chroma = guarded.begin() + (frame.chroma - frame.luma);
        frame.luma = guarded.begin();
        const MovedCamera moved(world.camera, world.canvas, world.M_canvas_camera);
        EXPECT_TRUE(moved.Render(frame) == moved.Render(picture.frame()));
    }
}

TEST_P(CameraFormatsTest, EveryInstructionSetDrawsTheSameBits) {
    const auto render_all = [&] {
        std::vector<PanoramaPicture> shown;
        for (const Case& world : Cases()) {
            const MovedCamera moved(world.camera, world.canvas, world.M_canvas_camera);
            const CameraPicture picture(CameraPicture::RandomContent(world.camera, 3),
                                        GetParam().layout, GetParam().range);
            shown.push_back(moved.Render(picture.frame(), 1.1F));
        }
        return shown;
    };
    const std::vector<PanoramaPicture> best = render_all();
    int compared = 0;
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
        if (target == HWY_SCALAR) continue;  // of processors that the kernel leaves alone
        ++compared;
        hwy::SetSupportedTargetsForTest(target);
        EXPECT_TRUE(render_all() == best) << hwy::TargetName(target);
    }
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_GT(compared, 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, CameraFormatsTest, testing::ValuesIn(kFormats));

}  // namespace
}  // namespace hitchview::algo

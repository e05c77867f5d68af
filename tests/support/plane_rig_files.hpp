#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "algo/unit.hpp"
#include "tests/support/simulated_rig_files.hpp"
#include "tests/support/sine_texture.hpp"

namespace hitchview::tests {

/// Two cameras that look at one flat picture without end through windows of kSize, side by side
/// with an overlap, each with a known shake. Pictures are recorded as PNG sequences.
class PlaneRigFiles {
 public:
    static constexpr int kFrames = 16;
    inline static const cv::Size kSize{320, 240};
    inline static const cv::Size kCanvas{640, 300};
    /// World point at the top-left pixel of each window at rest.
    static constexpr algo::PerUnit<std::array<double, 2>> kWindow{{{{0, 0}, {220, 6}}}};

    /// `shake_px`: amplitude; 0 is two still cameras.
    explicit PlaneRigFiles(double shake_px) : shake_px_(shake_px) {
        for (const algo::Unit unit : algo::kUnits) {
            for (int i = 0; i < kFrames; ++i) {
                const cv::Vec2d corner = Corner(unit, i);
                Record(unit, i, texture_.Shifted(kSize, -corner[0], -corner[1]));
            }
        }
    }
    /// Nothing but grey.
    static PlaneRigFiles Flat() {
        PlaneRigFiles files;
        for (const algo::Unit unit : algo::kUnits) {
            for (int i = 0; i < kFrames; ++i)
                files.Record(unit, i, cv::Mat1b(kSize, std::uint8_t{120}));
        }
        return files;
    }

    /// Grey level of the world where pixel (x, y) of a unit's frame looks.
    [[nodiscard]] double WorldAt(algo::Unit unit, int frame, double x, double y) const {
        const cv::Vec2d corner = Corner(unit, frame);
        return texture_.At(x + corner[0], y + corner[1]);
    }

    /// `more`: further keys of the rig file.
    [[nodiscard]] std::string Rig(const std::string& more = "") const {
        return folder_->Write("rig.yaml",
                              "schema: 1\n"
                              "canvas: {projection: plane, size_px: [640, 300]}\n"
                              "units:\n"
                              "  tractor: {cameras: [{name: a, source: {replay: tractor}}]}\n"
                              "  trailer: {cameras: [{name: b, source: {replay: trailer}}]}\n" +
                                  more);
    }
    [[nodiscard]] const TemporaryFolder& folder() const { return *folder_; }

 private:
    PlaneRigFiles() = default;

    /// World point at the top-left pixel of a unit's frame.
    [[nodiscard]] cv::Vec2d Corner(algo::Unit unit, int frame) const {
        const double phase = unit == algo::Unit::kTractor ? 0.3 : 2.1;
        return {kWindow[unit][0] + shake_px_ * std::sin(1.7 * frame + phase),
                kWindow[unit][1] + shake_px_ * std::sin(2.3 * frame + 2 * phase)};
    }
    void Record(algo::Unit unit, int frame, const cv::Mat1b& picture) const {
        const std::filesystem::path folder = *folder_ / ToString(unit);
        std::filesystem::create_directories(folder);
        EXPECT_TRUE(cv::imwrite(folder / (std::to_string(frame) + ".png"), picture));
    }

    SineTexture texture_{7};
    double shake_px_ = 0;
    std::unique_ptr<TemporaryFolder> folder_ = std::make_unique<TemporaryFolder>();
};

}  // namespace hitchview::tests

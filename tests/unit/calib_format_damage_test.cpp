#include <gtest/gtest.h>

#include <random>

#include "tests/support/format_samples.hpp"
#include "tests/support/format_test.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Kind = CameraModel::Kind;

class FormatDamageTest : public FormatTest {};

TEST_F(FormatDamageTest, HostileNumbersAreNamedWithTheirLine) {
    const auto with = [](const std::string& focal, const std::string& width) {
        return "image_width: " + width + "\nimage_height: 480\nK: [" + focal +
               ", 0, 320, 0, 300, 240, 0, 0, 1]\nD: [0, 0, 0, 0, 0]\n";
    };
    EXPECT_EQ(ErrorOf(Format::kOpenCv, with("300", "640")), "");
    EXPECT_EQ(ErrorOf(Format::kOpenCv, with("nan", "640")),
              "lens.txt:3: K[0] is nan, must be -1e+12 to 1e+12");
    EXPECT_NE(ErrorOf(Format::kOpenCv, with(".Nan", "640")), "");
    EXPECT_NE(ErrorOf(Format::kOpenCv, with("1e400", "640")), "");
    EXPECT_NE(ErrorOf(Format::kOpenCv, with("300, 1", "640")), "");
    EXPECT_EQ(ErrorOf(Format::kOpenCv, with("-300", "640")),
              "lens.txt:3: K is a list of 9, must be one with focal lengths of 10 to 20000 px, not "
              "[-300, 300]");
    EXPECT_EQ(ErrorOf(Format::kOpenCv, with("300", "4000000000")),
              "lens.txt:1: image_width is 4000000000, must be 64 to 8192");
    EXPECT_NE(
        ErrorOf(Format::kOpenCv, "K: {rows: 2000000000, cols: 2000000000, dt: d, data: [1]}\n"),
        "");
    EXPECT_EQ(ErrorOf(Format::kOpenCv, with("300", "640") + std::string(2 << 20, '#')),
              "lens.txt: the file is too long, must be at most 1 MiB");
}

TEST_F(FormatDamageTest, DeepNestingIsAnErrorAndNothingWorse) {
    std::string xml = "<?xml version=\"1.0\"?>\n<opencv_storage>\n";
    for (int i = 0; i < 100000; ++i) xml += "<a>";
    EXPECT_NE(ErrorOf(Format::kOpenCv, xml), "");
    for (int i = 0; i < 100000; ++i) xml += "</a>";
    EXPECT_NE(ErrorOf(Format::kOpenCv, xml + "</opencv_storage>"), "");
    EXPECT_NE(ErrorOf(Format::kOpenCv, "K: " + std::string(100000, '[')), "");
    EXPECT_NE(ErrorOf(Format::kMrcal, std::string(100000, '{')), "");
}

/// Cuts, and bytes that are others.
TEST_F(FormatDamageTest, DamagedFilesAreErrorsOrLensesInRange) {
    tests::FormatSamples samples(5);
    std::mt19937 random(6);
    const CameraModel lens = samples.Lens(Kind::kPinholeRadtan);
    CameraModel plain = lens;
    plain.distortion[4] = 0;
    const std::string xml =
        "<?xml version=\"1.0\"?>\n<opencv_storage>\n<!-- x -->\n<resolution>640 480"
        "</resolution>\n<K type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols>"
        "<dt>d</dt><data>\n300 0 320 0 300\n240 0 0 1</data></K>\n<D>0 0 0 0 0</D>"
        "\n</opencv_storage>\n";
    ASSERT_EQ(ErrorOf(Format::kOpenCv, xml), "");
    std::vector<std::pair<Format, std::string>> texts{{Format::kOpenCv, xml}};
    for (const Format format : {Format::kOpenCv, Format::kRos, Format::kKalibr, Format::kMrcal})
        texts.emplace_back(format, ExportLens(format, "a", plain).files.at(0).text);
    for (const auto& [format, text] : texts) {
        for (std::size_t i = 0; i < 150; ++i) {
            std::string damaged = text.substr(0, i % 2 == 0 ? random() % text.size() : text.size());
            for (std::size_t k = i % 5; k > 0 && !damaged.empty(); --k)
                damaged[random() % damaged.size()] = static_cast<char>(random());
            const ForeignCameras found = Imported(format, damaged);
            ASSERT_EQ(found.error.empty(), !found.cameras.empty()) << damaged;
            for (const ForeignCamera& camera : found.cameras) {
                EXPECT_GE(camera.model.fx_px, 10) << damaged;
                EXPECT_LE(camera.model.width_px, 8192) << damaged;
                EXPECT_GE(camera.model.max_theta_rad, 0.05) << damaged;
                EXPECT_LE(camera.model.max_theta_rad, 3.14) << damaged;
            }
        }
    }
}

}  // namespace
}  // namespace hitchview::calib

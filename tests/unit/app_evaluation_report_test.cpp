#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include "app/evaluation_figures.hpp"
#include "app/evaluation_report.hpp"
#include "app/evaluation_report_axis.hpp"
#include "app/evaluation_report_chart.hpp"
#include "app/evaluation_summary.hpp"
#include "app/html_report.hpp"
#include "tests/support/html_page.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using tests::Count;
using tests::ExpectSelfContained;
using tests::Unbalanced;

// A tractor that shakes, seen by a camera and stabilised without shake; no trailer, so no seam.
Quality OneUnit() {
    const cv::Mat texture = tests::Texture({240, 180}, 5);
    UnitMeters meters;
    SeamMeter seam;
    for (int i = 0; i < 20; ++i) {
        const cv::Rect in(20 + 3 * (i % 2), 20, 160, 120);
        const cv::Rect out(20, 20, 160, 120);
        meters.in.Append(texture(in));
        meters.out.Append(texture(out));
        if (i % 5 == 0) meters.view.Append(texture(in), texture(out), i);
    }
    Quality quality;
    quality.figures = {{"frames", 20},
                       {"units", {{"tractor", UnitFigures(meters)}}},
                       {"seams", {{"left", SeamFigures(seam)}, {"right", SeamFigures(seam)}}},
                       {"panorama", PanoramaFigures({}, {})},
                       {"recordings", {{"units", {{"tractor", {{"in", "/a <b> & \"c\".avi"}}}}}}},
                       {"series",
                        {{"rate_hz", 30},
                         {"step", 5},
                         {"units", {{"tractor", UnitSeries(meters)}}},
                         {"seams", {{"left", SeamSeries(seam)}, {"right", SeamSeries(seam)}}},
                         {"panorama", CoverageSeries({})}}}};
    quality.worst_views[algo::Unit::kTractor] = meters.view.worst();
    return quality;
}

Quality WithASeam() {
    Quality quality = OneUnit();
    json& right = quality.figures["seams"]["right"];
    right["median_px"] = 1.234;
    right["paper"]["stitching_score_px"] = 7.654;
    quality.figures["series"]["seams"]["right"] = {
        {"frame", {0, 5}}, {"pairs", {20, 30}}, {"mean_px", {1.0, 7.654}}, {"p95_px", {2.0, 9.0}}};
    quality.worst_seams[algo::Overlap::kRight] = {
        .figures = {.frame = 5, .pairs = 30, .mean_px = 7.654, .p95_px = 9},
        .tractor_grey = tests::Texture({80, 120}, 1),
        .trailer_grey = tests::Texture({80, 120}, 2),
        .pairs = {.first = {{10, 10}}, .second = {{14, 12}}}};
    return quality;
}

TEST(HtmlReportTest, IsWellFormedAndNeedsNothingElse) {
    for (const Quality& quality : {OneUnit(), WithASeam()}) {
        const std::string html = HtmlReport(quality);
        EXPECT_EQ(Unbalanced(html), "");
        ExpectSelfContained(html);
    }
}

TEST(HtmlReportTest, ShowsTheFiguresBesideThePublishedOnes) {
    const Quality quality = WithASeam();
    const std::string html = HtmlReport(quality);
    const json& paper = quality.figures["units"]["tractor"]["paper"];
    EXPECT_THAT(html, HasSubstr(Number(paper["cropping"], 4)));
    EXPECT_THAT(html, HasSubstr(Number(paper["distortion"], 4)));
    EXPECT_THAT(html, HasSubstr("7.654 px"));
    EXPECT_THAT(html, HasSubstr("1.23 px"));
    for (const char* published : {"0.9828", "0.9805", "0.9121", "0.859 to 0.952 px"}) {
        EXPECT_THAT(html, HasSubstr(published));
    }
}

TEST(HtmlReportTest, SaysWhatWasNotMeasured) {
    const std::string html = HtmlReport(OneUnit());
    for (const char* title : {"Seam error over time", "worst frames"}) {
        const std::size_t section = html.find(title);
        ASSERT_NE(section, std::string::npos) << title;
        EXPECT_THAT(html.substr(section, html.find("</section>", section) - section),
                    HasSubstr("not measured"));
    }
}

TEST(HtmlReportTest, EscapesTheNamesOfFiles) {
    const std::string html = HtmlReport(OneUnit());
    EXPECT_THAT(html, HasSubstr("/a &lt;b&gt; &amp; &quot;c&quot;.avi"));
    EXPECT_THAT(html, Not(HasSubstr("/a <b>")));
}

TEST(HtmlReportTest, HoldsTheWorstFramesAsPictures) {
    constexpr const char* kJpeg = "src=\"data:image/jpeg;base64,/9j/";
    EXPECT_EQ(Count(HtmlReport(OneUnit()), kJpeg), 2);
    EXPECT_EQ(Count(HtmlReport(WithASeam()), kJpeg), 5);
}

TEST(UnbalancedTest, FindsATagThatIsNotClosed) {
    EXPECT_EQ(Unbalanced("<p a=\"<\">x<br/></p>"), "");
    EXPECT_NE(Unbalanced("<p><b>x</p></b>"), "");
    EXPECT_NE(Unbalanced("<p>"), "");
}

std::vector<std::string> Labels(const Axis& axis) {
    std::vector<std::string> labels;
    for (const Tick& tick : axis.Ticks()) labels.push_back(tick.label);
    return labels;
}

TEST(AxisTest, TicksAreRoundAndStandWhereTheirValuesAre) {
    const Axis axis({-3, 17}, {100, 300}, Scale::kLinear);
    EXPECT_EQ(Labels(axis), (std::vector<std::string>{"0", "5", "10", "15"}));
    EXPECT_DOUBLE_EQ(axis.Ticks()[1].px, 180);
    EXPECT_DOUBLE_EQ(axis.Px(17), 300);
    EXPECT_EQ(Labels(Axis({0.95, 1}, {0, 1}, Scale::kLinear)),
              (std::vector<std::string>{"0.95", "0.96", "0.97", "0.98", "0.99", "1.00"}));
}

TEST(AxisTest, ALogarithmicScaleHasPowersOfTen) {
    const Axis axis({0.05, 20}, {0, 100}, Scale::kLogarithmic);
    EXPECT_EQ(Labels(axis), (std::vector<std::string>{"0.1", "1", "10"}));
    EXPECT_NEAR(axis.Px(1), 50, 1e-9);
}

TEST(AxisTest, ARangeWithoutLengthIsWidened) {
    const Axis axis({2, 2}, {0, 100}, Scale::kLinear);
    EXPECT_NEAR(axis.Px(2), 50, 1e-9);
    EXPECT_FALSE(axis.Ticks().empty());
}

TEST(ChartTest, APeakBetweenManyPointsIsDrawn) {
    ChartLine line{.name = "a", .style = "first", .x = {}, .y = {}};
    for (int i = 0; i < 100000; ++i) {
        line.x.push_back(i);
        line.y.push_back(i == 54321 ? 1 : 0);
    }
    const std::string svg = Draw({.title = "t", .x_label = "", .y_label = "", .lines = {line}});
    EXPECT_LT(svg.size(), 60000U);
    EXPECT_THAT(svg, HasSubstr(",10.0 "));  // the upper edge of the drawing
}

TEST(ChartTest, WithoutPointsThereIsNoDrawing) {
    const std::string html = Draw({.title = "t", .x_label = "", .y_label = "", .lines = {}});
    EXPECT_THAT(html, HasSubstr("not measured"));
    EXPECT_THAT(html, Not(HasSubstr("<svg")));
}

TEST(HtmlTest, Base64IsThatOfTheStandard) {
    const auto encoded = [](const std::string& text) {
        return Base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    };
    EXPECT_EQ(encoded(""), "");
    EXPECT_EQ(encoded("f"), "Zg==");
    EXPECT_EQ(encoded("fo"), "Zm8=");
    EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(HtmlTest, NothingIsLessThanZeroByRounding) {
    EXPECT_EQ(Number(-0.0004, 2), "0.00");
    EXPECT_EQ(Number(-0.006, 2), "-0.01");
}

std::string WriteFigures(const std::string& path, double cropping, const json& score_px) {
    const json figures{
        {"units", {{"tractor", {{"paper", {{"cropping", cropping}, {"stability", nullptr}}}}}}},
        {"seams", {{"right", {{"paper", {{"stitching_score_px", score_px}}}}}}}};
    std::ofstream(path) << figures;
    return path;
}

TEST(SummaryTest, HasTheMeansBesideThePublishedFigures) {
    const tests::TemporaryFolder folder;
    const auto summary = Summarise(
        {WriteFigures(folder / "a.json", 0.9, 1.5), WriteFigures(folder / "b.json", 0.8, nullptr)});
    ASSERT_TRUE(summary) << summary.error();
    const std::string& table = summary.value().table;
    EXPECT_THAT(table, testing::ContainsRegex("mean +0.8500 +- +- +1.5000\n"));
    EXPECT_THAT(table, testing::ContainsRegex("published +0.9828 +0.9805 +0.9121 +0.859 to 0.952"));
    EXPECT_THAT(table, HasSubstr("a.json right seam"));
    EXPECT_THAT(table, Not(HasSubstr("b.json right seam")));
}

TEST(SummaryTest, WhatCannotBeReadIsNamed) {
    const tests::TemporaryFolder folder;
    EXPECT_THAT(Summarise({folder / "none.json"}).error(), HasSubstr("none.json: cannot be read"));
    folder.Write("bad.json", "{");
    EXPECT_THAT(Summarise({folder / "bad.json"}).error(), HasSubstr("bad.json: not a file of"));
}

}  // namespace
}  // namespace hitchview::app

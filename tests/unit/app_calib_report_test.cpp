#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "app/calib_report.hpp"
#include "app/calib_report_picture.hpp"
#include "app/calib_report_verb.hpp"
#include "tests/support/html_page.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using tests::Count;

json Lens() {
    return json::parse(R"({
        "verb": "intrinsics", "verdict": "fail", "reasons": ["tilt the board"],
        "rms_px": 0.25, "heldout_rms_px": null, "pictures": 12, "views_found": 11, "views_used": 10,
        "covered": 0.5, "most_tilt_rad": 0.7, "board": {"shape": "measured", "bulge_m": 0.002},
        "lens": {"model": "kannala_brandt4", "size_px": [1000, 500], "focal_px": [500, 501],
                 "centre_px": [499, 250], "distortion": [0.1, 0.01, 0, 0], "max_theta_rad": 1.5,
                 "sigma": [1, 2, 0.5, 0.5, 0.01, 0.01, 0.01, 0.01]},
        "coverage": [[0, 3], [5, 7]], "uncertainty": [[250, 125, 0.2], [750, 125, 3.5]],
        "residuals": [[0, 100, 100, 1, 0], [1, 200, 100, -1, 0]],
        "views": [{"name": "a.jpg", "used": true, "fate": "used", "rms_px": 0.2, "blur_px": 1},
                  {"name": "b.jpg", "used": false, "fate": "smeared", "rms_px": null}],
        "a_key_of_tomorrow": {"x": [1, {"y": 2}]}})");
}

json Unit() {
    return json::parse(R"({
        "verb": "unit", "unit": "tractor", "verdict": "pass", "sigma_px": 0.3,
        "notes": ["left does not see gate"],
        "cameras": {"front": {"position_m": [3, 0, 2], "rpy_deg": [0, 12, 0],
                              "position_sigma_m": [0.001, 0.001, 0.002],
                              "rpy_sigma_deg": [0.01, 0.01, 0.01], "rms_px": 0.2},
                    "left": {"position_m": [1, 1, 2], "rpy_deg": [0, 0, 90]}},
        "sightings": [{"camera": "front", "target": "gate", "rms_px": 0.2, "outlier": false},
                      {"camera": "left", "target": "gate", "rms_px": 4.5, "outlier": true}],
        "far": [{"cameras": ["front", "left"], "matches": 80, "before_px": 3.25, "after_px": 0.5,
                        "before_png": "before.png", "after_png": "after.png"}]})");
}

json Verify() {
    return json::parse(R"({
        "verb": "verify", "verdict": "fail",
        "checks": [{"name": "left seam", "figure": 0.4, "limit": 1, "unit": "px", "ok": true},
                   {"name": "holes", "figure": 2, "limit": 0, "ok": false, "reason": "uncovered"}],
        "pictures": [{"title": "panorama", "path": "before.png"}]})");
}

std::string Page(const json& content, const std::filesystem::path& file = "front.json") {
    return CalibReport({{file, std::string(64, 'a'), content}}, "hitchview-calib report");
}

TEST(CalibReportTest, APageIsWellFormedAndNeedsNothingElse) {
    const tests::TemporaryFolder folder;
    cv::imwrite(folder / "before.png", cv::Mat(60, 80, CV_8UC3, cv::Scalar(10, 200, 30)));
    const std::string html = CalibReport({{folder / "front.json", "aa", Lens()},
                                          {folder / "tractor.json", "bb", Unit()},
                                          {folder / "verify.json", "cc", Verify()},
                                          {folder / "other.json", "dd", {{"verb", "hitch"}}}},
                                         "hitchview-calib report");
    EXPECT_EQ(tests::Unbalanced(html), "");
    tests::ExpectSelfContained(html);
    EXPECT_EQ(Count(html, "<img"), 2);  // before.png, of the unit and of verify
    EXPECT_THAT(html, HasSubstr("after.png is no picture that can be read"));
    EXPECT_LT(html.find("tilt the board"), html.find("<section>"));
}

TEST(CalibReportTest, FiguresAreShownWithTheirIntervals) {
    const std::string lens = Page(Lens());
    EXPECT_THAT(lens, HasSubstr("<td>498.040 to 501.960</td>"));  // 500 and 1.96 times 1
    EXPECT_THAT(lens, HasSubstr("<td>smeared</td>"));
    EXPECT_EQ(Count(lens, "class=\"cell empty\""), 1);
    EXPECT_EQ(Count(lens, "class=\"cell uncertain\""), 2);
    const std::string unit = Page(Unit());
    EXPECT_THAT(unit, HasSubstr("<td>3.0000\u00a0\u00b1\u00a00.0020</td>"));
    EXPECT_THAT(unit, HasSubstr("class=\"edge poor\""));
    EXPECT_THAT(unit, HasSubstr("<td>front - left</td><td>3.25</td><td>0.5</td>"));
    EXPECT_THAT(Page(Verify()), HasSubstr("1 of 2 checks good"));
}

TEST(CalibReportTest, ResidualsAreEnlargedByTheFactorThatIsTold) {
    // 3 % of a width of 1000 px would be 30 times; drawn on 960.
    const std::string html = ResidualMap(json::parse("[[0, 100, 100, 1, 0]]"), {1000, 500});
    EXPECT_THAT(html, HasSubstr("enlarged 20 times"));
    EXPECT_THAT(html, HasSubstr("x1=\"96.0\" y1=\"96.0\" x2=\"115.2\" y2=\"96.0\""));
}

TEST(CalibReportTest, LensesOfAFolderAreAChapterEach) {
    const json all = {
        {"verb", "intrinsics"},
        {"cameras", {{"front", Lens()}, {"rear", {{"verdict", "fail"}, {"reasons", {"dark"}}}}}}};
    const std::string html = Page(all);
    EXPECT_EQ(tests::Unbalanced(html), "");
    EXPECT_THAT(html, HasSubstr("<h2>Lens of front "));
    EXPECT_THAT(html, HasSubstr("<h2>Lens of rear "));
    EXPECT_THAT(html, HasSubstr("<li>dark</li>"));
}

TEST(CalibReportTest, WhatAFileDoesNotHaveIsSaid) {
    for (const char* const verb : {"intrinsics", "unit", "verify", "another"}) {
        const std::string html = Page({{"verb", verb}});
        EXPECT_EQ(tests::Unbalanced(html), "") << verb;
        EXPECT_THAT(html, HasSubstr("not in this file")) << verb;
        EXPECT_THAT(html, HasSubstr("no verdict")) << verb;
    }
}

/// Puts a text in the place of every text, keys of maps included.
json Hostile(const json& content, const std::string& text) {
    if (content.is_string()) return text;
    if (!content.is_structured()) return content;
    json changed = content;
    for (json& item : changed) item = Hostile(item, text);
    if (content.contains("front")) changed[text] = changed["front"];
    return changed;
}

TEST(CalibReportTest, HostileTextIsText) {
    const std::string hostile = "</td><script>alert('1')</script>\" onload=\"x&\x01";
    for (json content : {Lens(), Unit(), Verify()}) {
        const json verb = content["verb"];
        content = Hostile(content, hostile);
        content["cameras"] = Hostile(content["cameras"], hostile);
        content["verb"] = verb;
        const std::string html = Page(content, "<b>.json");
        EXPECT_EQ(tests::Unbalanced(html), "");
        EXPECT_THAT(html, Not(HasSubstr("<script")));
        EXPECT_THAT(html, Not(HasSubstr("\" onload=\"")));
        EXPECT_THAT(html, Not(HasSubstr("\x01")));
        EXPECT_THAT(html, Not(HasSubstr("<b>")));
    }
}

/// Every value is replaced in turn.
void ReplaceEach(json& part, const json& by, const std::function<void()>& look) {
    const json kept = part;
    part = by;
    look();
    part = kept;
    if (!part.is_structured()) return;
    for (json& item : part) ReplaceEach(item, by, look);
}

TEST(CalibReportTest, AnyTypeAndSizeOfAnyValueGivesAPage) {
    const std::vector<json> others{nullptr,      true,           "text",          -1,
                                   1e308,        -1e-308,        json::array(),   json::object(),
                                   {{{{1, 2}}}}, {1e300, 1e300}, {0, 0, 0, 0, 0}, {"x", "y", "z"}};
    for (json content : {Lens(), Unit(), Verify()}) {
        for (const json& other : others) {
            ReplaceEach(content, other, [&] {
                const std::string html = Page(content);
                ASSERT_EQ(tests::Unbalanced(html), "") << content;
                ASSERT_THAT(html, Not(HasSubstr("=\"nan"))) << content;
                ASSERT_THAT(html, Not(HasSubstr("=\"inf"))) << content;
            });
        }
    }
}

TEST(CalibReportTest, TheVerbTellsAnOddFileFromAFolderThatCannotBeWritten) {
    const tests::TemporaryFolder folder;
    const std::string good = folder.Write("good.json", Lens().dump());
    const auto code = [&](const std::string& json_file, const std::string& out) {
        return CalibReportVerb({.json = {json_file}, .out = out, .command = "test"});
    };
    EXPECT_EQ(code(good, folder / "r.html"), 0);
    EXPECT_THAT(tests::FileText(folder / "r.html"), HasSubstr("Lens of good"));
    EXPECT_EQ(code(good, folder / "none/r.html"), 3);
    for (const std::string& text : {std::string(), std::string("[1]"), std::string("{"),
                                    std::string(1 << 20, '['), std::string("{\"a\": 1} x")}) {
        EXPECT_EQ(code(folder.Write("bad.json", text), folder / "bad.html"), 2);
    }
    EXPECT_EQ(code(folder / "absent.json", folder / "bad.html"), 2);
    EXPECT_EQ(code(folder.path(), folder / "bad.html"), 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "bad.html"));
}

}  // namespace
}  // namespace hitchview::app

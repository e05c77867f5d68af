#include <gtest/gtest.h>

#include "app/evaluation_coverage.hpp"

namespace hitchview::app {
namespace {

TEST(CoverageMeterTest, TheCommonRectangleIsCoveredInEveryFrame) {
    CoverageMeter meter;
    for (const cv::Rect shown : {cv::Rect(0, 0, 80, 100), cv::Rect(20, 10, 80, 90)}) {
        cv::Mat panorama = cv::Mat::zeros(100, 100, CV_8U);
        panorama(shown).setTo(128);
        panorama(cv::Rect(40, 40, 20, 20)).setTo(3);  // a dark spot of the scene
        meter.Append(panorama, 0);
    }
    EXPECT_NEAR(meter.frames()[0].share, 0.80, 1e-9);
    EXPECT_NEAR(meter.frames()[1].share, 0.72, 1e-9);
    EXPECT_NEAR(meter.CommonRectangleShare().value(), 0.60 * 0.90, 1e-9);
    EXPECT_FALSE(CoverageMeter().CommonRectangleShare());
}

TEST(CoverageMeterTest, TheLargestRectangleOfAStaircase) {
    cv::Mat mask = cv::Mat::zeros(6, 6, CV_8U);
    mask(cv::Rect(0, 0, 2, 6)).setTo(255);  // 12
    mask(cv::Rect(0, 2, 4, 4)).setTo(255);  // 16
    mask(cv::Rect(0, 4, 6, 2)).setTo(255);  // 12
    EXPECT_EQ(LargestRectangleArea(mask), 16);
}

}  // namespace
}  // namespace hitchview::app

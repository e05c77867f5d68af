#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "hal/result.hpp"

namespace hitchview::hal {
namespace {

TEST(ResultTest, HoldsAValueOrAnError) {
    const Result<int> value(7);
    const Result<int> error(Error::kTimeout);
    EXPECT_TRUE(value.ok());
    EXPECT_EQ(value.value(), 7);
    EXPECT_FALSE(error.ok());
    EXPECT_EQ(error.error(), Error::kTimeout);
}

TEST(ResultTest, CarriesWhatCanOnlyBeMoved) {
    Result<std::unique_ptr<int>> result(std::make_unique<int>(3));
    const std::unique_ptr<int> taken = std::move(*result);
    EXPECT_EQ(*taken, 3);
}

TEST(ResultTest, CheckedSaysWhyInWords) {
    const Checked<Done> refused(std::string("rig.yaml:3: unknown key"));
    EXPECT_EQ(refused.error(), "rig.yaml:3: unknown key");
}

TEST(ResultDeathTest, ReadingTheWrongSideStopsTheProcess) {
    const Result<int> value(7);
    const Result<int> error(Error::kFailed);
    EXPECT_DEATH((void)error.value(), "expectation failed");
    EXPECT_DEATH((void)value.error(), "expectation failed");
}

}  // namespace
}  // namespace hitchview::hal

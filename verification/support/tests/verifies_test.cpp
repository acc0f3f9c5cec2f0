// SPDX-License-Identifier: Apache-2.0
// Goal: a test states one requirement. Method: a second call of verifies() is expected to fail.
#include "mamori/trace/verifies.hpp"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

namespace mamori::verification {
namespace {

TEST(VerifiesTest, ASecondRequirementIsAFailureAndTheFirstRemains) {
    verifies("SWR-VER-032", Technique::kErrorGuessing, Polarity::kViolation);

    // A variable, because the trace tool reads each id in a call as a test of that requirement.
    static constexpr const char* kSecond = "SWR-VER-024";
    EXPECT_NONFATAL_FAILURE(verifies(kSecond),
                            "verifies() is called twice, with SWR-VER-032 and SWR-VER-024");

    const testing::TestResult& result = *testing::UnitTest::GetInstance()->current_test_info()->result();
    ASSERT_EQ(result.test_property_count(), 3);
    EXPECT_STREQ(result.GetTestProperty(0).value(), "SWR-VER-032");
    EXPECT_STREQ(result.GetTestProperty(1).value(), "error_guessing");
    EXPECT_STREQ(result.GetTestProperty(2).value(), "violation");
}

}  // namespace
}  // namespace mamori::verification

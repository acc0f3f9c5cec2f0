// SPDX-License-Identifier: Apache-2.0
// Goal: a test states one requirement. Method: a second call of verifies() is expected to fail.
#include "mamori/trace/verifies.hpp"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

namespace mamori::verification {
namespace {

TEST(VerifiesTest, ASecondRequirementIsAFailureAndTheFirstRemains) {
    verifies("SWR-VER-032", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_NONFATAL_FAILURE(verifies("SWR-VER-024"), "names SWR-VER-024, but it has named SWR-VER-032");

    EXPECT_STREQ(find_requirement(), "SWR-VER-032");
}

}  // namespace
}  // namespace mamori::verification

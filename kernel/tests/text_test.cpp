// SPDX-License-Identifier: Apache-2.0
// Goal: names are equal exactly when all their characters are. Method: names that differ in one character or
// in their length.
#include "mamori/kernel/base/text.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

TEST(TextTest, EqualNamesAreEqualAtRunTimeAndInConstantExpressions) {
    verifies("SWR-PAR-006", Technique::kEquivalenceClasses);
    static_assert(make_text("slow") == make_text("slow"));

    EXPECT_EQ(make_text("slow").size(), 4U);
    EXPECT_TRUE(make_text("slow") == make_text("slow"));
    EXPECT_TRUE(make_text("") == Text{});
}

TEST(TextTest, NamesThatDifferInACharacterOrInTheirLengthAreNotEqual) {
    verifies("SWR-PAR-006", Technique::kBoundaryValues, Polarity::kViolation);

    for (const char* other : {"", "slo", "slowe", "Slow", "slox"}) {
        EXPECT_FALSE(make_text("slow") == make_text(other)) << other;
        EXPECT_FALSE(make_text(other) == make_text("slow")) << other;
    }
}

TEST(TextTest, AMissingOrEmptyNameIsNoNameAndEqualsNone) {
    verifies("SWR-PAR-021", Technique::kBoundaryValues, Polarity::kViolation);
    static_assert(is_same_name("slow", "slow") && !is_name(nullptr));

    EXPECT_TRUE(is_name("s"));
    for (const char* missing : {static_cast<const char*>(nullptr), ""}) {
        EXPECT_FALSE(is_name(missing));
        EXPECT_FALSE(is_same_name(missing, missing));
        EXPECT_FALSE(is_same_name("slow", missing));
        EXPECT_FALSE(is_same_name(missing, "slow"));
    }
    EXPECT_FALSE(is_same_name("slow", "slo"));
}

}  // namespace
}  // namespace mamori

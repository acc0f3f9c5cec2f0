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

}  // namespace
}  // namespace mamori

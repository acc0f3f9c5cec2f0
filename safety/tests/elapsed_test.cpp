// SPDX-License-Identifier: Apache-2.0
// Goal: no instant of the 64-bit range makes a time limit pass by overflow. Method: both ends of the range.
#include "mamori/safety/base/elapsed.hpp"

#include <cstdint>
#include <limits>

#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr Instant kFirst{std::numeric_limits<std::int64_t>::min()};
constexpr Instant kLast{std::numeric_limits<std::int64_t>::max()};

TEST(ElapsedTest, IsTheDistanceForEachInstantIncludingTickZero) {
    verifies("SWR-SUP-006", Technique::kBoundaryValues);

    EXPECT_EQ(calc_elapsed(Instant{0}, Instant{0}).ns, 0);
    EXPECT_EQ(calc_elapsed(Instant{0}, Instant{5}).ns, 5);
    EXPECT_EQ(calc_elapsed(Instant{-3}, Instant{5}).ns, 8);
    EXPECT_EQ(calc_elapsed(Instant{0}, kLast).ns, kLast.ns);
    EXPECT_EQ(calc_elapsed(kLast, kLast).ns, 0);
    EXPECT_EQ(calc_elapsed(Instant{kLast.ns - 1}, kLast).ns, 1);
}

TEST(ElapsedTest, OverflowIsHeldAndABackwardClockIsNegative) {
    verifies("SWR-SUP-006", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(calc_elapsed(kFirst, kLast).ns, kLast.ns);
    EXPECT_EQ(calc_elapsed(kLast, kFirst).ns, -kLast.ns);
    EXPECT_EQ(calc_elapsed(Instant{5}, Instant{4}).ns, -1);
    EXPECT_TRUE(is_over(kFirst, kLast, Duration{1000}));
    EXPECT_TRUE(is_over(Instant{5}, Instant{4}, Duration{1000}));
}

TEST(ElapsedTest, LimitItselfIsAllowedAndOneMoreIsNot) {
    verifies("SWR-SUP-006", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_FALSE(is_over(Instant{0}, Instant{9}, Duration{10}));
    EXPECT_FALSE(is_over(Instant{0}, Instant{10}, Duration{10}));
    EXPECT_TRUE(is_over(Instant{0}, Instant{11}, Duration{10}));
}

}  // namespace
}  // namespace mamori::safety

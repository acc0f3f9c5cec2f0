// SPDX-License-Identifier: Apache-2.0
// Goal: the remainder that a processor without a 64-bit division calculates is that of the language, at both
// ends of the range and for many numbers in between.
#include "mamori/kernel/base/remainder.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "mamori/trace/verifies.hpp"

namespace mamori::detail {
namespace {

using namespace verification;

constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();

TEST(RemainderTest, BitByBitEqualsTheOperatorOfTheLanguage) {
    verifies("SWR-KRN-072", Technique::kBackToBack);
    std::uint64_t state = 1U;
    const auto draw = [&state]() {
        state = state * 6364136223846793005U + 1442695040888963407U;
        return state >> (1U + state % 60U);
    };
    for (int i = 0; i < 10000; ++i) {
        const std::uint64_t dividend = draw();
        const std::uint64_t divisor = draw() + 1U;
        ASSERT_EQ(calc_remainder_bit_by_bit(dividend, divisor), dividend % divisor)
            << dividend << " % " << divisor;
    }
}

TEST(RemainderTest, BitByBitIsExactAtBothEnds) {
    verifies("SWR-KRN-072", Technique::kBoundaryValues);
    constexpr auto kTop = static_cast<std::uint64_t>(kMax);
    EXPECT_EQ(calc_remainder_bit_by_bit(0U, 1U), 0U);
    EXPECT_EQ(calc_remainder_bit_by_bit(0U, kTop), 0U);
    EXPECT_EQ(calc_remainder_bit_by_bit(kTop, 1U), 0U);
    EXPECT_EQ(calc_remainder_bit_by_bit(kTop, kTop), 0U);
    EXPECT_EQ(calc_remainder_bit_by_bit(kTop - 1U, kTop), kTop - 1U);
    EXPECT_EQ(calc_remainder_bit_by_bit(kTop, kTop - 1U), 1U);
}

TEST(RemainderTest, RemainderIsThatOfThisProcessor) {
    verifies("SWR-KRN-072", Technique::kBoundaryValues);
    EXPECT_EQ(calc_remainder(kMax, 10), 7);
    EXPECT_EQ(calc_remainder(9, 10), 9);
    EXPECT_EQ(calc_remainder(10, 10), 0);
}

}  // namespace
}  // namespace mamori::detail

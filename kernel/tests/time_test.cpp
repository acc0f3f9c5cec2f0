// SPDX-License-Identifier: Apache-2.0
// Goal: time is exact in nanoseconds, and durations and instants cannot be mixed.
// Method: arithmetic at both signs and at the limits; the forbidden mixtures are asked of the compiler.
#include "mamori/kernel/base/time.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <type_traits>
#include <utility>

#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

template <typename A, typename B, typename = void>
struct CanAdd : std::false_type {};
template <typename A, typename B>
struct CanAdd<A, B, std::void_t<decltype(std::declval<A>() + std::declval<B>())>> : std::true_type {};

template <typename A, typename B, typename = void>
struct CanCompare : std::false_type {};
template <typename A, typename B>
struct CanCompare<A, B, std::void_t<decltype(std::declval<A>() < std::declval<B>())>> : std::true_type {};

TEST(TimeTest, LiteralsAreNanoseconds) {
    verifies("SWR-KRN-004");

    EXPECT_EQ((1_ns).ns, 1);
    EXPECT_EQ((2_us).ns, 2000);
    EXPECT_EQ((3_ms).ns, 3000000);
    EXPECT_EQ((4_s).ns, 4000000000);
}

TEST(TimeTest, ArithmeticIsExactAndSigned) {
    verifies("SWR-KRN-004");

    EXPECT_EQ(1_ms + 1_ns, Duration{1000001});
    EXPECT_EQ(1_ns - 1_ms, Duration{-999999});
    EXPECT_EQ(1_ms * 1000, 1_s);
    EXPECT_EQ((Instant{5} + 7_ns) - Instant{5}, 7_ns);
    EXPECT_EQ(Instant{5} - 7_ns, Instant{-2});
}

TEST(TimeTest, ComparisonsTellOneNanosecondApart) {
    verifies("SWR-KRN-004", Technique::kBoundaryValues);

    EXPECT_TRUE(1_ns < 2_ns && 1_ns <= 1_ns && 2_ns > 1_ns && 2_ns >= 2_ns && 1_ns != 2_ns);
    EXPECT_FALSE(2_ns < 2_ns || 2_ns > 2_ns || 1_ns >= 2_ns || 2_ns <= 1_ns);
    EXPECT_TRUE(Instant{1} < Instant{2} && Instant{1} <= Instant{1} && Instant{2} > Instant{1});
    EXPECT_TRUE(Instant{2} >= Instant{2} && Instant{1} != Instant{2} && Instant{1} == Instant{1});
    EXPECT_FALSE(Instant{2} < Instant{2} || Instant{2} > Instant{2} || Instant{1} >= Instant{2});
}

TEST(TimeTest, SecondsAreExactWhereADoubleIs) {
    verifies("SWR-KRN-004", Technique::kEquivalenceClasses);

    EXPECT_DOUBLE_EQ(to_seconds(1_ms), 1.0e-3);
    EXPECT_DOUBLE_EQ(to_seconds(Duration{-2500000000}), -2.5);
    EXPECT_DOUBLE_EQ(to_seconds(Duration{}), 0.0);
}

TEST(TimeTest, TheRangeIsThatOfASigned64BitCount) {
    verifies("SWR-KRN-004", Technique::kBoundaryValues);
    constexpr Duration kLongest{std::numeric_limits<std::int64_t>::max()};
    constexpr Duration kShortest{std::numeric_limits<std::int64_t>::min()};

    EXPECT_LT(kShortest, kLongest);
    EXPECT_EQ(kLongest - 1_ns + 1_ns, kLongest);
}

TEST(TimeTest, InstantsAndDurationsAndNumbersDoNotMix) {
    verifies("SWR-KRN-004", Technique::kErrorGuessing, Polarity::kViolation);

    static_assert(CanAdd<Instant, Duration>::value && CanAdd<Duration, Duration>::value);
    static_assert(!CanAdd<Instant, Instant>::value, "a sum of two instants has no meaning");
    static_assert(!CanAdd<Duration, int>::value && !CanAdd<Instant, int>::value, "a number has no unit");
    static_assert(!CanCompare<Instant, Duration>::value && CanCompare<Instant, Instant>::value);
    static_assert(!std::is_convertible_v<Duration, Instant> && !std::is_convertible_v<Instant, Duration>);
    SUCCEED();
}

}  // namespace
}  // namespace mamori

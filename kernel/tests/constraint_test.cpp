// SPDX-License-Identifier: Apache-2.0
// Goal: every constraint admits the values that it names and no other value. Method: values on both sides of
// each limit, for each kind of limit and type; declarations that the compiler did not see. Those that it
// rejects: parameter_compile_fail_test.cpp.
#include "mamori/kernel/parameter/constraint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

enum class Mode : std::uint8_t { kOff, kSlow, kFast };

constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
double step_up(double value) {
    return std::nextafter(value, kInfinity);
}
double step_down(double value) {
    return std::nextafter(value, -kInfinity);
}

template <typename S, typename C>
void expect_admits(const C& part, const std::vector<S>& admitted, const std::vector<S>& rejected) {
    const auto constraint = make_constraint<S, 6U, 1U>(part);
    for (const S value : admitted) {
        EXPECT_TRUE(constraint.admits(value, 0U)) << static_cast<double>(value);
    }
    for (const S value : rejected) {
        EXPECT_FALSE(constraint.admits(value, 0U)) << static_cast<double>(value);
    }
}

TEST(ConstraintTest, WithoutAConstraintEveryFiniteValueIsAdmitted) {
    verifies("SWR-PAR-003", Technique::kBoundaryValues);
    const auto none = make_constraint<double, 1U, 1U>();

    EXPECT_TRUE(none.admits(-kMax, 0U) && none.admits(0.0, 0U) && none.admits(kMax, 0U));
    EXPECT_FALSE(none.admits(kInfinity, 0U) || none.admits(-kInfinity, 0U) || none.admits(kNan, 0U));
    expect_admits<double>(any_value(), {0.0, -kMax, kMax}, {kInfinity, -kInfinity, kNan});
    expect_admits<std::int8_t>(any_value(), {-128, 127}, {});
    expect_admits<bool>(any_value(), {false, true}, {});
}

TEST(ConstraintTest, ALimitIsMetOnItsSideOnly) {
    verifies("SWR-PAR-003", Technique::kBoundaryValues);
    const double limit = 0.1;
    const double up = step_up(limit);
    const double down = step_down(limit);

    expect_admits<double>(at_least(limit), {limit, up, kMax}, {down, -kMax, kNan, kInfinity});
    expect_admits<double>(above(limit), {up, kMax}, {limit, down, kNan, kInfinity});
    expect_admits<double>(at_most(limit), {limit, down, -kMax}, {up, kMax, kNan, -kInfinity});
    expect_admits<double>(below(limit), {down, -kMax}, {limit, up, kNan, -kInfinity});
}

TEST(ConstraintTest, RangesHaveOpenAndClosedSides) {
    verifies("SWR-PAR-003", Technique::kBoundaryValues);

    expect_admits<int>(between(100, 200), {100, 150, 200}, {99, 201});
    expect_admits<int>(between(above(100), below(200)), {101, 199}, {100, 200});
    expect_admits<int>(between(at_least(100), below(200)), {100, 199}, {99, 200});
    expect_admits<int>(between(above(100), at_most(200)), {101, 200}, {100, 201});
    expect_admits<double>(between(above(-0.5), at_most(0.5)), {step_up(-0.5), 0.5},
                          {-0.5, step_up(0.5), kNan});
    expect_admits<double>(between(3.0, 3.0), {3.0}, {step_down(3.0), step_up(3.0)});
    expect_admits<float>(between(0.1F, 0.7F), {0.1F, 0.7F},
                         {std::nextafter(0.1F, 0.0F), std::nextafter(0.7F, 1.0F)});
}

TEST(ConstraintTest, LimitsOfIntegersReachTheEndsOfTheType) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues);
    constexpr std::uint64_t kMaxUnsigned = std::numeric_limits<std::uint64_t>::max();
    constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();

    expect_admits<std::uint64_t>(above(kMaxUnsigned - 1U), {kMaxUnsigned}, {kMaxUnsigned - 1U});
    expect_admits<std::int64_t>(at_most(kLowest), {kLowest}, {kLowest + 1});
    expect_admits<std::uint8_t>(between(0, 255), {0U, 255U}, {});
    expect_admits<std::int8_t>(between(-128LL, 127LL), {-128, 127}, {});
}

TEST(ConstraintTest, ChoicesAdmitTheirValues) {
    verifies("SWR-PAR-003", Technique::kEquivalenceClasses);

    expect_admits<int>(one_of(9600, 19200), {9600, 19200}, {9599, 9601, 19199, 19201, 0});
    expect_admits<int>(one_of(7), {7}, {6, 8});
    expect_admits<int>(one_of(1, 2, 1), {1, 2}, {3});
    expect_admits<double>(one_of(0.1, 0.5, 1.0e3), {0.1, 0.5, 1000.0}, {step_up(0.1), 0.3, kNan});
    expect_admits<Mode>(one_of(Mode::kSlow, Mode::kFast), {Mode::kSlow, Mode::kFast},
                        {Mode::kOff, static_cast<Mode>(9)});
    expect_admits<bool>(one_of(true), {true}, {false});
}

TEST(ConstraintTest, ASingleConstraintHoldsForEachElementAndAListElementByElement) {
    verifies("SWR-PAR-003", Technique::kEquivalenceClasses);
    const auto single = make_constraint<double, 2U, 3U>(one_of(1.0, 2.0));
    const auto list = make_constraint<double, 4U, 3U>(at_least(0.0), any_value(), one_of(1.0, 2.0));

    for (std::size_t element = 0U; element < 3U; ++element) {
        EXPECT_TRUE(single.admits(1.0, element) && single.admits(2.0, element));
        EXPECT_FALSE(single.admits(0.0, element));
    }
    EXPECT_TRUE(list.admits(5.0, 0U) && list.admits(-9.0, 1U) && list.admits(2.0, 2U));
    EXPECT_FALSE(list.admits(-1.0, 0U) || list.admits(kNan, 1U) || list.admits(5.0, 2U));
    EXPECT_EQ(list.get_ranges().size(), 4U);
}

TEST(ConstraintTest, AConstraintIsMadeInAConstantExpression) {
    verifies("SWR-PAR-004", Technique::kInterface);
    static constexpr auto kConstraint = make_constraint<double, 1U, 1U>(between(0.1, 3.0));
    static_assert(kConstraint.admits(0.1, 0U) && !kConstraint.admits(0.05, 0U));

    EXPECT_EQ(kConstraint.get_ranges().size(), 1U);
}

template <typename S, typename L>
bool has_value_between(L lower, L upper) {
    Range<S> range{};
    range.lower = lower;
    range.upper = upper;
    range.is_lower_open = true;
    range.is_upper_open = true;
    return detail::has_value(range);
}

TEST(ConstraintTest, AnOpenRangeOfIntegersNeedsAnIntegerBetweenItsLimits) {
    verifies("SWR-PAR-004", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::int64_t kTop = std::numeric_limits<std::int64_t>::max();
    constexpr std::int64_t kLow = std::numeric_limits<std::int64_t>::min();

    EXPECT_FALSE(has_value_between<std::int32_t>(0, 1));
    EXPECT_TRUE(has_value_between<std::int32_t>(0, 2));
    EXPECT_TRUE(has_value_between<std::int32_t>(-1, 1));
    EXPECT_FALSE(has_value_between<bool>(false, true));
    EXPECT_FALSE(has_value_between<std::int64_t>(kTop - 1, kTop));
    EXPECT_FALSE(has_value_between<std::int64_t>(kLow, kLow + 1));
    EXPECT_TRUE(has_value_between<std::int64_t>(kLow, kTop));
    EXPECT_TRUE(has_value_between<double>(0.0, 1.0));
    for (const bool is_lower_open : {false, true}) {
        const Range<int> half_open{0, 1, 0U, is_lower_open, !is_lower_open};
        EXPECT_TRUE(detail::has_value(half_open));
    }
}

template <typename S, typename C>
void expect_no_value(const C& part) {
    const auto sut = make_constraint<S, 1U, 1U>(part);

    EXPECT_TRUE(sut.get_ranges().empty());
    for (const S value : {Range<S>::kLowest, S{}, static_cast<S>(1), Range<S>::kMax}) {
        EXPECT_FALSE(sut.admits(value, 0U));
    }
}

TEST(ConstraintTest, ARangeWithoutAnyValueMakesAConstraintThatAdmitsNothing) {
    verifies("SWR-PAR-011", Technique::kBoundaryValues, Polarity::kViolation);

    expect_no_value<double>(between(10.0, 1.0));
    expect_no_value<double>(between(step_up(1.0), 1.0));
    expect_no_value<double>(between(above(1.0), at_most(1.0)));
    expect_no_value<double>(between(at_least(1.0), below(1.0)));
    expect_no_value<double>(between(above(-0.0), below(0.0)));
    expect_no_value<double>(between(kNan, 1.0));
    expect_no_value<double>(at_most(kInfinity));
    expect_no_value<std::uint8_t>(below(0));
    expect_no_value<std::uint8_t>(above(255));
    expect_no_value<std::uint8_t>(at_most(256));
}

TEST(ConstraintTest, OneInvalidPartMakesTheWholeConstraintAdmitNothing) {
    verifies("SWR-PAR-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    const auto sut = make_constraint<double, 2U, 2U>(any_value(), between(2.0, 1.0));

    EXPECT_FALSE(sut.admits(0.0, 0U));
    EXPECT_FALSE((make_constraint<int, 2U, 1U>(one_of(1LL, 2147483648LL)).admits(1, 0U)));
    EXPECT_TRUE((make_constraint<int, 2U, 1U>(one_of(1LL, 2147483647LL)).admits(1, 0U)));
}

}  // namespace
}  // namespace mamori

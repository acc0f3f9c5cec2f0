// SPDX-License-Identifier: Apache-2.0
// Goal: a value without its type becomes exactly the value that its type has for it, or is rejected.
// Method: both sides of each limit of the types.
#include "mamori/kernel/parameter/scalar.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "mamori/kernel/base/status.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

template <typename S>
void expect_round_trip(S value) {
    const Result<S> back = from_scalar<S>(to_scalar(value));
    EXPECT_TRUE(back.has_value());
    EXPECT_EQ(back.get_value(), value);
}
enum class Gear : std::int16_t { kReverse = -1, kNeutral, kFirst };

TEST(ScalarTest, EveryValueIsRestoredUnchanged) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues);

    expect_round_trip(true);
    expect_round_trip(Gear::kReverse);
    expect_round_trip(0.1F);
    expect_round_trip(-0.1);
    expect_round_trip(std::numeric_limits<std::int64_t>::min());
    expect_round_trip(std::numeric_limits<std::uint64_t>::max());
    expect_round_trip(std::numeric_limits<std::int8_t>::min());
    expect_round_trip(std::numeric_limits<double>::denorm_min());
}

TEST(ScalarTest, AValueThatTheTypeDoesNotHaveIsRejected) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();

    EXPECT_FALSE(from_scalar<std::int8_t>(to_scalar(128)).has_value());
    EXPECT_FALSE(from_scalar<std::int8_t>(to_scalar(-129)).has_value());
    EXPECT_FALSE(from_scalar<std::uint8_t>(to_scalar(-1)).has_value());
    EXPECT_FALSE(from_scalar<std::int64_t>(to_scalar(std::uint64_t{1} << 63U)).has_value());
    EXPECT_FALSE(from_scalar<bool>(to_scalar(2)).has_value());
    EXPECT_FALSE(from_scalar<float>(to_scalar(0.1)).has_value()) << "float has no 0.1 of double";
    EXPECT_FALSE(from_scalar<float>(to_scalar(1e39)).has_value());
    EXPECT_FALSE(from_scalar<double>(to_scalar(kNan)).has_value());
    EXPECT_FALSE(from_scalar<double>(to_scalar(kInfinity)).has_value());
    EXPECT_FALSE(from_scalar<double>(to_scalar(1)).has_value()) << "an integer is not a real number";
    EXPECT_FALSE(from_scalar<int>(to_scalar(1.0)).has_value()) << "nor is a real number an integer";
    EXPECT_EQ(from_scalar<int>(Scalar{0.0, {0U, true}, false}).get_value(), 0) << "minus zero is zero";
}

TEST(ScalarTest, AnIntegerKeepsItsSignAndZeroHasNone) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues);

    EXPECT_EQ(from_whole<std::int8_t>({0U, true}).get_value(), 0);
    EXPECT_EQ(from_whole<std::int8_t>({1U, true}).get_value(), -1);
    EXPECT_EQ(from_whole<std::int8_t>({1U, false}).get_value(), 1);
    EXPECT_EQ(from_whole<std::int8_t>({127U, false}).get_value(), 127);
    EXPECT_EQ(from_whole<std::int8_t>({128U, true}).get_value(), -128);
    EXPECT_TRUE(from_whole<std::uint8_t>({0U, true}).has_value());
    EXPECT_EQ(from_whole<std::uint8_t>({1U, true}).get_status(), Status::kBadParameter);
}

TEST(ScalarTest, ARealNumberThatFloatWouldRoundIsRejected) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues, Polarity::kViolation);

    for (const double inexact : {0.1, 0.7}) {
        EXPECT_EQ(from_scalar<float>(to_scalar(inexact)).get_status(), Status::kBadParameter) << inexact;
        EXPECT_EQ(from_scalar<float>(to_scalar(-inexact)).get_status(), Status::kBadParameter) << inexact;
    }
    EXPECT_EQ(from_scalar<float>(to_scalar(0.5)).get_value(), 0.5F);
}

TEST(ScalarTest, TypesOfScalarsAreBoolNumbersAndEnumerations) {
    verifies("SWR-PAR-002", Technique::kInterface);

    EXPECT_TRUE(is_scalar<bool>());
    EXPECT_TRUE(is_scalar<Status>());
    EXPECT_TRUE(is_scalar<float>());
    EXPECT_FALSE(is_scalar<long double>());
    EXPECT_FALSE(is_scalar<const char*>());
}

}  // namespace
}  // namespace mamori

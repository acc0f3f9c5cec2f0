// SPDX-License-Identifier: Apache-2.0
// Goal: a decimal number becomes exactly the value that its type has for it, or is refused.
// Method: limits and ties by hand; back to back with the C library over many numbers of a fixed seed. The
// fuzz harness constraint_parse_fuzz.cpp does the same with any text.
#include "mamori/kernel/parameter/detail/decimal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "mamori/kernel/parameter/scalar.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

constexpr Result<Decimal> read(const char* text) {
    TextCursor cursor{make_text(text)};
    const Result<Decimal> decimal = take_decimal(cursor);
    return decimal.has_value() && !cursor.is_at_end() ? Result<Decimal>{Status::kBadParameter} : decimal;
}
template <typename S>
constexpr Result<S> convert(const char* text) {
    const Result<Decimal> decimal = read(text);
    return decimal.has_value() ? from_decimal<S>(decimal.get_value()) : Result<S>{decimal.get_status()};
}
template <typename S>
void expect_value(const char* text, S expected) {
    const Result<S> value = convert<S>(text);
    EXPECT_TRUE(value.has_value()) << text;
    EXPECT_EQ(value.get_value(), expected) << text;
}
template <typename S>
void expect_refused(const std::vector<const char*>& texts) {
    for (const char* text : texts) {
        EXPECT_EQ(convert<S>(text).get_status(), Status::kBadParameter) << text;
    }
}

TEST(DecimalTest, EveryNotationIsReadInAConstantExpressionToo) {
    verifies("SWR-PAR-002", Technique::kEquivalenceClasses);
    static_assert(convert<double>("0.1").get_value() == 0.1);
    static_assert(convert<float>("-3.0e2").get_value() == -300.0F);
    static_assert(convert<std::int8_t>("-128").get_value() == -128);

    expect_value("12", 12.0);
    expect_value("+12", 12.0);
    expect_value(".5", 0.5);
    expect_value("5.", 5.0);
    expect_value("1e3", 1000.0);
    expect_value("1E+3", 1000.0);
    expect_value("1500e-3", 1.5);
    expect_value("0e999999999999", 0.0);
    expect_value("000000000000000000000000000001", 1.0);
}

TEST(DecimalTest, WhatIsNoNumberIsRefused) {
    verifies("SWR-PAR-002", Technique::kErrorGuessing, Polarity::kViolation);

    expect_refused<double>(
        {"", "+", "-", ".", "-.", "e3", "1e", "1e+", "1.2.3", "--1", "1 2", "0x10", "inf", "nan", "1,5"});
}

TEST(DecimalTest, DigitsBeyond64BitsAreRefusedUnlessTheyAreZeros) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues, Polarity::kViolation);

    expect_value("18446744073709551615", std::numeric_limits<std::uint64_t>::max());
    expect_value("1.8446744073709551615", 1.8446744073709551615);
    expect_value("0.1000000000000000000000000000000", 0.1);
    expect_value("100000000000000000000000000000000", 1e32);
    EXPECT_EQ(convert<double>("18446744073709551616").get_status(), Status::kUnsupported);
    EXPECT_EQ(convert<double>("0.10000000000000000000000000000001").get_status(), Status::kUnsupported);
}

TEST(DecimalTest, RealNumbersAreTheNearestOnesAndTiesGoToTheEvenOne) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues);

    expect_value("9007199254740993", 9007199254740992.0);
    expect_value("9007199254740995", 9007199254740996.0);
    expect_value("9007199254740993.001", 9007199254740994.0);
    expect_value("16777217", 16777216.0F);
    expect_value("16777219", 16777220.0F);
    expect_value("0.3", 0.3F);
    expect_value("2.2250738585072011e-308",
                 2.2250738585072011e-308);  // largest subnormal, once a famous hang
    expect_value("1.7976931348623157e308", std::numeric_limits<double>::max());
    expect_value("1.7976931348623158e308", std::numeric_limits<double>::max());
    expect_value("3.4028235e38", std::numeric_limits<float>::max());
    expect_value("4.9e-324", std::numeric_limits<double>::denorm_min());
    expect_value("2.4703282292062328e-324", std::numeric_limits<double>::denorm_min());
    expect_value("1.4e-45", std::numeric_limits<float>::denorm_min());
    EXPECT_TRUE(std::signbit(convert<double>("-0").get_value()));
}

TEST(DecimalTest, RealNumbersThatWouldBecomeInfiniteOrZeroAreRefused) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues, Polarity::kViolation);

    expect_refused<double>({"1.7976931348623159e308", "-1.7976931348623159e308", "1e309", "1e311", "1e99999",
                            "2.4703282292062327e-324", "1e-324", "1e-401", "1e-99999"});
    expect_refused<float>({"3.4028236e38", "1e39", "7e-46", "-7e-46"});
}

TEST(DecimalTest, AnExponentIsJudgedTogetherWithTheZerosBeforeIt) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues);
    const std::string zeros(95'000U, '0');

    expect_value(("0." + zeros + "1e95001").c_str(), 1.0);
    expect_value(("1" + zeros + "e-95000").c_str(), 1.0);
}

TEST(DecimalTest, WholeNumbersAreExactOrRefused) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues, Polarity::kViolation);

    expect_value<std::int8_t>("127", 127);
    expect_value<std::uint8_t>("255", 255U);
    expect_value<std::int64_t>("-9223372036854775808", std::numeric_limits<std::int64_t>::min());
    expect_value<std::int32_t>("1e3", 1000);
    expect_value<std::int32_t>("10.0", 10);
    expect_value<std::int32_t>("-0", 0);
    expect_value<std::uint8_t>("-0.0", 0U);
    expect_value<bool>("1", true);
    expect_value<std::uint64_t>("1844674407370955161e1", 18446744073709551610U);
    expect_refused<std::uint64_t>({"1844674407370955162e1"});
    expect_refused<std::int8_t>({"128", "-129", "0.5", "1e-1", "1e30"});
    expect_refused<std::uint8_t>({"256", "-1"});
    expect_refused<std::int64_t>({"9223372036854775808", "-9223372036854775809"});
    expect_refused<std::uint64_t>({"18446744073709551615e1", "-1"});
    expect_refused<bool>({"2", "-1", "0.5"});
}

TEST(DecimalTest, RealNumbersEqualThoseOfTheCLibrary) {
    verifies("SWR-PAR-002", Technique::kBackToBack);
    std::mt19937_64 random{20240229U};

    for (int i = 0; i < 20000; ++i) {
        std::uint64_t digits = random();
        for (std::uint64_t drop = random() % 20U; drop > 0U; --drop) {
            digits /= 10U;
        }
        const int exponent = static_cast<int>(random() % (i % 2 == 0 ? 700U : 60U)) - (i % 2 == 0 ? 370 : 40);
        const std::string text = std::to_string(digits) + "e" + std::to_string(exponent);
        const double expected = std::strtod(text.c_str(), nullptr);
        const float expected_float = std::strtof(text.c_str(), nullptr);
        const Result<double> real = convert<double>(text.c_str());
        const Result<float> real_float = convert<float>(text.c_str());

        const auto is_representable = [digits](auto value) {
            return std::isfinite(value) && (digits == 0U || value > 0);
        };
        ASSERT_EQ(real.has_value(), is_representable(expected)) << text;
        ASSERT_EQ(real_float.has_value(), is_representable(expected_float)) << text;
        ASSERT_TRUE(!real.has_value() || real.get_value() == expected) << text;
        ASSERT_TRUE(!real_float.has_value() || real_float.get_value() == expected_float) << text;
    }
}

// Values without their type.

template <typename S>
void expect_round_trip(S value) {
    const Result<S> back = from_scalar<S>(to_scalar(value));
    EXPECT_TRUE(back.has_value());
    EXPECT_EQ(back.get_value(), value);
}
enum class Gear : std::int16_t { kReverse = -1, kNeutral, kFirst };

TEST(ScalarTest, EveryValueComesBackAsItWas) {
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

TEST(ScalarTest, AValueThatTheTypeDoesNotHaveIsRefused) {
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
    EXPECT_FALSE(from_scalar<double>(to_scalar(1)).has_value()) << "a whole number is no real one";
    EXPECT_FALSE(from_scalar<int>(to_scalar(1.0)).has_value()) << "nor the other way round";
    EXPECT_EQ(from_scalar<int>(Scalar{0.0, {0U, true}, false}).get_value(), 0) << "minus zero is zero";
}

}  // namespace
}  // namespace mamori

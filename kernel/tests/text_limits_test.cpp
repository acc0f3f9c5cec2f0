// SPDX-License-Identifier: Apache-2.0
// Goal: texts of numbers, names and constraints are judged alike at both ends of each range of characters,
// digits, exponents and elements, and a malformed constraint ends the program whatever its rule is.
// Method: values beside each limit, all of them read while the program runs.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mamori/kernel/parameter/parameter.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori {
namespace {

using namespace verification;

Text make_view_of(const std::string& text) {
    return {text.data(), text.size()};
}
template <typename S>
Result<S> read(const std::string& text) {
    TextCursor cursor{make_view_of(text)};
    return take_value<S>(cursor);
}

TEST(TextLimitsTest, AWordEndsBeforeTheFirstCharacterThatIsNoLetterDigitOrUnderscore) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues, Polarity::kViolation);

    for (const char inside : std::string{"09azAZ_"}) {
        const std::string text = std::string{inside} + " ";
        EXPECT_EQ(TextCursor{make_view_of(text)}.take_word().size(), 1U) << text;
    }
    for (const char outside : std::string{"/:@[^`{"}) {
        const std::string text = std::string{outside} + "a";
        EXPECT_EQ(TextCursor{make_view_of(text)}.take_word().size(), 0U) << text;
    }
}

TEST(TextLimitsTest, NamesOfABoolAreTrueAndFalse) {
    verifies("SWR-PAR-002", Technique::kEquivalenceClasses, Polarity::kViolation);

    EXPECT_TRUE(from_name<bool>(make_view_of("true")).get_value());
    EXPECT_TRUE(from_name<bool>(make_view_of("false")).has_value());
    EXPECT_FALSE(from_name<bool>(make_view_of("false")).get_value());
    for (const char* other : {"", "tru", "True", "falsey", "1"}) {
        EXPECT_EQ(from_name<bool>(make_view_of(other)).get_status(), Status::kBadParameter) << other;
    }
}

TEST(TextLimitsTest, LostDigitsAreNotForgottenWhenZerosFollow) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues, Polarity::kViolation);
    const std::string full = "18446744073709551615";

    EXPECT_TRUE(read<double>(full + "00").has_value());
    EXPECT_EQ(read<double>(full + "01").get_status(), Status::kUnsupported);
    EXPECT_EQ(read<double>(full + "10").get_status(), Status::kUnsupported);
    EXPECT_EQ(read<double>(full + "11").get_status(), Status::kUnsupported);
}

TEST(TextLimitsTest, MoreDigitsThanAnExponentCanCountStayOutOfRange) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues, Polarity::kViolation);
    const std::string zeros(static_cast<std::size_t>(detail::kExponentLimit) + 10U, '0');

    EXPECT_EQ(read<double>("0." + zeros).get_value(), 0.0);
    EXPECT_EQ(read<double>("0." + zeros + "1").get_status(), Status::kBadParameter);
    EXPECT_EQ(read<double>("18446744073709551615" + zeros).get_status(), Status::kBadParameter);
}

TEST(TextLimitsTest, AZeroHasNoSignAndNoFractionWhateverItsExponentIs) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues);

    for (const char* zero : {"0", "-0", "0.00", "-0.00", "0e-5", "0e5", "-0e99999"}) {
        EXPECT_TRUE(read<std::int8_t>(zero).has_value()) << zero;
        EXPECT_EQ(read<std::int8_t>(zero).get_value(), 0) << zero;
        EXPECT_TRUE(read<std::uint8_t>(zero).has_value()) << zero;
    }
    EXPECT_EQ(read<std::int8_t>("-1").get_value(), -1);
    EXPECT_EQ(read<std::int8_t>("-100e-2").get_value(), -1);
    EXPECT_EQ(from_whole<std::int8_t>({0U, true}).get_value(), 0);
    EXPECT_EQ(from_whole<std::int8_t>({1U, true}).get_value(), -1);
    EXPECT_EQ(from_whole<std::int8_t>({1U, false}).get_value(), 1);
    EXPECT_TRUE(from_whole<std::uint8_t>({0U, true}).has_value());
    EXPECT_EQ(from_whole<std::uint8_t>({1U, true}).get_status(), Status::kBadParameter);
}

TEST(TextLimitsTest, ARealNumberThatFloatRoundsUpOrDownIsRefused) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues, Polarity::kViolation);

    for (const double inexact : {0.1, 0.7}) {
        EXPECT_EQ(from_scalar<float>(to_scalar(inexact)).get_status(), Status::kBadParameter) << inexact;
        EXPECT_EQ(from_scalar<float>(to_scalar(-inexact)).get_status(), Status::kBadParameter) << inexact;
    }
    EXPECT_EQ(from_scalar<float>(to_scalar(0.5)).get_value(), 0.5F);
}

TEST(TextLimitsTest, ATypeOfScalarsIsToldWhileRunningToo) {
    verifies("SWR-PAR-002", Technique::kInterface);

    EXPECT_TRUE(is_scalar<bool>());
    EXPECT_TRUE(is_scalar<Status>());
    EXPECT_TRUE(is_scalar<float>());
    EXPECT_FALSE(is_scalar<long double>());
    EXPECT_FALSE(is_scalar<const char*>());
}

TEST(TextLimitsTest, AnEntryBeyondTheRoomForRangesIsNamed) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues, Polarity::kViolation);
    const auto parse = [](const std::string& text) {
        return parse_constraint<double, 2U>(make_view_of(text), 3U).finding;
    };

    EXPECT_EQ(parse("{a:1,b:2,c:3}").rule, ConstraintRule::kTooManyRanges);
    EXPECT_EQ(parse("{a:1,b:2,c:3}").position, 11U);
    EXPECT_EQ(parse("{a:1,b:2,b:3}").rule, ConstraintRule::kKeyTwice);
    EXPECT_EQ(parse("{a:1,b:2}").rule, ConstraintRule::kElementCount);
}

TEST(TextLimitsDeathTest, AMalformedConstraintEndsInTheHandlerWhateverRuleItBreaks) {
    verifies("SWR-PAR-004", Technique::kErrorGuessing, Polarity::kViolation);
    using Sut = Parameter<double, 4U>;
    const std::vector<std::pair<ConstraintRule, const char*>> cases{
        {ConstraintRule::kNumberExpected, "abc"},
        {ConstraintRule::kTooManyDigits, "123456789012345678901"},
        {ConstraintRule::kNotInType, "x<1e309"},
        {ConstraintRule::kNameUnknown, "(fast)"},
        {ConstraintRule::kVariableExpected, "0<"},
        {ConstraintRule::kComparisonExpected, "x"},
        {ConstraintRule::kDirectionsDiffer, "1<x>0"},
        {ConstraintRule::kRangeEmpty, "10<x<1"},
        {ConstraintRule::kKeyExpected, "{}"},
        {ConstraintRule::kKeyTwice, "{a:1, a:2}"},
        {ConstraintRule::kColonExpected, "{a 1}"},
        {ConstraintRule::kBracketExpected, "(1"},
        {ConstraintRule::kTextBeyondEnd, "10a"},
        {ConstraintRule::kElementCount, "1,2"},
        {ConstraintRule::kTooManyRanges, "(1,2,3,4,5)"},
    };
    EXPECT_EQ(cases.size() + 1U, detail::kConstraintRuleCount) << "all but kNone";

    for (const auto& [rule, text] : cases) {
        EXPECT_EQ((parse_constraint<double, 4U>(make_text(text)).finding.rule), rule) << text;
        EXPECT_CHECK_FAILS(static_cast<void>(Sut("p", 1.0, text)), "constraint_refusal.hpp", 1) << text;
    }
}

TEST(TextLimitsDeathTest, ANumberBeyondTheRoomOfTheArithmeticIsAnOwnBug) {
    verifies("SWR-PAR-002", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::int32_t kRoom = 1536;  // bits of a BigNatural
    detail::BigNatural largest{1U};
    largest.shift_left(kRoom - 1);

    EXPECT_EQ(largest.calc_bit_length(), kRoom);
    EXPECT_CHECK_FAILS(detail::BigNatural{1U}.shift_left(kRoom), "big_natural.hpp", 1);
    EXPECT_CHECK_FAILS(largest.shift_left(1), "big_natural.hpp", 2);
    EXPECT_CHECK_FAILS(largest.multiply_by_power_of_ten(1), "big_natural.hpp", 2);
}

}  // namespace
}  // namespace mamori

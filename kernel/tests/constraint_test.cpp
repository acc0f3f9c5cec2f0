// SPDX-License-Identifier: Apache-2.0
// Goal: every form of the grammar admits what it says and nothing else, and every other text is refused with
// the first wrong character. Method: tables of texts, with values on both sides of each limit. The forms are
// those that RTSystemEditor reads; where it accepts half of a broken text, this parser refuses the whole.
#include "mamori/kernel/parameter/constraint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "mamori/kernel/parameter/constraint_parser.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

enum class Mode : std::uint8_t { kOff, kSlow, kFast };
constexpr const char* get_name(Mode mode) noexcept {
    switch (mode) {
        case Mode::kOff:
            return "off";
        case Mode::kSlow:
            return "slow";
        case Mode::kFast:
            return "fast";
    }
    return "invalid";
}
enum class Unnamed : std::int8_t { kFirst = -1 };

constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Smallest step from `value` on, up or down.
double above(double value) {
    return std::nextafter(value, kInfinity);
}
double below(double value) {
    return std::nextafter(value, -kInfinity);
}

template <typename S>
ParsedConstraint<S, 6U> parse(const char* text, std::size_t element_count = 1U) {
    return parse_constraint<S, 6U>(make_text(text), element_count);
}
template <typename S>
void expect_admits(const char* text, const std::vector<S>& good, const std::vector<S>& bad,
                   std::size_t element = 0U, std::size_t element_count = 1U) {
    const auto parsed = parse<S>(text, element_count);
    ASSERT_EQ(parsed.finding.rule, ConstraintRule::kNone) << text << ": " << get_text(parsed.finding.rule);
    for (const S value : good) {
        EXPECT_TRUE(parsed.constraint.admits(value, element)) << text;
    }
    for (const S value : bad) {
        EXPECT_FALSE(parsed.constraint.admits(value, element)) << text;
    }
}
template <typename S>
void expect_finding(const char* text, ConstraintRule rule, std::size_t position,
                    std::size_t element_count = 1U) {
    const ConstraintFinding finding = parse<S>(text, element_count).finding;
    EXPECT_EQ(finding.rule, rule) << '"' << text << "\": " << get_text(finding.rule);
    EXPECT_EQ(finding.position, position) << '"' << text << '"';
}

TEST(ConstraintTest, TheEmptyConstraintAdmitsEveryFiniteValue) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues);

    expect_admits<double>("", {0.0, -kMax, kMax}, {kInfinity, -kInfinity, kNan});
    expect_admits<double>("  \t", {0.0}, {kNan});
    expect_admits<std::int8_t>("", {-128, 127}, {});
    expect_admits<bool>("", {false, true}, {});
}

TEST(ConstraintTest, OneValueAdmitsItself) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues);

    expect_admits<double>("100", {100.0}, {below(100.0), above(100.0), -100.0, kNan});
    expect_admits<double>(" -2.5e-1 ", {-0.25}, {0.25});
    expect_admits<double>("10.0", {10.0}, {11.0});
    expect_admits<int>("-7", {-7}, {-8, -6, 7});
    expect_admits<bool>("1", {true}, {false});
    expect_admits<Mode>("2", {Mode::kFast}, {Mode::kOff});
}

TEST(ConstraintTest, LimitsAreMetOnTheirSideOnly) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues);
    const double limit = 0.1;

    for (const char* text : {"x>=0.1", "0.1<=x", " x >= 0.1 ", "0.1 <=\tx"}) {
        expect_admits<double>(text, {limit, above(limit), kMax}, {below(limit), -kMax, kNan, kInfinity});
    }
    for (const char* text : {"x>0.1", "0.1<x"}) {
        expect_admits<double>(text, {above(limit), kMax}, {limit, below(limit), kNan, kInfinity});
    }
    for (const char* text : {"x<=0.1", "0.1>=x"}) {
        expect_admits<double>(text, {limit, below(limit), -kMax}, {above(limit), kMax, kNan, -kInfinity});
    }
    for (const char* text : {"x<0.1", "0.1>x"}) {
        expect_admits<double>(text, {below(limit), -kMax}, {limit, above(limit), kNan, -kInfinity});
    }
}

TEST(ConstraintTest, RangesHaveOpenAndClosedSidesInBothDirections) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues);

    for (const char* text : {"100<=x<=200", "200>=x>=100", "100 <= x <= 200"}) {
        expect_admits<int>(text, {100, 150, 200}, {99, 201});
    }
    for (const char* text : {"100<x<200", "200>x>100"}) {
        expect_admits<int>(text, {101, 199}, {100, 200});
    }
    for (const char* text : {"100<=x<200", "200>x>=100"}) {
        expect_admits<int>(text, {100, 199}, {99, 200});
    }
    for (const char* text : {"100<x<=200", "200>=x>100"}) {
        expect_admits<int>(text, {101, 200}, {100, 201});
    }
    expect_admits<double>("-0.5<x<=0.5", {above(-0.5), 0.5}, {-0.5, above(0.5), kNan});
    expect_admits<double>("-2<=x<=-1", {-2.0, -1.0}, {below(-2.0), above(-1.0)});
    expect_admits<double>("3<=x<=3", {3.0}, {below(3.0), above(3.0)});
    expect_admits<std::uint64_t>("18446744073709551614<x", {18446744073709551615U}, {18446744073709551614U});
    expect_admits<std::int64_t>("x<=-9223372036854775808", {std::numeric_limits<std::int64_t>::min()},
                                {std::numeric_limits<std::int64_t>::min() + 1});
}

TEST(ConstraintTest, ALimitIsRoundedToTheTypeAsItsValuesAre) {
    verifies("SWR-PAR-001", Technique::kErrorGuessing);

    // As doubles 0.1F is above 0.1 and 0.7F below 0.7, so comparing there would refuse a limit's own value.
    expect_admits<float>("0.1<=x<=0.7", {0.1F, 0.7F},
                         {std::nextafter(0.1F, 0.0F), std::nextafter(0.7F, 1.0F)});
    expect_admits<float>("x<=0.1", {0.1F}, {std::nextafter(0.1F, 1.0F)});
}

TEST(ConstraintTest, ChoicesAdmitTheirValues) {
    verifies("SWR-PAR-001", Technique::kEquivalenceClasses);

    expect_admits<int>("(9600,19200)", {9600, 19200}, {9599, 9601, 19199, 19201, 0});
    expect_admits<int>("( -1 , 5 )", {-1, 5}, {0});
    expect_admits<int>("(7)", {7}, {6, 8});
    expect_admits<int>("(1,2,1)", {1, 2}, {3});
    expect_admits<double>("(0.1,.5,1e3)", {0.1, 0.5, 1000.0}, {above(0.1), 0.3, kNan});
    expect_admits<Mode>("(slow,fast)", {Mode::kSlow, Mode::kFast}, {Mode::kOff, static_cast<Mode>(9)});
    expect_admits<Mode>("(0, fast)", {Mode::kOff, Mode::kFast}, {Mode::kSlow});
    expect_admits<Unnamed>("(-1)", {Unnamed::kFirst}, {static_cast<Unnamed>(0)});
    expect_admits<bool>("(true)", {true}, {false});
    expect_admits<bool>("(false,1)", {true, false}, {});
}

TEST(ConstraintTest, AListHoldsElementByElementAndASingleOneForEach) {
    verifies("SWR-PAR-001", Technique::kEquivalenceClasses);

    const char* const list = "x>=0, , (1,2)";
    expect_admits<double>(list, {0.0, 5.0}, {-1.0}, 0U, 3U);
    expect_admits<double>(list, {-9.0, kMax}, {kNan, kInfinity}, 1U, 3U);
    expect_admits<double>(list, {1.0, 2.0}, {0.0, 1.5, 5.0}, 2U, 3U);
    expect_admits<double>("x<=0,", {5.0}, {kNan}, 1U, 2U);
    expect_admits<double>(",, , ", {5.0}, {kNan}, 3U, 4U);
    for (std::size_t element = 0U; element < 3U; ++element) {
        expect_admits<double>("0<x", {1.0}, {0.0}, element, 3U);
        expect_admits<double>("(1,2)", {1.0, 2.0}, {0.0}, element, 3U);
        expect_admits<double>("", {0.0}, {kNan}, element, 3U);
    }
}

TEST(ConstraintTest, NamedElementsAreConstrainedInTheirOrder) {
    verifies("SWR-PAR-001", Technique::kEquivalenceClasses);

    const char* const named = " { pan : 0<x<1, tilt_2:(3,4) ,z: } ";
    expect_admits<double>(named, {0.5}, {0.0, 1.0, 3.0}, 0U, 3U);
    expect_admits<double>(named, {3.0, 4.0}, {0.5}, 1U, 3U);
    expect_admits<double>(named, {-9.0}, {kNan}, 2U, 3U);
    expect_admits<int>("{only: 5}", {5}, {4});
}

TEST(ConstraintTest, AConstraintIsReadInAConstantExpression) {
    verifies("SWR-PAR-001", Technique::kInterface);
    constexpr auto kParsed = parse_constraint<double, 4U>(make_text("0.1<=x<=3.0, (1,2), "), 3U);
    static_assert(kParsed.finding.rule == ConstraintRule::kNone);
    static_assert(kParsed.constraint.admits(0.1, 0U) && !kParsed.constraint.admits(0.05, 0U));
    static_assert(kParsed.constraint.admits(2.0, 1U) && !kParsed.constraint.admits(2.5, 1U));

    EXPECT_EQ(kParsed.constraint.get_ranges().size(), 4U);
}

// Refusals: what, and before which character.

TEST(ConstraintTest, NumbersThatAreMissingOrMalformedAreNamed) {
    verifies("SWR-PAR-001", Technique::kErrorGuessing, Polarity::kViolation);

    expect_finding<double>("abc", ConstraintRule::kNumberExpected, 0U);
    expect_finding<double>("x<", ConstraintRule::kNumberExpected, 2U);
    expect_finding<double>("x<=", ConstraintRule::kNumberExpected, 3U);
    expect_finding<double>("x=>1", ConstraintRule::kComparisonExpected, 1U);
    expect_finding<double>("x<abc", ConstraintRule::kNumberExpected, 2U);
    expect_finding<double>("x<x", ConstraintRule::kNumberExpected, 2U);
    expect_finding<double>("<x<=10", ConstraintRule::kNumberExpected, 0U);
    expect_finding<double>("-10<x<=", ConstraintRule::kNumberExpected, 7U);
    expect_finding<double>("1e<x", ConstraintRule::kNumberExpected, 2U);
    expect_finding<double>("x<- 1", ConstraintRule::kNumberExpected, 3U);
    expect_finding<double>("()", ConstraintRule::kNumberExpected, 1U);
    expect_finding<double>("(1,)", ConstraintRule::kNumberExpected, 3U);
    expect_finding<double>("(,1)", ConstraintRule::kNumberExpected, 1U);
    expect_finding<double>("((1))", ConstraintRule::kNumberExpected, 1U);
    expect_finding<double>("123456789012345678901", ConstraintRule::kTooManyDigits, 0U);
    expect_finding<double>("x< 123456789012345678901", ConstraintRule::kTooManyDigits, 3U);
}

TEST(ConstraintTest, ValuesThatTheTypeDoesNotHaveAreNamed) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues, Polarity::kViolation);

    expect_finding<double>("x<1e309", ConstraintRule::kNotInType, 2U);
    expect_finding<double>("1e-400<x", ConstraintRule::kNotInType, 0U);
    expect_finding<float>("x<1e39", ConstraintRule::kNotInType, 2U);
    expect_finding<int>("0.5<=x", ConstraintRule::kNotInType, 0U);
    expect_finding<std::int8_t>("-128<=x<=128", ConstraintRule::kNotInType, 9U);
    expect_finding<std::uint8_t>("x>=-1", ConstraintRule::kNotInType, 3U);
    expect_finding<std::uint8_t>("(1, 256)", ConstraintRule::kNotInType, 4U);
    expect_finding<bool>("2", ConstraintRule::kNotInType, 0U);
    expect_finding<double>("(1,fast)", ConstraintRule::kNameUnknown, 3U);
    expect_finding<double>("(inf)", ConstraintRule::kNameUnknown, 1U);
    expect_finding<Mode>("(slow,medium)", ConstraintRule::kNameUnknown, 6U);
    expect_finding<Mode>("(invalid)", ConstraintRule::kNameUnknown, 1U);
    expect_finding<Unnamed>("(kFirst)", ConstraintRule::kNameUnknown, 1U);
    expect_finding<bool>("(True)", ConstraintRule::kNameUnknown, 1U);
}

TEST(ConstraintTest, WrongComparisonsAreNamed) {
    verifies("SWR-PAR-001", Technique::kErrorGuessing, Polarity::kViolation);

    expect_finding<double>("x", ConstraintRule::kComparisonExpected, 1U);
    expect_finding<double>("x==1", ConstraintRule::kComparisonExpected, 1U);
    expect_finding<double>("x!=1", ConstraintRule::kComparisonExpected, 1U);
    expect_finding<double>("0=x", ConstraintRule::kComparisonExpected, 1U);
    expect_finding<double>("0<", ConstraintRule::kVariableExpected, 2U);
    expect_finding<double>("0<y", ConstraintRule::kVariableExpected, 2U);
    expect_finding<double>("0<1", ConstraintRule::kVariableExpected, 2U);
    expect_finding<double>("0< =x", ConstraintRule::kVariableExpected, 3U);
    expect_finding<double>("1<x>0", ConstraintRule::kDirectionsDiffer, 3U);
    expect_finding<double>("10>=x<=10", ConstraintRule::kDirectionsDiffer, 5U);
}

TEST(ConstraintTest, RangesWithoutAnyValueAreNamed) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues, Polarity::kViolation);

    expect_finding<double>("10<x<1", ConstraintRule::kRangeEmpty, 0U);
    expect_finding<double>(" 1.0000000000000002<=x<=1", ConstraintRule::kRangeEmpty, 1U);
    expect_finding<double>("1<x<=1", ConstraintRule::kRangeEmpty, 0U);
    expect_finding<double>("1<=x<1", ConstraintRule::kRangeEmpty, 0U);
    expect_finding<double>("-1>=x>=1", ConstraintRule::kRangeEmpty, 0U);
    expect_finding<double>("-0<x<0", ConstraintRule::kRangeEmpty, 0U);
    expect_finding<std::uint8_t>("x<0", ConstraintRule::kRangeEmpty, 0U);
    expect_finding<std::uint8_t>("x>255", ConstraintRule::kRangeEmpty, 0U);
    expect_finding<double>("x>0, 5<x<4", ConstraintRule::kRangeEmpty, 5U, 2U);
}

template <typename S>
constexpr ConstraintRule find_rule(const char* text) {
    return parse_constraint<S, 4U>(make_text(text)).finding.rule;
}

TEST(ConstraintTest, AnOpenRangeOfWholeNumbersNeedsOneBetweenItsLimits) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr ConstraintRule kEmpty = ConstraintRule::kRangeEmpty;

    static_assert(find_rule<std::int32_t>("0<x<1") == kEmpty, "by the compiler as well");
    static_assert(find_rule<std::int32_t>("0<x<2") == ConstraintRule::kNone);
    expect_finding<std::int32_t>("0<x<1", kEmpty, 0U);
    expect_finding<std::uint8_t>("254<x<255", kEmpty, 0U);
    expect_finding<std::int8_t>("1, 127>x>126", kEmpty, 3U, 2U);
    expect_finding<std::int64_t>("9223372036854775806<x<9223372036854775807", kEmpty, 0U);
    expect_finding<std::int64_t>("-9223372036854775808<x<-9223372036854775807", kEmpty, 0U);
    expect_finding<std::uint64_t>("18446744073709551614<x<18446744073709551615", kEmpty, 0U);
    expect_finding<bool>("0<x<1", kEmpty, 0U);
}

TEST(ConstraintTest, ARangeWithOneWholeNumberOrOfFractionsIsNotEmpty) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues);

    for (const char* const text : {"0<x<2", "0<=x<1", "0<x<=1", "-1<x<1", "0<=x<=1", "1<=x<=1"}) {
        EXPECT_EQ(find_rule<std::int32_t>(text), ConstraintRule::kNone) << text;
    }
    EXPECT_EQ(find_rule<std::int64_t>("-9223372036854775808<x<9223372036854775807"), ConstraintRule::kNone);
    EXPECT_EQ(find_rule<std::uint64_t>("0<x<18446744073709551615"), ConstraintRule::kNone);
    EXPECT_EQ(find_rule<double>("0<x<1"), ConstraintRule::kNone);
    EXPECT_EQ(find_rule<float>("0<x<1e-45"), ConstraintRule::kNone) << "nobody asks between neighbours";
}

TEST(ConstraintTest, BracketsKeysAndLooseEndsAreNamed) {
    verifies("SWR-PAR-001", Technique::kErrorGuessing, Polarity::kViolation);

    expect_finding<double>("10a", ConstraintRule::kTextBeyondEnd, 2U);
    expect_finding<double>("0<x<1<2", ConstraintRule::kTextBeyondEnd, 5U);
    expect_finding<double>("x>1 x<2", ConstraintRule::kTextBeyondEnd, 4U);
    expect_finding<double>("1;2", ConstraintRule::kTextBeyondEnd, 1U);
    expect_finding<double>("(1)2", ConstraintRule::kTextBeyondEnd, 3U);
    expect_finding<double>("{a:1}}", ConstraintRule::kTextBeyondEnd, 5U);
    expect_finding<double>("1}", ConstraintRule::kTextBeyondEnd, 1U);
    expect_finding<double>("(1", ConstraintRule::kBracketExpected, 2U);
    expect_finding<double>("(1 2)", ConstraintRule::kBracketExpected, 3U);
    expect_finding<double>("(1<x)", ConstraintRule::kBracketExpected, 2U);
    expect_finding<double>("{a:1", ConstraintRule::kBracketExpected, 4U);
    expect_finding<double>("{a:1 b:2}", ConstraintRule::kBracketExpected, 5U, 2U);
    expect_finding<double>("{}", ConstraintRule::kKeyExpected, 1U);
    expect_finding<double>("{ : 0<x<1}", ConstraintRule::kKeyExpected, 2U);
    expect_finding<double>("{ key0: 0<x,:2>x }", ConstraintRule::kKeyExpected, 12U, 2U);
    expect_finding<double>("{a 1}", ConstraintRule::kColonExpected, 3U);
    expect_finding<double>("{a", ConstraintRule::kColonExpected, 2U);
    expect_finding<double>("{a:1, a:2}", ConstraintRule::kKeyTwice, 6U, 2U);
    expect_finding<double>(std::string("1\0", 2U).c_str(), ConstraintRule::kNone, 0U);
    const std::string with_zero("1\0002", 3U);
    EXPECT_EQ((parse_constraint<double, 4U>({with_zero.data(), with_zero.size()}).finding.position), 1U);
}

TEST(ConstraintTest, ListsOfTheWrongLengthAreNamed) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues, Polarity::kViolation);

    expect_finding<double>("1,2", ConstraintRule::kElementCount, 2U);
    expect_finding<double>(",", ConstraintRule::kElementCount, 1U);
    expect_finding<double>("1,2", ConstraintRule::kElementCount, 3U, 3U);
    expect_finding<double>("1,2,3,4", ConstraintRule::kElementCount, 6U, 3U);
    expect_finding<double>("1,2,3", ConstraintRule::kNone, 0U, 3U);
    expect_finding<double>("{a:1}", ConstraintRule::kElementCount, 5U, 2U);
    expect_finding<double>("{a:1,b:2}", ConstraintRule::kElementCount, 7U);
}

TEST(ConstraintTest, AConstraintWithMoreRangesThanRoomIsNamed) {
    verifies("SWR-PAR-001", Technique::kBoundaryValues, Polarity::kViolation);

    expect_finding<int>("(1,2,3,4,5,6)", ConstraintRule::kNone, 0U);
    expect_finding<int>("(1,2,3,4,5,6,7)", ConstraintRule::kTooManyRanges, 13U);
    expect_finding<int>("(1,2,3,4,5),,", ConstraintRule::kTooManyRanges, 13U, 3U);
}

TEST(ConstraintTest, EveryFindingHasItsOwnText) {
    verifies("SWR-PAR-001", Technique::kInterface);
    std::vector<std::string> texts;

    for (std::uint8_t rule = 0U; rule <= static_cast<std::uint8_t>(ConstraintRule::kTooManyRanges) + 1U;
         ++rule) {
        texts.emplace_back(get_text(static_cast<ConstraintRule>(rule)));
        const bool is_finding = rule != static_cast<std::uint8_t>(ConstraintRule::kNone);
        EXPECT_EQ(texts.back().find("constraint: ") == 0U, is_finding) << texts.back();
        EXPECT_FALSE(texts.back().empty());
    }
    for (std::size_t i = 0U; i < texts.size(); ++i) {
        for (std::size_t j = 0U; j < i; ++j) {
            EXPECT_NE(texts[i], texts[j]);
        }
    }
}

}  // namespace
}  // namespace mamori

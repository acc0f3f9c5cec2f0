// SPDX-License-Identifier: Apache-2.0
// Goal: a vote gives a value that is safe to act on, or none; the channel that deviates is named and left
// out. Method: both sides of tolerance and time, every channel as the deviating one, every combination of
// demands, values that are not finite, comparison with the definition over a grid of values.
#include "mamori/safety/redundancy/voter.hpp"

#include <algorithm>
#include <limits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr VoterLimits kLimits{1.0, Duration{100}, WorseValue::kGreater};

TEST(WorseValueTest, EachOrderChoosesItsWorseValue) {
    verifies("SWR-RED-003", Technique::kEquivalenceClasses);

    EXPECT_EQ(choose_worse(1.0, 2.0, WorseValue::kGreater), 2.0);
    EXPECT_EQ(choose_worse(2.0, 1.0, WorseValue::kGreater), 2.0);
    EXPECT_EQ(choose_worse(1.0, 2.0, WorseValue::kSmaller), 1.0);
    EXPECT_EQ(choose_worse(2.0, 1.0, WorseValue::kSmaller), 1.0);
    EXPECT_EQ(choose_worse(-3.0, 2.0, WorseValue::kFurtherFromZero), -3.0);
    EXPECT_EQ(choose_worse(2.0, -3.0, WorseValue::kFurtherFromZero), -3.0);
    EXPECT_EQ(choose_worse(-3.0, 3.0, WorseValue::kFurtherFromZero), -3.0) << "the first of equals";
    EXPECT_EQ(choose_worse(3.0, -3.0, WorseValue::kFurtherFromZero), 3.0);
    EXPECT_EQ(choose_worse(0.25, 0.5, WorseValue::kFurtherFromZero), 0.5);
    EXPECT_EQ(choose_worse(0.5, 0.25, WorseValue::kFurtherFromZero), 0.5);
    EXPECT_EQ(choose_worse(2.0, 3.0, WorseValue::kNone), 2.0);
    EXPECT_EQ(choose_worse(2.0, 3.0, static_cast<WorseValue>(77)), 2.0);
}

TEST(WorseValueTest, LimitsAreInsideTheirRange) {
    verifies("SWR-RED-003", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_TRUE(is_valid(kLimits));
    EXPECT_TRUE(is_valid({0.0, Duration{0}, WorseValue::kNone}));
    EXPECT_FALSE(is_valid({-1.0, Duration{0}, WorseValue::kNone}));
    EXPECT_FALSE(is_valid({0.0, Duration{0}, static_cast<WorseValue>(4)}));
}

TEST(WorseValueTest, LimitsOutsideTheirRangeGoToTheAssertionHandler) {
    verifies("SWR-RED-003", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS((ValueVoter1oo2{{-1.0, Duration{0}, WorseValue::kGreater}}), "voter.hpp", 1);
    EXPECT_CHECK_FAILS((ValueVoter1oo2{{kNan, Duration{0}, WorseValue::kGreater}}), "voter.hpp", 1);
    EXPECT_CHECK_FAILS((ValueVoter2oo3{{0.0, Duration{-1}, WorseValue::kGreater}}), "discrepancy.hpp", 1);
    EXPECT_CHECK_FAILS((ValueVoter2oo3{{0.0, Duration{0}, static_cast<WorseValue>(4)}}), "voter.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(ValueVoter1oo2{kLimits}.get_discrepancy(2U)), "voter.hpp", 2);
}

TEST(ValueVoter1oo2Test, ChannelsThatAgreeGiveTheWorseValue) {
    verifies("SWR-RED-003", Technique::kBoundaryValues);
    ValueVoter1oo2 sut(kLimits);

    EXPECT_EQ(sut.step({{5.0, 6.0}}, Instant{0}).get_value(), 6.0);
    EXPECT_EQ(sut.step({{6.0, 5.0}}, Instant{1000}).get_value(), 6.0);
    EXPECT_EQ(sut.get_discrepancy(), Discrepancy::kNone);
}

TEST(ValueVoter1oo2Test, ChannelsThatDisagreeGiveTheWorseValueWithinTheirTimeAndNoneAfterIt) {
    verifies("SWR-RED-003", Technique::kBoundaryValues, Polarity::kViolation);
    ValueVoter1oo2 sut(kLimits);

    EXPECT_EQ(sut.step({{5.0, 7.0}}, Instant{0}).get_value(), 7.0);
    EXPECT_EQ(sut.get_discrepancy(), Discrepancy::kTolerated);
    EXPECT_EQ(sut.step({{8.0, 5.0}}, Instant{100}).get_value(), 8.0);
    EXPECT_EQ(sut.step({{8.0, 5.0}}, Instant{101}).get_status(), Status::kError);
    EXPECT_EQ(sut.step({{5.0, 5.0}}, Instant{102}).get_status(), Status::kError) << "it does not heal";
    EXPECT_EQ(sut.get_discrepancy(), Discrepancy::kLatched);
    EXPECT_EQ(sut.get_discrepancy(0U), Discrepancy::kNone) << "nobody knows which of two is wrong";
    EXPECT_EQ(sut.get_discrepancy(1U), Discrepancy::kNone);

    EXPECT_EQ(sut.acknowledge(), Status::kOk);
    EXPECT_EQ(sut.step({{5.0, 5.0}}, Instant{103}).get_value(), 5.0);
}

TEST(ValueVoter1oo2Test, WithoutAWorseValueADisagreementGivesNoneAtOnce) {
    verifies("SWR-RED-003", Technique::kEquivalenceClasses, Polarity::kViolation);
    ValueVoter1oo2 sut({1.0, Duration{100}, WorseValue::kNone});

    EXPECT_EQ(sut.step({{5.0, 6.0}}, Instant{0}).get_value(), 5.0);
    EXPECT_EQ(sut.step({{5.0, 6.5}}, Instant{1}).get_status(), Status::kError);
    EXPECT_EQ(sut.get_discrepancy(), Discrepancy::kTolerated) << "a stop, but not a latched one";
    EXPECT_EQ(sut.step({{5.0, 6.0}}, Instant{2}).get_value(), 5.0);
}

TEST(ValueVoter1oo2Test, ChannelThatIsNotFiniteGivesNoValueAtOnce) {
    verifies("SWR-RED-003", Technique::kFaultInjection, Polarity::kViolation);

    for (const double bad : {kNan, kInfinity, -kInfinity}) {
        ValueVoter1oo2 sut(kLimits);
        EXPECT_EQ(sut.step({{bad, 1.0}}, Instant{0}).get_status(), Status::kError) << bad;
        EXPECT_EQ(sut.step({{1.0, bad}}, Instant{1}).get_status(), Status::kError) << bad;
        EXPECT_EQ(sut.step({{bad, bad}}, Instant{2}).get_status(), Status::kError) << bad;
        EXPECT_EQ(sut.get_discrepancy(), Discrepancy::kTolerated);
    }
}

TEST(ValueVoter1oo2Test, ClockThatRunsBackwardsGivesNoValue) {
    verifies("SWR-RED-007", Technique::kFaultInjection, Polarity::kViolation);
    ValueVoter1oo2 sut(kLimits);
    ASSERT_EQ(sut.step({{1.0, 1.0}}, Instant{10}).get_status(), Status::kOk);

    EXPECT_EQ(sut.step({{1.0, 1.0}}, Instant{9}).get_status(), Status::kError);
    EXPECT_EQ(sut.acknowledge(), Status::kOk);
    EXPECT_EQ(sut.step({{1.0, 1.0}}, Instant{9}).get_status(), Status::kOk);
}

TEST(DemandVoter1oo2Test, EitherChannelDemands) {
    verifies("SWR-RED-003", Technique::kEquivalenceClasses);
    DemandVoter1oo2 sut(Duration{100});

    EXPECT_FALSE(sut.step({{false, false}}, Instant{0}));
    EXPECT_TRUE(sut.step({{true, false}}, Instant{1}));
    EXPECT_TRUE(sut.step({{false, true}}, Instant{2}));
    EXPECT_TRUE(sut.step({{true, true}}, Instant{3}));
    EXPECT_FALSE(sut.step({{false, false}}, Instant{4}));
}

TEST(DemandVoter1oo2Test, ChannelsThatDifferForTooLongDemandUntilAcknowledged) {
    verifies("SWR-RED-003", Technique::kBoundaryValues, Polarity::kViolation);
    DemandVoter1oo2 sut(Duration{100});
    ASSERT_TRUE(sut.step({{true, false}}, Instant{0}));
    ASSERT_TRUE(sut.step({{true, false}}, Instant{100}));
    ASSERT_EQ(sut.get_discrepancy(), Discrepancy::kTolerated);
    ASSERT_TRUE(sut.step({{true, false}}, Instant{101}));
    EXPECT_EQ(sut.get_discrepancy(), Discrepancy::kLatched);
    EXPECT_EQ(sut.acknowledge(), Status::kPreconditionNotMet);

    EXPECT_TRUE(sut.step({{false, false}}, Instant{102})) << "a stuck contact does not heal";
    EXPECT_EQ(sut.acknowledge(), Status::kOk);
    EXPECT_FALSE(sut.step({{false, false}}, Instant{103}));
}

TEST(ValueVoter2oo3Test, ThreeThatAgreeGiveTheirMedian) {
    verifies("SWR-RED-005", Technique::kBackToBack);
    ValueVoter2oo3 sut({100.0, Duration{0}, WorseValue::kGreater});
    std::int64_t now = 0;

    for (const double a : {-2.0, 0.0, 1.0, 3.0}) {
        for (const double b : {-2.0, 0.0, 1.0, 3.0}) {
            for (const double c : {-2.0, 0.0, 1.0, 3.0}) {
                std::array<double, 3U> sorted{{a, b, c}};
                std::sort(sorted.begin(), sorted.end());
                ASSERT_EQ(sut.step({{a, b, c}}, Instant{++now}).get_value(), sorted[1]) << a << b << c;
            }
        }
    }
}

TEST(ValueVoter2oo3Test, ThirdChannelHasNoInfluenceOnTwoThatAgree) {
    verifies("SWR-RED-005", Technique::kFaultInjection, Polarity::kViolation);

    for (std::size_t bad = 0U; bad < 3U; ++bad) {
        for (const double value : {-1.0e300, -1.1, 7.1, 1.0e300, kNan, kInfinity, -kInfinity}) {
            ValueVoter2oo3 sut({2.0, Duration{100}, WorseValue::kGreater});
            std::array<double, 3U> values{{1.0, 1.0, 1.0}};
            values[bad] = value;
            values[(bad + 1U) % 3U] = 2.0;
            EXPECT_EQ(sut.step(values, Instant{0}).get_value(), 2.0) << bad << ' ' << value;
            EXPECT_EQ(sut.get_discrepancy(), Discrepancy::kNone);
            for (std::size_t channel = 0U; channel < 3U; ++channel) {
                EXPECT_EQ(sut.get_discrepancy(channel),
                          channel == bad ? Discrepancy::kTolerated : Discrepancy::kNone);
            }
        }
    }
}

TEST(ValueVoter2oo3Test, ToleranceDecidesWhoBelongsToTheMajority) {
    verifies("SWR-RED-005", Technique::kBoundaryValues);
    ValueVoter2oo3 sut(kLimits);

    EXPECT_EQ(sut.step({{0.0, 1.0, 2.0}}, Instant{0}).get_value(), 1.0) << "each agrees with another one";
    EXPECT_EQ(sut.get_discrepancy(2U), Discrepancy::kNone);
    EXPECT_EQ(sut.step({{0.0, 0.5, 1.75}}, Instant{1}).get_value(), 0.5) << "the worse one of two";
    EXPECT_EQ(sut.get_discrepancy(2U), Discrepancy::kTolerated);
}

TEST(ValueVoter2oo3Test, ThreeThatDisagreeGiveTheWorstWithinTheirTimeAndNameNobody) {
    verifies("SWR-RED-005", Technique::kBoundaryValues, Polarity::kViolation);
    ValueVoter2oo3 sut(kLimits);

    EXPECT_EQ(sut.step({{9.0, 3.0, 6.0}}, Instant{0}).get_value(), 9.0);
    EXPECT_EQ(sut.step({{0.0, 3.0, 6.0}}, Instant{100}).get_value(), 6.0);
    EXPECT_EQ(sut.get_discrepancy(), Discrepancy::kTolerated);
    EXPECT_EQ(sut.step({{0.0, kNan, 6.0}}, Instant{100}).get_status(), Status::kError);
    EXPECT_EQ(sut.step({{0.0, 3.0, 6.0}}, Instant{101}).get_status(), Status::kError);
    EXPECT_EQ(sut.get_discrepancy(), Discrepancy::kLatched);
    for (std::size_t channel = 0U; channel < 3U; ++channel) {
        EXPECT_EQ(sut.get_discrepancy(channel), Discrepancy::kNone) << channel;
    }
    EXPECT_EQ(sut.step({{3.0, 3.0, 3.0}}, Instant{102}).get_status(), Status::kError) << "it does not heal";
}

TEST(ValueVoter2oo3Test, ThreeThatDisagreeGiveNoValueWhereNoneIsTheWorst) {
    verifies("SWR-RED-005", Technique::kEquivalenceClasses, Polarity::kViolation);
    ValueVoter2oo3 sut({1.0, Duration{100}, WorseValue::kNone});

    EXPECT_EQ(sut.step({{0.0, 3.0, 6.0}}, Instant{0}).get_status(), Status::kError);
}

class LostChannelTest : public ::testing::TestWithParam<std::size_t> {
  protected:
    /// The channel of the test says `bad`, the next one `b`, the one behind it `c`.
    Result<double> step(double bad, double b, double c, std::int64_t at_ns) {
        std::array<double, 3U> values{};
        values[GetParam()] = bad;
        values[(GetParam() + 1U) % 3U] = b;
        values[(GetParam() + 2U) % 3U] = c;
        return sut_.step(values, Instant{at_ns});
    }
    void lose() {
        ASSERT_EQ(step(50.0, 1.0, 2.0, 0).get_value(), 2.0);
        ASSERT_EQ(step(50.0, 1.0, 2.0, 101).get_value(), 2.0);
        ASSERT_EQ(sut_.get_discrepancy(GetParam()), Discrepancy::kLatched);
    }

    ValueVoter2oo3 sut_{kLimits};
};

TEST_P(LostChannelTest, DeviatingChannelIsNamedAfterItsTime) {
    verifies("SWR-RED-006", Technique::kBoundaryValues);
    ASSERT_EQ(step(50.0, 1.0, 2.0, 0).get_value(), 2.0);
    ASSERT_EQ(step(50.0, 1.0, 2.0, 100).get_value(), 2.0);
    EXPECT_EQ(sut_.get_discrepancy(GetParam()), Discrepancy::kTolerated);

    ASSERT_EQ(step(50.0, 1.0, 2.0, 101).get_value(), 2.0);
    EXPECT_EQ(sut_.get_discrepancy(GetParam()), Discrepancy::kLatched);
    EXPECT_EQ(sut_.get_discrepancy((GetParam() + 1U) % 3U), Discrepancy::kNone);
    EXPECT_EQ(sut_.get_discrepancy((GetParam() + 2U) % 3U), Discrepancy::kNone);
    EXPECT_EQ(sut_.get_discrepancy(), Discrepancy::kNone);
}

TEST_P(LostChannelTest, LostChannelDoesNotVoteEvenIfItAgreesAgain) {
    verifies("SWR-RED-006", Technique::kFaultInjection, Polarity::kViolation);
    lose();

    EXPECT_EQ(step(1.0, 2.0, 2.5, 102).get_value(), 2.5) << "1oo2: the worse one, no median of three";
    EXPECT_EQ(sut_.get_discrepancy(GetParam()), Discrepancy::kLatched);
    EXPECT_EQ(step(5.0, 2.0, 5.0, 103).get_value(), 5.0);
    EXPECT_EQ(sut_.get_discrepancy(), Discrepancy::kTolerated) << "it does not make a majority";
}

TEST_P(LostChannelTest, TwoThatAreLeftVoteAs1oo2) {
    verifies("SWR-RED-006", Technique::kBoundaryValues, Polarity::kViolation);
    lose();

    EXPECT_EQ(step(50.0, 4.0, 2.0, 110).get_value(), 4.0);
    EXPECT_EQ(step(50.0, -4.0, -2.0, 110).get_value(), -2.0);
    EXPECT_EQ(step(50.0, kNan, 2.0, 110).get_status(), Status::kError);
    EXPECT_EQ(step(50.0, 2.0, 4.0, 210).get_value(), 4.0);
    EXPECT_EQ(step(50.0, 2.0, 4.0, 211).get_status(), Status::kError);
    EXPECT_EQ(step(50.0, 2.0, 2.0, 212).get_status(), Status::kError) << "it does not heal";
}

TEST_P(LostChannelTest, LostChannelComesBackByAcknowledgementOnceItAgrees) {
    verifies("SWR-RED-006", Technique::kStateTransition, Polarity::kViolation);
    lose();
    EXPECT_EQ(sut_.acknowledge(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.get_discrepancy(GetParam()), Discrepancy::kLatched);

    ASSERT_EQ(step(2.0, 2.5, 3.0, 102).get_value(), 3.0);
    EXPECT_EQ(sut_.acknowledge(), Status::kOk);
    EXPECT_EQ(step(2.0, 2.5, 3.0, 103).get_value(), 2.5) << "the median of three again";
}

INSTANTIATE_TEST_SUITE_P(EachChannel, LostChannelTest, ::testing::Values(0U, 1U, 2U));

TEST(ValueVoter2oo3Test, ClockThatRunsBackwardsLosesEveryChannelUntilAcknowledged) {
    verifies("SWR-RED-007", Technique::kFaultInjection, Polarity::kViolation);
    ValueVoter2oo3 sut(kLimits);
    ASSERT_EQ(sut.step({{1.0, 1.0, 1.0}}, Instant{10}).get_status(), Status::kOk);

    EXPECT_EQ(sut.step({{1.0, 1.0, 1.0}}, Instant{9}).get_status(), Status::kError);
    EXPECT_EQ(sut.step({{1.0, 1.0, 1.0}}, Instant{10}).get_status(), Status::kError);
    EXPECT_EQ(sut.get_discrepancy(1U), Discrepancy::kLatched);
    EXPECT_EQ(sut.acknowledge(), Status::kPreconditionNotMet) << "there was no majority";
    EXPECT_EQ(sut.step({{1.0, 1.0, 1.0}}, Instant{11}).get_status(), Status::kError);
    EXPECT_EQ(sut.acknowledge(), Status::kOk);
    EXPECT_EQ(sut.step({{1.0, 1.0, 1.0}}, Instant{12}).get_status(), Status::kOk);
}

TEST(ValueVoter2oo3Test, SecondChannelThatDeviatesFailsTheVote) {
    verifies("SWR-RED-006", Technique::kFaultInjection, Polarity::kViolation);
    ValueVoter2oo3 sut({1.0, Duration{1000}, WorseValue::kGreater});
    ASSERT_EQ(sut.step({{50.0, 1.0, 1.0}}, Instant{0}).get_value(), 1.0);
    ASSERT_EQ(sut.step({{50.0, 1.0, 1.0}}, Instant{1001}).get_value(), 1.0);

    EXPECT_EQ(sut.step({{1.0, 50.0, 1.0}}, Instant{1002}).get_value(), 50.0) << "1oo2: the worse one";
    EXPECT_EQ(sut.step({{1.0, 50.0, 1.0}}, Instant{2003}).get_status(), Status::kError);
}

TEST(DemandVoter2oo3Test, TwoOfThreeDemand) {
    verifies("SWR-RED-005", Technique::kEquivalenceClasses);

    for (unsigned int bits = 0U; bits < 8U; ++bits) {
        DemandVoter2oo3 sut(Duration{100});
        const std::array<bool, 3U> demands{{(bits & 1U) != 0U, (bits & 2U) != 0U, (bits & 4U) != 0U}};
        const auto count = std::count(demands.begin(), demands.end(), true);
        EXPECT_EQ(sut.step(demands, Instant{0}), count >= 2) << bits;
        EXPECT_EQ(sut.get_discrepancy(), Discrepancy::kNone) << "three times yes or no has a majority";
    }
}

TEST(DemandVoter2oo3Test, VoteThatFailsIsADemand) {
    verifies("SWR-RED-007", Technique::kFaultInjection, Polarity::kViolation);
    DemandVoter2oo3 sut(Duration{100});
    ASSERT_FALSE(sut.step({{false, false, false}}, Instant{1}));

    EXPECT_TRUE(sut.step({{false, false, false}}, Instant{0})) << "the clock ran backwards";
    EXPECT_TRUE(sut.step({{false, false, false}}, Instant{1}));
}

TEST(DemandVoter2oo3Test, WithoutALostChannelEitherOfTwoDemands) {
    verifies("SWR-RED-006", Technique::kFaultInjection, Polarity::kViolation);
    DemandVoter2oo3 sut(Duration{100});
    ASSERT_FALSE(sut.step({{true, false, false}}, Instant{0}));
    ASSERT_FALSE(sut.step({{true, false, false}}, Instant{101}));
    ASSERT_EQ(sut.get_discrepancy(0U), Discrepancy::kLatched);

    EXPECT_FALSE(sut.step({{false, false, false}}, Instant{102}));
    EXPECT_TRUE(sut.step({{false, true, false}}, Instant{103}));
    EXPECT_TRUE(sut.step({{false, false, true}}, Instant{104}));
    EXPECT_FALSE(sut.step({{false, false, false}}, Instant{105}));
    EXPECT_EQ(sut.acknowledge(), Status::kOk);
    EXPECT_FALSE(sut.step({{false, true, false}}, Instant{106})) << "two of three again";
}

}  // namespace
}  // namespace mamori::safety

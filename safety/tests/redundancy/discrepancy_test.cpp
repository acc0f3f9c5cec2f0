// SPDX-License-Identifier: Apache-2.0
// Goal: values agree only when both are numbers close enough; a disagreement that lasts is latched.
// Method: both sides of tolerance and time, values that are not finite, the ends of the time line.
#include "mamori/safety/redundancy/discrepancy.hpp"

#include <limits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargest = std::numeric_limits<double>::max();

TEST(AgreementTest, ValuesAgreeUpToTheToleranceInBothDirections) {
    verifies("SWR-RED-004", Technique::kBoundaryValues);

    EXPECT_TRUE(agree(1.0, 1.5, 0.5));
    EXPECT_TRUE(agree(1.5, 1.0, 0.5));
    EXPECT_TRUE(agree(-0.25, 0.25, 0.5));
    EXPECT_TRUE(agree(3.0, 3.0, 0.0));
    EXPECT_TRUE(agree(0.0, -0.0, 0.0));
    EXPECT_TRUE(agree(kLargest, kLargest, 0.0));
}

TEST(AgreementTest, ValuesBeyondTheToleranceDisagree) {
    verifies("SWR-RED-004", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr double kBeyond = 1.5 + std::numeric_limits<double>::epsilon();

    EXPECT_FALSE(agree(1.0, kBeyond, 0.5));
    EXPECT_FALSE(agree(kBeyond, 1.0, 0.5));
    EXPECT_FALSE(agree(kLargest, -kLargest, kLargest)) << "a difference that overflows is no small one";
}

TEST(AgreementTest, WhatIsNotFiniteAgreesWithNothing) {
    verifies("SWR-RED-004", Technique::kFaultInjection, Polarity::kViolation);

    for (const double other : {0.0, kLargest, kInfinity, -kInfinity, kNan}) {
        for (const double bad : {kInfinity, -kInfinity, kNan}) {
            EXPECT_FALSE(agree(bad, other, kLargest)) << bad << ' ' << other;
            EXPECT_FALSE(agree(other, bad, kLargest)) << other << ' ' << bad;
        }
    }
}

TEST(AgreementTest, TolerancesAreFiniteAndNotNegative) {
    verifies("SWR-RED-004", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_TRUE(is_tolerance(0.0));
    EXPECT_TRUE(is_tolerance(kLargest));
    EXPECT_FALSE(is_tolerance(-std::numeric_limits<double>::denorm_min()));
    EXPECT_FALSE(is_tolerance(kInfinity));
    EXPECT_FALSE(is_tolerance(kNan));
}

class DiscrepancyTimerTest : public ::testing::Test {
  protected:
    Discrepancy step(bool do_disagree, std::int64_t at_ns) { return sut_.step(do_disagree, Instant{at_ns}); }

    DiscrepancyTimer sut_{Duration{100}};
};

TEST_F(DiscrepancyTimerTest, DisagreementIsToleratedUpToAndIncludingItsTime) {
    verifies("SWR-RED-007", Technique::kBoundaryValues);
    EXPECT_EQ(sut_.get(), Discrepancy::kNone);
    EXPECT_EQ(step(false, 0), Discrepancy::kNone);

    EXPECT_EQ(step(true, 50), Discrepancy::kTolerated);
    EXPECT_EQ(step(true, 150), Discrepancy::kTolerated);
    EXPECT_EQ(step(false, 151), Discrepancy::kNone);
    EXPECT_EQ(step(true, 152), Discrepancy::kTolerated) << "the time begins anew";
    EXPECT_EQ(step(true, 252), Discrepancy::kTolerated);
}

TEST_F(DiscrepancyTimerTest, DisagreementThatLastsLongerIsLatched) {
    verifies("SWR-RED-007", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(step(true, 50), Discrepancy::kTolerated);

    EXPECT_EQ(step(true, 151), Discrepancy::kLatched);
    EXPECT_EQ(step(false, 152), Discrepancy::kLatched) << "it does not heal";
    EXPECT_EQ(sut_.get(), Discrepancy::kLatched);
}

TEST_F(DiscrepancyTimerTest, TimeOfZeroToleratesOneInstantOnly) {
    verifies("SWR-RED-007", Technique::kBoundaryValues, Polarity::kViolation);
    DiscrepancyTimer sut(Duration{0});

    EXPECT_EQ(sut.step(true, Instant{5}), Discrepancy::kTolerated);
    EXPECT_EQ(sut.step(true, Instant{5}), Discrepancy::kTolerated);
    EXPECT_EQ(sut.step(true, Instant{6}), Discrepancy::kLatched);
}

TEST_F(DiscrepancyTimerTest, ClockThatRunsBackwardsIsLatchedAlsoWhileTheyAgree) {
    verifies("SWR-RED-007", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(step(false, 10), Discrepancy::kNone);
    EXPECT_EQ(step(false, 10), Discrepancy::kNone);

    EXPECT_EQ(step(false, 9), Discrepancy::kLatched);
}

TEST_F(DiscrepancyTimerTest, WholeTimeLineIsJudged) {
    verifies("SWR-RED-007", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::int64_t kEarliest = std::numeric_limits<std::int64_t>::min();

    EXPECT_EQ(step(true, kEarliest), Discrepancy::kTolerated);
    EXPECT_EQ(step(true, std::numeric_limits<std::int64_t>::max()), Discrepancy::kLatched);
}

TEST_F(DiscrepancyTimerTest, LatchedDisagreementIsAcknowledgedOnceItIsGone) {
    verifies("SWR-RED-007", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(step(true, 0), Discrepancy::kTolerated);
    EXPECT_EQ(sut_.acknowledge(), Status::kOk) << "nothing is latched";
    EXPECT_EQ(sut_.get(), Discrepancy::kTolerated);
    ASSERT_EQ(step(true, 101), Discrepancy::kLatched);

    EXPECT_EQ(sut_.acknowledge(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.get(), Discrepancy::kLatched);
    ASSERT_EQ(step(false, 102), Discrepancy::kLatched);
    EXPECT_EQ(sut_.acknowledge(), Status::kOk);
    EXPECT_EQ(sut_.get(), Discrepancy::kNone);
    EXPECT_EQ(step(true, 103), Discrepancy::kTolerated) << "the time begins anew";
}

TEST_F(DiscrepancyTimerTest, NegativeTimeGoesToTheAssertionHandler) {
    verifies("SWR-RED-007", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS(DiscrepancyTimer{Duration{-1}}, "discrepancy.hpp", 1);
}

}  // namespace
}  // namespace mamori::safety

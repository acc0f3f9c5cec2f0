// SPDX-License-Identifier: Apache-2.0
// Goal: clocks that do not run alike, and channels that are not in the same cycle, are found.
// Method: both sides of each limit, clocks that are fast, slow, frozen or run backwards, counters at their
// wrap.
#include <limits>

#include "mamori/safety/redundancy/clock_ratio.hpp"
#include "mamori/safety/redundancy/time_base_check.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr ClockRatioLimits kClocks{Duration{1000000}, 100U};  // 100 ns in a window

class ClockRatioTest : public ::testing::Test {
  protected:
    ClockVerdict step(std::int64_t reference_ns, std::int64_t checked_ns) {
        return sut_.step(Instant{reference_ns}, Instant{checked_ns});
    }

    ClockRatio sut_{kClocks};
};

TEST_F(ClockRatioTest, NothingIsKnownBeforeAWindowIsOver) {
    verifies("SWR-RED-011", Technique::kBoundaryValues);

    EXPECT_EQ(step(500, 77), ClockVerdict::kMeasuring);
    EXPECT_EQ(step(1000499, 1000076), ClockVerdict::kMeasuring);
    EXPECT_EQ(step(1000500, 1000076), ClockVerdict::kGood) << "over by the reference";
    EXPECT_EQ(sut_.get_verdict(), ClockVerdict::kGood);
}

TEST_F(ClockRatioTest, DeviationUpToTheLimitIsGoodInBothDirections) {
    verifies("SWR-RED-011", Technique::kBoundaryValues);
    ASSERT_EQ(step(0, 0), ClockVerdict::kMeasuring);

    EXPECT_EQ(step(1000000, 1000100), ClockVerdict::kGood);
    EXPECT_EQ(step(2000000, 2000000), ClockVerdict::kGood) << "100 ns too slow in this window";
    EXPECT_EQ(step(4000000, 4000200), ClockVerdict::kGood) << "200 ns in two windows at once";
    EXPECT_EQ(step(5500000, 5500350), ClockVerdict::kGood) << "150 ns in one and a half";
}

TEST_F(ClockRatioTest, FastClockIsFound) {
    verifies("SWR-RED-011", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(step(0, 0), ClockVerdict::kMeasuring);

    EXPECT_EQ(step(1000000, 1000101), ClockVerdict::kViolated);
    EXPECT_EQ(step(2000000, 2000101), ClockVerdict::kViolated) << "it does not heal";
}

TEST_F(ClockRatioTest, SlowClockIsFound) {
    verifies("SWR-RED-011", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(step(0, 0), ClockVerdict::kMeasuring);
    ASSERT_EQ(step(1000000, 999950), ClockVerdict::kGood);

    EXPECT_EQ(step(2000000, 1999849), ClockVerdict::kViolated);
}

TEST_F(ClockRatioTest, LimitGrowsWithTheTimeThatPassedAndNoFaster) {
    verifies("SWR-RED-011", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(step(0, 0), ClockVerdict::kMeasuring);

    EXPECT_EQ(step(1500000, 1500151), ClockVerdict::kViolated);
}

TEST_F(ClockRatioTest, FrozenClockIsFoundByTheOtherOne) {
    verifies("SWR-RED-011", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(step(0, 0), ClockVerdict::kMeasuring);
    EXPECT_EQ(step(0, 999999), ClockVerdict::kMeasuring);
    EXPECT_EQ(step(0, 1000000), ClockVerdict::kViolated);

    ClockRatio other(kClocks);
    EXPECT_EQ(other.step(Instant{0}, Instant{0}), ClockVerdict::kMeasuring);
    EXPECT_EQ(other.step(Instant{1000000}, Instant{0}), ClockVerdict::kViolated);
}

TEST_F(ClockRatioTest, ClockThatRunsBackwardsIsFoundInsideAWindow) {
    verifies("SWR-RED-011", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(step(0, 0), ClockVerdict::kMeasuring);
    ASSERT_EQ(step(500, 500), ClockVerdict::kMeasuring);
    EXPECT_EQ(step(499, 500), ClockVerdict::kViolated);

    ASSERT_EQ(sut_.acknowledge(), Status::kOk);
    ASSERT_EQ(step(10, 500), ClockVerdict::kMeasuring);
    ASSERT_EQ(step(11, 500), ClockVerdict::kMeasuring);
    EXPECT_EQ(step(12, 499), ClockVerdict::kViolated);
}

TEST_F(ClockRatioTest, WholeTimeLineIsJudged) {
    verifies("SWR-RED-011", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::int64_t kEarliest = std::numeric_limits<std::int64_t>::min();
    constexpr std::int64_t kLatest = std::numeric_limits<std::int64_t>::max();
    ASSERT_EQ(step(kEarliest, kEarliest), ClockVerdict::kMeasuring);
    EXPECT_EQ(step(kLatest, kLatest), ClockVerdict::kGood);

    ClockRatio other({Duration{1}, 999999U});
    ASSERT_EQ(other.step(Instant{kEarliest}, Instant{0}), ClockVerdict::kMeasuring);
    EXPECT_EQ(other.step(Instant{kLatest}, Instant{0}), ClockVerdict::kViolated);
}

TEST_F(ClockRatioTest, AcknowledgementBeginsAnew) {
    verifies("SWR-RED-011", Technique::kStateTransition, Polarity::kViolation);
    EXPECT_EQ(sut_.acknowledge(), Status::kPreconditionNotMet);
    ASSERT_EQ(step(0, 0), ClockVerdict::kMeasuring);
    ASSERT_EQ(step(1000000, 0), ClockVerdict::kViolated);

    EXPECT_EQ(sut_.acknowledge(), Status::kOk);
    EXPECT_EQ(step(1000000, 0), ClockVerdict::kMeasuring);
    EXPECT_EQ(step(2000000, 1000000), ClockVerdict::kGood);
}

TEST_F(ClockRatioTest, LimitsAreInsideTheirRange) {
    verifies("SWR-RED-011", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_TRUE(is_valid(ClockRatioLimits{Duration{1}, 1U}));
    EXPECT_TRUE(is_valid(ClockRatioLimits{Duration{1}, 999999U}));
    EXPECT_FALSE(is_valid(ClockRatioLimits{Duration{0}, 1U}));
    EXPECT_FALSE(is_valid(ClockRatioLimits{Duration{1}, 0U}));
    EXPECT_FALSE(is_valid(ClockRatioLimits{Duration{1}, 1000000U}));
}

TEST_F(ClockRatioTest, LimitsOutsideTheirRangeGoToTheAssertionHandler) {
    verifies("SWR-RED-011", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS((ClockRatio{{Duration{0}, 1U}}), "clock_ratio.hpp", 1);
    EXPECT_CHECK_FAILS((ClockRatio{{Duration{1}, 0U}}), "clock_ratio.hpp", 1);
    EXPECT_CHECK_FAILS((ClockRatio{{Duration{1}, 1000000U}}), "clock_ratio.hpp", 1);
}

class TimeBaseCheckTest : public ::testing::Test {
  protected:
    /// Both clocks run alike.
    TimeBaseFinding step(std::uint32_t own, std::uint32_t other) {
        now_ns_ += 1000;
        return sut_.step({own, Instant{now_ns_}}, {other, Instant{now_ns_}});
    }

    std::int64_t now_ns_{0};
    TimeBaseCheck sut_{{2U, kClocks}};
};

TEST_F(TimeBaseCheckTest, ChannelsUpToTheirDistanceApartAreGood) {
    verifies("SWR-RED-010", Technique::kBoundaryValues);

    EXPECT_EQ(step(7U, 7U), TimeBaseFinding::kNone);
    EXPECT_EQ(step(8U, 10U), TimeBaseFinding::kNone);
    EXPECT_EQ(step(12U, 10U), TimeBaseFinding::kNone);
    EXPECT_EQ(step(12U, 10U), TimeBaseFinding::kNone) << "to stand still is no step back";
    EXPECT_EQ(sut_.get_finding(), TimeBaseFinding::kNone);
}

TEST_F(TimeBaseCheckTest, CountersMayWrap) {
    verifies("SWR-RED-010", Technique::kBoundaryValues);

    EXPECT_EQ(step(0xFFFFFFFEU, 0xFFFFFFFFU), TimeBaseFinding::kNone);
    EXPECT_EQ(step(0xFFFFFFFFU, 1U), TimeBaseFinding::kNone);
    EXPECT_EQ(step(3U, 1U), TimeBaseFinding::kNone);
}

TEST_F(TimeBaseCheckTest, ChannelsFurtherApartAreFound) {
    verifies("SWR-RED-010", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(step(7U, 9U), TimeBaseFinding::kNone);
    EXPECT_EQ(step(7U, 10U), TimeBaseFinding::kCyclesApart);
    EXPECT_EQ(step(10U, 10U), TimeBaseFinding::kCyclesApart) << "it does not heal";

    ASSERT_EQ(sut_.acknowledge(), Status::kOk);
    EXPECT_EQ(step(1U, 0xFFFFFFFEU), TimeBaseFinding::kCyclesApart) << "three over the wrap";
    ASSERT_EQ(sut_.acknowledge(), Status::kOk);
    EXPECT_EQ(step(0U, 0x80000000U), TimeBaseFinding::kCyclesApart) << "as far as can be";
}

TEST_F(TimeBaseCheckTest, ChannelThatStandsStillIsFound) {
    verifies("SWR-RED-010", Technique::kFaultInjection, Polarity::kViolation);

    ASSERT_EQ(step(1U, 1U), TimeBaseFinding::kNone);
    ASSERT_EQ(step(2U, 1U), TimeBaseFinding::kNone);
    ASSERT_EQ(step(3U, 1U), TimeBaseFinding::kNone);
    EXPECT_EQ(step(4U, 1U), TimeBaseFinding::kCyclesApart);
}

TEST_F(TimeBaseCheckTest, CounterThatGoesBackIsFoundInEitherChannel) {
    verifies("SWR-RED-010", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(step(5U, 5U), TimeBaseFinding::kNone);
    EXPECT_EQ(step(4U, 5U), TimeBaseFinding::kSteppedBack);

    ASSERT_EQ(sut_.acknowledge(), Status::kOk);
    ASSERT_EQ(step(5U, 5U), TimeBaseFinding::kNone);
    EXPECT_EQ(step(5U, 4U), TimeBaseFinding::kSteppedBack);
}

TEST_F(TimeBaseCheckTest, StepOfHalfTheCounterIsOneBack) {
    verifies("SWR-RED-010", Technique::kBoundaryValues, Polarity::kViolation);
    TimeBaseCheck sut({1U << 30U, kClocks});
    ASSERT_EQ(sut.step({0U, {}}, {0x40000000U, {}}), TimeBaseFinding::kNone);
    ASSERT_EQ(sut.step({0x7FFFFFFFU, {}}, {0x7FFFFFFFU, {}}), TimeBaseFinding::kNone);
    EXPECT_EQ(sut.step({0xFFFFFFFFU, {}}, {0x80000000U, {}}), TimeBaseFinding::kSteppedBack);

    ASSERT_EQ(sut.acknowledge(), Status::kOk);
    ASSERT_EQ(sut.step({0U, {}}, {0U, {}}), TimeBaseFinding::kNone);
    EXPECT_EQ(sut.step({0x7FFFFFFFU, {}}, {0x80000000U, {}}), TimeBaseFinding::kSteppedBack);
}

TEST_F(TimeBaseCheckTest, FirstStepHasNothingToGoBackFrom) {
    verifies("SWR-RED-010", Technique::kErrorGuessing);

    EXPECT_EQ(step(0xFFFFFFF0U, 0xFFFFFFF0U), TimeBaseFinding::kNone);
}

TEST_F(TimeBaseCheckTest, ClocksApartAreFound) {
    verifies("SWR-RED-011", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.step({1U, Instant{0}}, {1U, Instant{0}}), TimeBaseFinding::kNone);
    ASSERT_EQ(sut_.step({1U, Instant{1000000}}, {1U, Instant{1000100}}), TimeBaseFinding::kNone);
    ASSERT_EQ(sut_.step({1U, Instant{2000000}}, {1U, Instant{2000201}}), TimeBaseFinding::kClocksApart);

    EXPECT_EQ(sut_.step({1U, Instant{3000000}}, {1U, Instant{3000201}}), TimeBaseFinding::kClocksApart);
    EXPECT_EQ(sut_.acknowledge(), Status::kOk);
    EXPECT_EQ(sut_.acknowledge(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.step({1U, Instant{4000000}}, {1U, Instant{9000000}}), TimeBaseFinding::kNone);
}

TEST_F(TimeBaseCheckTest, DistanceBeyondHalfTheCounterGoesToTheAssertionHandler) {
    verifies("SWR-RED-010", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS((TimeBaseCheck{{(1U << 30U) + 1U, kClocks}}), "time_base_check.hpp", 1);
    static_cast<void>(TimeBaseCheck{{1U << 30U, kClocks}});
}

}  // namespace
}  // namespace mamori::safety

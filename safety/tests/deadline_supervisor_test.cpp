// SPDX-License-Identifier: Apache-2.0
// Goal: every run is judged, one that never ends too, and no later checkpoint hides a violation.
// Method: both sides of each limit, the three known ways to lose a violation, ends of the time line.
#include "mamori/safety/supervision/deadline_supervisor.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using literals::operator""_ns;
using literals::operator""_s;

class DeadlineSupervisorTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_EQ(sut_.watch(0U, {10_ns, 100_ns}), Status::kOk); }

    void run(std::int64_t from_ns, std::int64_t to_ns) {
        ASSERT_EQ(sut_.start(0U, Instant{from_ns}), Status::kOk);
        ASSERT_EQ(sut_.finish(0U, Instant{to_ns}), Status::kOk);
    }

    std::array<DeadlineSlot, 2U> slots_{};
    DeadlineSupervisor sut_{slots_};
};

TEST_F(DeadlineSupervisorTest, RunsInsideTheLimitsAreHealthyBothEndsIncluded) {
    verifies("SWR-SUP-003", Technique::kBoundaryValues);

    run(0, 10);
    EXPECT_FALSE(sut_.step(Instant{10}));
    run(1000, 1100);
    EXPECT_FALSE(sut_.step(Instant{1100}));
    EXPECT_EQ(sut_.get_violation(0U), DeadlineViolation::kNone);
}

TEST_F(DeadlineSupervisorTest, StorageThatWasUsedBeforeIsCleared) {
    verifies("SWR-SUP-003", Technique::kErrorGuessing, Polarity::kViolation);
    slots_[1].is_running = true;
    slots_[1].violation = DeadlineViolation::kTooLong;
    slots_[1].is_expired = true;

    ASSERT_EQ(sut_.watch(1U, {10_ns, 100_ns}), Status::kOk);
    EXPECT_EQ(sut_.get_violation(1U), DeadlineViolation::kNone);
    EXPECT_FALSE(sut_.step(Instant{1000}));
    EXPECT_FALSE(sut_.is_expired(1U));
}

TEST_F(DeadlineSupervisorTest, RunThatIsTooLongExpires) {
    verifies("SWR-SUP-003", Technique::kBoundaryValues, Polarity::kViolation);

    run(0, 101);
    EXPECT_FALSE(sut_.is_expired(0U)) << "judged by step() only";
    EXPECT_TRUE(sut_.step(Instant{101}));
    EXPECT_TRUE(sut_.is_expired(0U));
    EXPECT_EQ(sut_.get_violation(0U), DeadlineViolation::kTooLong);
}

TEST_F(DeadlineSupervisorTest, RunThatIsTooShortExpires) {
    verifies("SWR-SUP-003", Technique::kBoundaryValues, Polarity::kViolation);

    run(0, 9);
    EXPECT_TRUE(sut_.step(Instant{9}));
    EXPECT_EQ(sut_.get_violation(0U), DeadlineViolation::kTooShort);
}

TEST_F(DeadlineSupervisorTest, FinishWithoutStartExpires) {
    verifies("SWR-SUP-003", Technique::kErrorGuessing, Polarity::kViolation);

    ASSERT_EQ(sut_.finish(0U, Instant{50}), Status::kOk);
    EXPECT_TRUE(sut_.step(Instant{50}));
    EXPECT_EQ(sut_.get_violation(0U), DeadlineViolation::kMissingStart);
}

TEST_F(DeadlineSupervisorTest, RefusesLimitsAndSlotsOutOfRange) {
    verifies("SWR-SUP-003", Technique::kInterface, Polarity::kViolation);

    EXPECT_EQ(sut_.watch(2U, {0_ns, 1_ns}), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(1U, {Duration{-1}, 1_ns}), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(1U, {2_ns, 1_ns}), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(1U, {0_ns, 0_ns}), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(0U, {0_ns, 1_s}), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.start(1U, Instant{0}), Status::kBadParameter);
    EXPECT_EQ(sut_.start(2U, Instant{0}), Status::kBadParameter);
    EXPECT_EQ(sut_.finish(1U, Instant{0}), Status::kBadParameter);
    EXPECT_EQ(sut_.acknowledge(1U), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(1U, {1_ns, 1_ns}), Status::kOk);
    EXPECT_FALSE(sut_.step(Instant{0}));
}

TEST_F(DeadlineSupervisorTest, LimitsThatWereLeftOutAreRefused) {
    verifies("SWR-SUP-003", Technique::kEquivalenceClasses, Polarity::kViolation);

    EXPECT_EQ(sut_.watch(1U, {}), Status::kBadParameter);
    EXPECT_EQ(DeadlineLimits{}.shortest, 0_ns);
    EXPECT_EQ(DeadlineLimits{}.longest, 0_ns);
}

TEST_F(DeadlineSupervisorTest, StorageOutsideItsSizesGoesToTheAssertionHandler) {
    verifies("SWR-SUP-003", Technique::kErrorGuessing, Polarity::kViolation);

    std::vector<DeadlineSlot> slots(65536U);
    EXPECT_CHECK_FAILS(DeadlineSupervisor{Span<DeadlineSlot>{}}, "deadline_supervisor.hpp", 1);
    EXPECT_CHECK_FAILS((DeadlineSupervisor{Span<DeadlineSlot>{slots.data(), 65536U}}),
                       "deadline_supervisor.hpp", 1);
    EXPECT_EQ((DeadlineSupervisor{Span<DeadlineSlot>{slots.data(), 65535U}}.watch(65534U, {1_ns, 2_ns})),
              Status::kOk);
}

TEST_F(DeadlineSupervisorTest, RunThatIsStillUnderWayAtItsLimitIsHealthy) {
    verifies("SWR-SUP-004", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.start(0U, Instant{0}), Status::kOk);

    EXPECT_FALSE(sut_.step(Instant{99}));
    EXPECT_FALSE(sut_.step(Instant{100}));
    ASSERT_EQ(sut_.finish(0U, Instant{100}), Status::kOk);
    EXPECT_FALSE(sut_.step(Instant{1000000})) << "a run that has ended does not age";
}

TEST_F(DeadlineSupervisorTest, StartWhoseFinishNeverComesExpiresRightAfterItsLimit) {
    verifies("SWR-SUP-004", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.start(0U, Instant{0}), Status::kOk);
    ASSERT_FALSE(sut_.step(Instant{100}));

    EXPECT_TRUE(sut_.step(Instant{101}));
    EXPECT_EQ(sut_.get_violation(0U), DeadlineViolation::kMissingFinish);
}

TEST_F(DeadlineSupervisorTest, StartWithoutFinishExpiresWithinOneCycleOfHundredSeconds) {
    verifies("SWR-SUP-004", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(1U, {0_ns, 1_s}), Status::kOk);
    ASSERT_EQ(sut_.start(1U, Instant{0}), Status::kOk);

    for (std::int64_t cycle = 1; cycle <= 100; ++cycle) {
        const bool is_expired = sut_.step(Instant{0} + 1_s * cycle);
        ASSERT_EQ(is_expired, cycle > 1) << "cycle " << cycle;
    }
}

TEST_F(DeadlineSupervisorTest, StartAnewWithoutFinishExpires) {
    verifies("SWR-SUP-004", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.start(0U, Instant{0}), Status::kOk);
    run(50, 70);

    EXPECT_TRUE(sut_.step(Instant{70}));
    EXPECT_EQ(sut_.get_violation(0U), DeadlineViolation::kMissingFinish);
}

TEST_F(DeadlineSupervisorTest, LateFinishFollowedByLegalRunsBeforeTheStepStaysExpired) {
    verifies("SWR-SUP-005", Technique::kFaultInjection, Polarity::kViolation);
    run(0, 5000);
    run(6000, 6050);
    run(7000, 7050);

    EXPECT_TRUE(sut_.step(Instant{7050}));
    EXPECT_EQ(sut_.get_violation(0U), DeadlineViolation::kTooLong);
}

TEST_F(DeadlineSupervisorTest, IllegalFinishFollowedByALegalRunBeforeTheStepStaysExpired) {
    verifies("SWR-SUP-005", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.finish(0U, Instant{0}), Status::kOk);
    run(10, 30);

    EXPECT_TRUE(sut_.step(Instant{30}));
    EXPECT_EQ(sut_.get_violation(0U), DeadlineViolation::kMissingStart);
}

TEST_F(DeadlineSupervisorTest, ExpiredEntityStaysExpiredThroughLegalRuns) {
    verifies("SWR-SUP-005", Technique::kFaultInjection, Polarity::kViolation);
    run(0, 101);
    ASSERT_TRUE(sut_.step(Instant{101}));

    for (std::int64_t cycle = 1; cycle <= 100; ++cycle) {
        run(cycle * 1000, cycle * 1000 + 50);
        ASSERT_TRUE(sut_.step(Instant{cycle * 1000 + 50}));
    }
}

TEST_F(DeadlineSupervisorTest, AcknowledgementIsTheOnlyWayBack) {
    verifies("SWR-SUP-005");
    EXPECT_EQ(sut_.acknowledge(0U), Status::kPreconditionNotMet);
    ASSERT_EQ(sut_.start(0U, Instant{0}), Status::kOk);
    ASSERT_TRUE(sut_.step(Instant{101}));

    ASSERT_EQ(sut_.acknowledge(0U), Status::kOk);
    EXPECT_FALSE(sut_.step(Instant{5000})) << "the lost run is forgotten";
    run(6000, 6050);
    EXPECT_FALSE(sut_.step(Instant{6050}));
    run(7000, 7101);
    EXPECT_TRUE(sut_.step(Instant{7101})) << "and supervision goes on";
}

TEST_F(DeadlineSupervisorTest, TickZeroIsAnInstantLikeAnyOther) {
    verifies("SWR-SUP-006", Technique::kBoundaryValues);

    run(0, 50);
    EXPECT_FALSE(sut_.step(Instant{50}));
    run(-50, 0);
    EXPECT_FALSE(sut_.step(Instant{0}));
}

TEST_F(DeadlineSupervisorTest, ClockThatRunsBackwardsExpiresTheRun) {
    verifies("SWR-SUP-006", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.start(0U, Instant{1000}), Status::kOk);

    EXPECT_TRUE(sut_.step(Instant{999}));
}

TEST_F(DeadlineSupervisorTest, LongestPossibleDistanceDoesNotWrapIntoTheLimits) {
    verifies("SWR-SUP-006", Technique::kBoundaryValues, Polarity::kViolation);

    run(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
    EXPECT_TRUE(sut_.step(Instant{std::numeric_limits<std::int64_t>::max()}));
    EXPECT_EQ(sut_.get_violation(0U), DeadlineViolation::kTooLong);
}

}  // namespace
}  // namespace mamori::safety

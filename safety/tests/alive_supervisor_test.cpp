// SPDX-License-Identifier: Apache-2.0
// Goal: silence is judged against its limits, worst first, and an expired entity cannot be talked healthy.
// Method: both sides of each limit, each status, repetition after a failure, full storage.
#include "mamori/safety/supervision/alive_supervisor.hpp"

#include <array>
#include <vector>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

class AliveSupervisorTest : public ::testing::Test {
  protected:
    void step_silently(std::size_t cycles) {
        for (std::size_t i = 0U; i < cycles; ++i) {
            static_cast<void>(sut_.step());
        }
    }

    std::array<AliveSlot, 3U> slots_{};
    AliveSupervisor sut_{slots_};
};

TEST_F(AliveSupervisorTest, EntityThatReportsInEachCycleStaysHealthy) {
    verifies("SWR-SUP-001");
    ASSERT_EQ(sut_.watch(0U, {1U, 1U}), Status::kOk);

    for (int cycle = 0; cycle < 1000; ++cycle) {
        ASSERT_EQ(sut_.report_alive(0U), Status::kOk);
        ASSERT_EQ(sut_.step(), AliveVerdict::kHealthy);
    }
}

TEST_F(AliveSupervisorTest, SilenceIsLateAtItsFirstLimitAndExpiredAtItsSecond) {
    verifies("SWR-SUP-001", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(0U, {2U, 4U}), Status::kOk);

    EXPECT_EQ(sut_.step(), AliveVerdict::kHealthy);
    EXPECT_EQ(sut_.step(), AliveVerdict::kLate);
    EXPECT_EQ(sut_.step(), AliveVerdict::kLate);
    EXPECT_EQ(sut_.step(), AliveVerdict::kExpired);
}

TEST_F(AliveSupervisorTest, EqualLimitsGiveTheSevererVerdict) {
    verifies("SWR-SUP-001", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(0U, {2U, 2U}), Status::kOk);

    EXPECT_EQ(sut_.step(), AliveVerdict::kHealthy);
    EXPECT_EQ(sut_.step(), AliveVerdict::kExpired);
}

TEST_F(AliveSupervisorTest, ReportInTimeBeginsTheCountAnew) {
    verifies("SWR-SUP-001", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.watch(0U, {2U, 3U}), Status::kOk);
    step_silently(2U);
    ASSERT_EQ(sut_.get_verdict(0U), AliveVerdict::kLate);

    ASSERT_EQ(sut_.report_alive(0U), Status::kOk);
    EXPECT_EQ(sut_.step(), AliveVerdict::kHealthy);
    EXPECT_EQ(sut_.step(), AliveVerdict::kHealthy);
    EXPECT_EQ(sut_.step(), AliveVerdict::kLate);
}

TEST_F(AliveSupervisorTest, ManyReportsInOneCycleCountForThatCycleOnly) {
    verifies("SWR-SUP-001", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(0U, {1U, 2U}), Status::kOk);
    for (int i = 0; i < 100; ++i) {
        ASSERT_EQ(sut_.report_alive(0U), Status::kOk);
    }

    EXPECT_EQ(sut_.step(), AliveVerdict::kHealthy);
    EXPECT_EQ(sut_.step(), AliveVerdict::kLate);
    EXPECT_EQ(sut_.step(), AliveVerdict::kExpired);
}

TEST_F(AliveSupervisorTest, WorstOfAllEntitiesIsReported) {
    verifies("SWR-SUP-001", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(0U, {5U, 9U}), Status::kOk);
    ASSERT_EQ(sut_.watch(1U, {1U, 2U}), Status::kOk);
    ASSERT_EQ(sut_.watch(2U, {1U, 9U}), Status::kOk);

    EXPECT_EQ(sut_.step(), AliveVerdict::kLate);
    EXPECT_EQ(sut_.step(), AliveVerdict::kExpired);
    EXPECT_EQ(sut_.get_verdict(0U), AliveVerdict::kHealthy);
    EXPECT_EQ(sut_.get_verdict(1U), AliveVerdict::kExpired);
    EXPECT_EQ(sut_.get_verdict(2U), AliveVerdict::kLate);
}

TEST_F(AliveSupervisorTest, NothingIsSupervisedBeforeWatch) {
    verifies("SWR-SUP-001", Technique::kErrorGuessing);

    EXPECT_EQ(sut_.step(), AliveVerdict::kHealthy);
    EXPECT_FALSE(sut_.is_active(0U));
    EXPECT_EQ(sut_.report_alive(0U), Status::kBadParameter);
}

TEST_F(AliveSupervisorTest, RefusesLimitsAndSlotsOutOfRange) {
    verifies("SWR-SUP-001", Technique::kInterface, Polarity::kViolation);

    EXPECT_EQ(sut_.watch(3U, {1U, 1U}), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(0U, {0U, 1U}), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(0U, {2U, 1U}), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(2U, {1U, 1U}), Status::kOk);
    EXPECT_EQ(sut_.watch(2U, {1U, 5U}), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.report_alive(3U), Status::kBadParameter);
    EXPECT_EQ(sut_.step(), AliveVerdict::kExpired) << "a refused watch() must not change the limits in use";
}

TEST_F(AliveSupervisorTest, LimitsThatNobodySetAreRefusedAndStorageIsFree) {
    verifies("SWR-SUP-001", Technique::kInterface, Polarity::kViolation);
    constexpr AliveSlot kFresh{};

    EXPECT_EQ(kFresh.limits.late_cycles, 0U);
    EXPECT_EQ(kFresh.limits.expired_cycles, 0U);
    EXPECT_EQ(kFresh.silent_cycles, 0U);
    EXPECT_FALSE(kFresh.has_reported);
    EXPECT_EQ(kFresh.state, AliveSlot::State::kFree);
    EXPECT_EQ(sut_.watch(0U, AliveLimits{}), Status::kBadParameter);
}

TEST_F(AliveSupervisorTest, StorageOutsideItsSizesGoesToTheAssertionHandler) {
    verifies("SWR-SUP-001", Technique::kErrorGuessing, Polarity::kViolation);

    std::vector<AliveSlot> slots(65536U);
    EXPECT_CHECK_FAILS(AliveSupervisor{Span<AliveSlot>{}}, "alive_supervisor.hpp", 1);
    EXPECT_CHECK_FAILS((AliveSupervisor{Span<AliveSlot>{slots.data(), 65536U}}), "alive_supervisor.hpp", 1);
    EXPECT_EQ((AliveSupervisor{Span<AliveSlot>{slots.data(), 65535U}}.watch(65534U, {1U, 1U})), Status::kOk);
}

TEST_F(AliveSupervisorTest, ExpiredEntityStaysExpiredEvenIfItReportsAgain) {
    verifies("SWR-SUP-002", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(0U, {1U, 2U}), Status::kOk);
    step_silently(2U);

    for (int cycle = 0; cycle < 1000; ++cycle) {
        ASSERT_EQ(sut_.report_alive(0U), Status::kOk);
        ASSERT_EQ(sut_.step(), AliveVerdict::kExpired);
    }
}

TEST_F(AliveSupervisorTest, ExpiredEntityCannotBeHiddenBySwitchingItOff) {
    verifies("SWR-SUP-002", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(0U, {1U, 1U}), Status::kOk);
    step_silently(1U);

    EXPECT_EQ(sut_.deactivate(0U), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.activate(0U), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.watch(0U, {9U, 9U}), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.step(), AliveVerdict::kExpired);
}

TEST_F(AliveSupervisorTest, AcknowledgedEntityIsSupervisedAgain) {
    verifies("SWR-SUP-002");
    ASSERT_EQ(sut_.watch(0U, {1U, 2U}), Status::kOk);
    EXPECT_EQ(sut_.acknowledge(0U), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.acknowledge(1U), Status::kBadParameter);
    step_silently(2U);

    ASSERT_EQ(sut_.acknowledge(0U), Status::kOk);
    EXPECT_EQ(sut_.step(), AliveVerdict::kLate);
    EXPECT_EQ(sut_.step(), AliveVerdict::kExpired);
}

TEST_F(AliveSupervisorTest, InactiveEntityMayBeSilentAndStartsFreshWhenActivated) {
    verifies("SWR-SUP-002", Technique::kStateTransition);
    ASSERT_EQ(sut_.watch(0U, {1U, 2U}), Status::kOk);
    step_silently(1U);
    ASSERT_EQ(sut_.deactivate(0U), Status::kOk);
    EXPECT_EQ(sut_.deactivate(0U), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.deactivate(1U), Status::kBadParameter);
    EXPECT_EQ(sut_.activate(1U), Status::kBadParameter);
    step_silently(100U);
    EXPECT_EQ(sut_.get_verdict(0U), AliveVerdict::kHealthy);
    ASSERT_EQ(sut_.report_alive(0U), Status::kOk);

    ASSERT_EQ(sut_.activate(0U), Status::kOk);
    EXPECT_EQ(sut_.step(), AliveVerdict::kLate) << "a report while inactive is not a sign of life of now";
    EXPECT_EQ(sut_.step(), AliveVerdict::kExpired);
}

}  // namespace
}  // namespace mamori::safety

// SPDX-License-Identifier: Apache-2.0
// Goal: the machine hears of a pass only when every test ended one in time, and of a failure for good.
// Method: scripted tests that pass, fail, end too early or too late; both sides of the interval.
#include "mamori/safety/self_test/schedule.hpp"

#include <array>
#include <limits>

#include "mamori/safety/reaction/safe_state_machine.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

/// Declares `count` steps, and ends after `length` of them with `result`.
class FakeTest final : public SelfTest {
  public:
    explicit FakeTest(std::size_t count) : count_(count), length(count) {}
    void begin() noexcept override { step_ = 0U; }
    SelfTestStatus step() noexcept override {
        ++step_;
        ++steps;
        return step_ == length ? result : SelfTestStatus::kRunning;
    }
    std::size_t get_step_count() const noexcept override { return count_; }

  private:
    std::size_t count_;
    std::size_t step_{0U};

  public:
    std::size_t length;
    std::size_t steps{0U};
    SelfTestStatus result{SelfTestStatus::kPassed};
};

constexpr Duration kPeriod{10};

class SelfTestScheduleTest : public ::testing::Test {
  protected:
    /// One step per period from time 0 on.
    SelfTestStatus step() {
        const SelfTestStatus status = sut_.step(Instant{now_ns_});
        now_ns_ += kPeriod.ns;
        return status;
    }
    void start() { ASSERT_EQ(sut_.start(Instant{now_ns_}, kPeriod), Status::kOk); }
    void pass() {
        for (std::size_t i = 0U; i < 4U; ++i) {
            ASSERT_EQ(step(), SelfTestStatus::kRunning) << i;
        }
        ASSERT_EQ(step(), SelfTestStatus::kPassed);
    }

    FakeTest first_{2U};
    FakeTest second_{3U};
    std::array<SelfTest*, 2U> tests_{{&first_, &second_}};
    Span<SelfTest* const> span_{tests_.data(), tests_.size()};
    SelfTestSchedule sut_{span_, Duration{60}};
    std::int64_t now_ns_{0};
};

TEST_F(SelfTestScheduleTest, ScheduleThatHasNotStartedIsAtItsFirstTest) {
    verifies("SWR-SLF-001", Technique::kInterface);

    EXPECT_EQ(sut_.get_test(), 0U);
    EXPECT_EQ(sut_.get_pass_count(), 0U);
    EXPECT_EQ(sut_.get_status(), SelfTestStatus::kRunning);
    EXPECT_EQ(sut_.get_failure(), SelfTestFailure::kNone);
}

TEST_F(SelfTestScheduleTest, RunsUntilEveryTestHasPassedAndStaysPassedWhilePassesFollow) {
    verifies("SWR-SLF-001");
    start();
    EXPECT_EQ(sut_.calc_step_count(), 5U);
    EXPECT_EQ(sut_.get_status(), SelfTestStatus::kRunning);

    pass();
    EXPECT_EQ(sut_.get_pass_count(), 1U);
    for (std::size_t i = 0U; i < 5U; ++i) {
        EXPECT_EQ(sut_.get_test(), i < 2U ? 0U : 1U);
        ASSERT_EQ(step(), SelfTestStatus::kPassed) << i;
    }
    EXPECT_EQ(sut_.get_pass_count(), 2U);
    EXPECT_EQ(first_.steps, 4U);
    EXPECT_EQ(second_.steps, 6U);
}

TEST_F(SelfTestScheduleTest, NothingPassesBeforeItIsStarted) {
    verifies("SWR-SLF-001", Technique::kErrorGuessing, Polarity::kViolation);

    for (std::size_t i = 0U; i < 20U; ++i) {
        EXPECT_EQ(step(), SelfTestStatus::kRunning);
    }
    EXPECT_EQ(first_.steps, 0U);
}

TEST_F(SelfTestScheduleTest, RestartBeginsAFreshPass) {
    verifies("SWR-SLF-001", Technique::kStateTransition, Polarity::kViolation);
    start();
    pass();
    ASSERT_EQ(step(), SelfTestStatus::kPassed);

    start();
    EXPECT_EQ(sut_.get_status(), SelfTestStatus::kRunning)
        << "the pass of an earlier visit lets nobody through";
    pass();
}

TEST_F(SelfTestScheduleTest, MachineLeavesItsSelfTestByAWholePassOnly) {
    verifies("SWR-SLF-001", Technique::kInterface);
    SafeStateMachine machine({Duration{100}, Duration{100}});
    SafeStateInputs inputs;
    inputs.demand = Reaction::kNone;
    start();

    for (std::size_t i = 0U; i < 4U; ++i) {
        inputs.self_test = step();
        ASSERT_EQ(machine.step(inputs), SafeState::kSelfTest);
    }
    inputs.self_test = step();
    EXPECT_EQ(machine.step(inputs), SafeState::kStandby);
    second_.result = SelfTestStatus::kFailed;
    for (std::size_t i = 0U; i < 5U; ++i) {
        inputs.self_test = step();
        static_cast<void>(machine.step(inputs));
    }
    EXPECT_EQ(machine.get_state(), SafeState::kLockedOut);
}

TEST_F(SelfTestScheduleTest, FaultIsLatchedAndItsTestNamed) {
    verifies("SWR-SLF-002", Technique::kFaultInjection, Polarity::kViolation);
    second_.result = SelfTestStatus::kFailed;
    second_.length = 1U;
    start();
    ASSERT_EQ(step(), SelfTestStatus::kRunning);
    ASSERT_EQ(step(), SelfTestStatus::kRunning);

    EXPECT_EQ(step(), SelfTestStatus::kFailed);
    EXPECT_EQ(sut_.get_failure(), SelfTestFailure::kFault);
    EXPECT_EQ(sut_.get_test(), 1U);
    second_.result = SelfTestStatus::kPassed;
    EXPECT_EQ(step(), SelfTestStatus::kFailed) << "it does not heal";
    EXPECT_EQ(second_.steps, 1U) << "nothing is tested any more";
    EXPECT_EQ(sut_.start(Instant{now_ns_}, kPeriod), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.get_status(), SelfTestStatus::kFailed);
}

TEST_F(SelfTestScheduleTest, CorruptedResultIsAFault) {
    verifies("SWR-SLF-002", Technique::kFaultInjection, Polarity::kViolation);
    first_.result = static_cast<SelfTestStatus>(77);
    start();
    ASSERT_EQ(step(), SelfTestStatus::kRunning);

    EXPECT_EQ(step(), SelfTestStatus::kFailed);
    EXPECT_EQ(sut_.get_failure(), SelfTestFailure::kFault);
}

TEST_F(SelfTestScheduleTest, SoundTestsHaveNoFailure) {
    verifies("SWR-SLF-002");
    start();
    pass();

    EXPECT_EQ(sut_.get_failure(), SelfTestFailure::kNone);
}

TEST_F(SelfTestScheduleTest, PassThatEndsAtTheIntervalIsInTime) {
    verifies("SWR-SLF-003", Technique::kBoundaryValues);
    start();
    for (std::size_t i = 0U; i < 4U; ++i) {
        ASSERT_EQ(step(), SelfTestStatus::kRunning);
    }

    EXPECT_EQ(sut_.step(Instant{60}), SelfTestStatus::kPassed);
    for (std::size_t i = 0U; i < 4U; ++i) {
        ASSERT_EQ(sut_.step(Instant{70}), SelfTestStatus::kPassed);
    }
    EXPECT_EQ(sut_.step(Instant{120}), SelfTestStatus::kPassed);
    EXPECT_EQ(sut_.get_pass_count(), 2U);
}

TEST_F(SelfTestScheduleTest, IntervalBeginsWithTheStart) {
    verifies("SWR-SLF-003", Technique::kBoundaryValues);
    now_ns_ = 100000;
    start();

    pass();
}

TEST_F(SelfTestScheduleTest, PassThatEndsAfterTheIntervalIsAFailure) {
    verifies("SWR-SLF-003", Technique::kBoundaryValues, Polarity::kViolation);
    start();
    for (std::size_t i = 0U; i < 4U; ++i) {
        ASSERT_EQ(step(), SelfTestStatus::kRunning);
    }

    EXPECT_EQ(sut_.step(Instant{61}), SelfTestStatus::kFailed);
    EXPECT_EQ(sut_.get_failure(), SelfTestFailure::kOverdue);
    EXPECT_EQ(sut_.get_test(), 1U) << "the one that did not end";
}

TEST_F(SelfTestScheduleTest, LaterPassThatIsOverdueIsAFailure) {
    verifies("SWR-SLF-003", Technique::kBoundaryValues, Polarity::kViolation);
    start();
    pass();  // ends at 40

    EXPECT_EQ(sut_.step(Instant{101}), SelfTestStatus::kFailed);
    EXPECT_EQ(sut_.get_failure(), SelfTestFailure::kOverdue);
}

TEST_F(SelfTestScheduleTest, ClockThatRunsBackwardsIsAFailure) {
    verifies("SWR-SLF-003", Technique::kFaultInjection, Polarity::kViolation);
    now_ns_ = 100;
    start();

    EXPECT_EQ(sut_.step(Instant{99}), SelfTestStatus::kFailed);
    EXPECT_EQ(sut_.get_failure(), SelfTestFailure::kOverdue);
}

TEST_F(SelfTestScheduleTest, TestsThatFitIntoTheirIntervalMayStart) {
    verifies("SWR-SLF-003", Technique::kBoundaryValues);

    EXPECT_EQ(sut_.start(Instant{0}, Duration{12}), Status::kOk) << "five steps in 60";
    EXPECT_EQ(sut_.start(Instant{0}, Duration{1}), Status::kOk);
}

TEST_F(SelfTestScheduleTest, TestsThatDoNotFitIntoTheirIntervalDoNotStart) {
    verifies("SWR-SLF-003", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(sut_.start(Instant{0}, Duration{13}), Status::kBadParameter);
    EXPECT_EQ(sut_.start(Instant{0}, Duration{0}), Status::kBadParameter);
    EXPECT_EQ(sut_.start(Instant{0}, Duration{-1}), Status::kBadParameter);
    EXPECT_EQ(step(), SelfTestStatus::kRunning);
    EXPECT_EQ(first_.steps, 0U);
}

TEST_F(SelfTestScheduleTest, TestOfTheRightLengthIsNoFailure) {
    verifies("SWR-SLF-004");
    start();
    pass();

    EXPECT_EQ(sut_.get_failure(), SelfTestFailure::kNone);
}

TEST_F(SelfTestScheduleTest, TestThatEndsEarlyIsAFailure) {
    verifies("SWR-SLF-004", Technique::kFaultInjection, Polarity::kViolation);
    first_.length = 1U;
    start();

    EXPECT_EQ(step(), SelfTestStatus::kFailed);
    EXPECT_EQ(sut_.get_failure(), SelfTestFailure::kStepCount);
    EXPECT_EQ(sut_.get_test(), 0U);
}

TEST_F(SelfTestScheduleTest, TestThatGoesOnAfterItsStepsIsAFailure) {
    verifies("SWR-SLF-004", Technique::kFaultInjection, Polarity::kViolation);
    first_.length = 3U;
    start();
    ASSERT_EQ(step(), SelfTestStatus::kRunning);

    EXPECT_EQ(step(), SelfTestStatus::kFailed);
    EXPECT_EQ(sut_.get_failure(), SelfTestFailure::kStepCount);
}

TEST_F(SelfTestScheduleTest, EmptyScheduleGoesToTheAssertionHandler) {
    verifies("SWR-SLF-001", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS((SelfTestSchedule{Span<SelfTest* const>{}, Duration{1}}), "self_test/schedule.hpp", 1);
    EXPECT_CHECK_FAILS((SelfTestSchedule{span_, Duration{0}}), "self_test/schedule.hpp", 1);
}

}  // namespace
}  // namespace mamori::safety

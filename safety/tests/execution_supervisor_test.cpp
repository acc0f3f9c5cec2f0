// SPDX-License-Identifier: Apache-2.0
// Goal: what an executive tells about its course becomes a status per component and one for the whole.
// Method: runs are noted and calls made as an executive does it, with hangs, overruns and late windows put
// in.
#include "mamori/safety/supervision/execution_supervisor.hpp"

#include <array>
#include <limits>
#include <type_traits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using literals::operator""_us;
using literals::operator""_ms;

constexpr std::size_t kControl = 0U;
constexpr std::size_t kMonitor = 1U;
constexpr std::size_t kLogger = 2U;
constexpr ComponentLimits kLimits{{2U, 3U}, {Duration{0}, 100_us}, SupervisionScope::kGlobal};
constexpr ComponentLimits kLocalLimits{{2U, 3U}, {Duration{0}, 100_us}, SupervisionScope::kLocal};

class ExecutionSupervisorTest : public ::testing::Test {
  protected:
    void run(std::size_t component, Duration duration = 50_us) {
        sut_.get_records()[component].note_run(now_, now_ + duration);
    }
    GlobalStatus end_cycle() {
        now_ = now_ + 1_ms;
        return sut_.step(now_);
    }

    Instant now_{};
    ExecutionStorage<3U> storage_{};
    ExecutionSupervisor sut_{storage_, 10_us};
};

// A supervisor of static storage needs no code before main().
ExecutionStorage<1U> g_storage{};
ExecutionSupervisor g_supervisor{g_storage, 10_us};

TEST_F(ExecutionSupervisorTest, AViolationThatIsFoundElsewhereExpiresAComponentWithItsCause) {
    verifies("SWR-CYC-014", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    ASSERT_EQ(sut_.watch(kMonitor, kLocalLimits), Status::kOk);
    const auto run_all = [this] {
        run(kControl);
        run(kMonitor);
        return end_cycle();
    };
    ASSERT_EQ(run_all(), GlobalStatus::kOk);

    sut_.expire(kMonitor, ExpiryCause::kOutOfOrder, now_);
    EXPECT_EQ(sut_.get_global_status(), GlobalStatus::kOk) << "of local scope";
    sut_.expire(kControl, ExpiryCause::kOutOfOrder, now_);
    EXPECT_EQ(sut_.get_global_status(), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_cause(kControl), ExpiryCause::kOutOfOrder);
    EXPECT_TRUE(sut_.has_just_expired(kControl));
    EXPECT_EQ(sut_.get_first_expired(), kControl);
    EXPECT_EQ(run_all(), GlobalStatus::kExpired) << "until it is acknowledged";
    EXPECT_FALSE(sut_.has_just_expired(kControl));
    ASSERT_EQ(sut_.acknowledge(kControl), Status::kOk);
    EXPECT_EQ(run_all(), GlobalStatus::kOk);
}

TEST_F(ExecutionSupervisorTest, TheCauseThatWasFoundFirstIsKept) {
    verifies("SWR-CYC-014", Technique::kEquivalenceClasses);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    run(kControl, 101_us);
    ASSERT_EQ(end_cycle(), GlobalStatus::kExpired);

    sut_.expire(kControl, ExpiryCause::kOutOfOrder, now_);
    EXPECT_EQ(sut_.get_cause(kControl), ExpiryCause::kDeadline);
}

TEST_F(ExecutionSupervisorTest, HealthyComponentsGiveOkLocallyAndGlobally) {
    verifies("SWR-SUP-007");
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    ASSERT_EQ(sut_.watch(kMonitor, kLimits), Status::kOk);

    for (int cycle = 0; cycle < 100; ++cycle) {
        run(kControl);
        run(kMonitor, 100_us);
        ASSERT_EQ(end_cycle(), GlobalStatus::kOk);
    }
    EXPECT_EQ(sut_.get_local_status(kControl), LocalStatus::kOk);
    EXPECT_EQ(sut_.get_first_expired(), ExecutionSupervisor::kNoComponent);
}

TEST_F(ExecutionSupervisorTest, SilentComponentFailsThenExpires) {
    verifies("SWR-SUP-007", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);

    EXPECT_EQ(end_cycle(), GlobalStatus::kOk);
    EXPECT_EQ(end_cycle(), GlobalStatus::kFailed);
    EXPECT_EQ(sut_.get_local_status(kControl), LocalStatus::kFailed);
    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_local_status(kControl), LocalStatus::kExpired);
    EXPECT_EQ(sut_.get_cause(kControl), ExpiryCause::kSilent);
}

TEST_F(ExecutionSupervisorTest, LateComponentRecovers) {
    verifies("SWR-SUP-007", Technique::kStateTransition);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    static_cast<void>(end_cycle());
    ASSERT_EQ(end_cycle(), GlobalStatus::kFailed);

    run(kControl);
    EXPECT_EQ(end_cycle(), GlobalStatus::kOk);
    EXPECT_EQ(sut_.get_local_status(kControl), LocalStatus::kOk);
}

TEST_F(ExecutionSupervisorTest, SlowComponentExpiresAndStaysExpired) {
    verifies("SWR-SUP-007", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    run(kControl, 101_us);
    run(kControl);
    ASSERT_EQ(end_cycle(), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_cause(kControl), ExpiryCause::kDeadline);

    for (int cycle = 0; cycle < 100; ++cycle) {
        run(kControl);
        ASSERT_EQ(end_cycle(), GlobalStatus::kExpired);
    }
}

TEST_F(ExecutionSupervisorTest, RunOutsideItsLimitsThatNoStepHasJudgedSurvivesAnAcknowledgement) {
    verifies("SWR-SUP-007", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    run(kControl, 101_us);
    ASSERT_EQ(end_cycle(), GlobalStatus::kExpired);
    run(kControl, 101_us);
    run(kControl);

    ASSERT_EQ(sut_.acknowledge(kControl), Status::kOk);
    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
}

TEST_F(ExecutionSupervisorTest, RunsBeforeWatchAreNotHeldAgainstItsLimits) {
    verifies("SWR-SUP-007", Technique::kErrorGuessing);
    run(kControl, 101_us);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    EXPECT_EQ(end_cycle(), GlobalStatus::kOk);
    EXPECT_EQ(end_cycle(), GlobalStatus::kFailed) << "nor do they count as signs of life";

    run(kControl, 101_us);
    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
}

TEST_F(ExecutionSupervisorTest, DeactivatedComponentMayBeSilentButNotSlow) {
    verifies("SWR-SUP-007", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    ASSERT_EQ(sut_.watch(kMonitor, kLimits), Status::kOk);
    for (int cycle = 0; cycle < 3; ++cycle) {
        run(kControl);
        run(kMonitor);
        ASSERT_EQ(end_cycle(), GlobalStatus::kOk);
    }
    ASSERT_EQ(sut_.deactivate(kMonitor), Status::kOk);
    EXPECT_EQ(sut_.deactivate(kMonitor), Status::kPreconditionNotMet);
    for (int cycle = 0; cycle < 5; ++cycle) {
        run(kControl);
        ASSERT_EQ(end_cycle(), GlobalStatus::kOk);
    }

    run(kControl);
    run(kMonitor, 101_us);
    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_first_expired(), kMonitor);
}

TEST_F(ExecutionSupervisorTest, ASilenceThatEndsBeforeItsLimitIsForgotten) {
    verifies("SWR-SUP-007", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);

    for (int cycle = 0; cycle < 20; ++cycle) {
        if (cycle % 2 == 0) {
            run(kControl);
        }
        ASSERT_EQ(end_cycle(), GlobalStatus::kOk) << cycle;
    }
}

TEST_F(ExecutionSupervisorTest, HangIsFoundWithoutTheHelpOfTheHangingComponent) {
    verifies("SWR-SUP-007", Technique::kFaultInjection, Polarity::kViolation);
    // Even if the budget guard says nothing: no run is told, so the component is silent.
    ASSERT_EQ(sut_.watch(kControl, {{1U, 1U}, {Duration{0}, 100_us}, SupervisionScope::kGlobal}),
              Status::kOk);
    run(kControl);
    ASSERT_EQ(end_cycle(), GlobalStatus::kOk);

    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_first_expired(), kControl);
    EXPECT_EQ(sut_.get_cause(kControl), ExpiryCause::kSilent);
}

TEST_F(ExecutionSupervisorTest, EachHangIsFoundAfterHealthyCyclesBesideHealthyComponents) {
    verifies("SWR-SUP-007", Technique::kFaultInjection, Polarity::kViolation);
    for (const std::size_t hanging : {kControl, kMonitor, kLogger}) {
        ExecutionStorage<3U> storage{};
        ExecutionSupervisor sut{storage, 10_us};
        for (const std::size_t component : {kControl, kMonitor, kLogger}) {
            ASSERT_EQ(sut.watch(component, kLimits), Status::kOk);
        }
        constexpr std::array kExpected{GlobalStatus::kOk, GlobalStatus::kOk,     GlobalStatus::kOk,
                                       GlobalStatus::kOk, GlobalStatus::kFailed, GlobalStatus::kExpired};
        for (std::size_t cycle = 0U; cycle < kExpected.size(); ++cycle) {
            for (const std::size_t component : {kControl, kMonitor, kLogger}) {
                if (component != hanging || cycle < 3U) {
                    sut.get_records()[component].note_run(now_, now_ + 50_us);
                }
            }
            now_ = now_ + 1_ms;
            ASSERT_EQ(sut.step(now_), kExpected[cycle]) << hanging << " in cycle " << cycle;
        }
        EXPECT_EQ(sut.get_first_expired(), hanging);
    }
}

TEST_F(ExecutionSupervisorTest, ARunThatEndsAfterTheSupervisorsCycleBeganIsNoViolation) {
    verifies("SWR-SUP-007", Technique::kErrorGuessing);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    ASSERT_EQ(sut_.watch(kMonitor, kLimits), Status::kOk);

    // The supervisor is itself a component: its window opened at now_, its own run began 60 us later.
    for (int cycle = 0; cycle < 10; ++cycle) {
        run(kControl);
        sut_.get_records()[kMonitor].note_run(now_ + 60_us, now_ + 90_us);
        ASSERT_EQ(sut_.step(now_), GlobalStatus::kOk) << cycle;
        now_ = now_ + 1_ms;
    }
}

TEST_F(ExecutionSupervisorTest, AcknowledgedComponentIsHealthyAndSupervisedAgain) {
    verifies("SWR-SUP-007", Technique::kStateTransition);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    EXPECT_EQ(sut_.acknowledge(kControl), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.acknowledge(3U), Status::kBadParameter);
    for (int cycle = 0; cycle < 5; ++cycle) {
        static_cast<void>(end_cycle());
    }

    ASSERT_EQ(sut_.acknowledge(kControl), Status::kOk);
    run(kControl);
    EXPECT_EQ(end_cycle(), GlobalStatus::kOk);
    EXPECT_EQ(sut_.get_cause(kControl), ExpiryCause::kNone);
    run(kControl, 101_us);
    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
}

TEST_F(ExecutionSupervisorTest, RefusesComponentsAndLimitsOutOfRangeWithoutHalfWatching) {
    verifies("SWR-SUP-007", Technique::kInterface, Polarity::kViolation);

    EXPECT_EQ(sut_.watch(3U, kLimits), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(kControl, {{0U, 3U}, {Duration{0}, 100_us}, {}}), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(kControl, {{2U, 3U}, {Duration{0}, Duration{0}}, {}}), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    EXPECT_EQ(sut_.watch(kControl, kLimits), Status::kPreconditionNotMet);
}

TEST_F(ExecutionSupervisorTest, NoOverrunNamesNobody) {
    verifies("SWR-SUP-008");
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    run(kControl);

    EXPECT_EQ(end_cycle(), GlobalStatus::kOk);
    EXPECT_EQ(sut_.get_first_expired(), ExecutionSupervisor::kNoComponent);
    EXPECT_EQ(sut_.get_cause(kControl), ExpiryCause::kNone);
}

TEST_F(ExecutionSupervisorTest, BudgetOverrunExpiresTheComponentThatWasRunning) {
    verifies("SWR-SUP-008", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    ASSERT_EQ(sut_.watch(kMonitor, kLimits), Status::kOk);
    run(kControl);
    sut_.on_budget_overrun(0U, kMonitor, now_ + 150_us);

    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_first_expired(), kMonitor);
    EXPECT_EQ(sut_.get_cause(kMonitor), ExpiryCause::kBudgetOverrun);
    EXPECT_EQ(sut_.get_local_status(kControl), LocalStatus::kOk);
}

TEST_F(ExecutionSupervisorTest, OverrunOfAComponentThatNobodyWatchesIsNotLost) {
    verifies("SWR-SUP-008", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    run(kControl);
    run(kLogger, 5_ms);
    sut_.on_budget_overrun(1U, kLogger, now_);

    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_first_expired(), kLogger);
}

TEST_F(ExecutionSupervisorTest, OverrunAfterTheLastStepSurvivesAnAcknowledgement) {
    verifies("SWR-SUP-008", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    sut_.on_budget_overrun(0U, kControl, now_);
    ASSERT_EQ(end_cycle(), GlobalStatus::kExpired);
    sut_.on_budget_overrun(0U, kControl, now_);

    ASSERT_EQ(sut_.acknowledge(kControl), Status::kOk);
    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
}

TEST_F(ExecutionSupervisorTest, ComponentThatExpiredFirstIsNamedUntilItIsAcknowledged) {
    verifies("SWR-SUP-008", Technique::kRequirementsBased, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    ASSERT_EQ(sut_.watch(kMonitor, kLimits), Status::kOk);
    sut_.on_budget_overrun(0U, kMonitor, now_);
    static_cast<void>(end_cycle());
    sut_.on_budget_overrun(0U, kControl, now_);
    static_cast<void>(end_cycle());

    EXPECT_EQ(sut_.get_first_expired(), kMonitor);
    ASSERT_EQ(sut_.acknowledge(kMonitor), Status::kOk);
    EXPECT_EQ(sut_.get_first_expired(), kControl);
}

TEST_F(ExecutionSupervisorTest, LowestIndexIsNamedAmongThoseThatExpireInOneCycle) {
    verifies("SWR-SUP-008", Technique::kBoundaryValues, Polarity::kViolation);
    sut_.on_budget_overrun(0U, kLogger, now_);
    sut_.on_budget_overrun(0U, kMonitor, now_);
    static_cast<void>(end_cycle());

    EXPECT_EQ(sut_.get_first_expired(), kMonitor);
}

TEST_F(ExecutionSupervisorTest, ComponentIndexBeyondTheStorageGoesToTheAssertionHandler) {
    verifies("SWR-SUP-008", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_CHECK_FAILS(sut_.on_budget_overrun(0U, 3U, now_), "execution_supervisor.cpp", 3);
}

TEST_F(ExecutionSupervisorTest, NegativeLatenessLimitGoesToTheAssertionHandler) {
    verifies("SWR-SUP-010", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS((ExecutionSupervisor{storage_, Duration{-1}}), "execution_supervisor.hpp", 1);
    EXPECT_EQ((ExecutionSupervisor{storage_, Duration{0}}.get_late_release().count), 0U);
}

TEST_F(ExecutionSupervisorTest, RunsOfAComponentThatIsSwitchedOffProveNothing) {
    verifies("SWR-SUP-009", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kMonitor, kLimits), Status::kOk);
    ASSERT_EQ(sut_.deactivate(kMonitor), Status::kOk);

    for (int cycle = 0; cycle < 3; ++cycle) {
        run(kMonitor);
        ASSERT_EQ(end_cycle(), GlobalStatus::kFailed) << cycle;
    }
}

TEST_F(ExecutionSupervisorTest, RunsOfAComponentThatWasHealthyBeforeItWasSwitchedOffProveNothing) {
    verifies("SWR-SUP-009", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kMonitor, kLimits), Status::kOk);
    for (int cycle = 0; cycle < 3; ++cycle) {
        run(kMonitor);
        ASSERT_EQ(end_cycle(), GlobalStatus::kOk) << cycle;
    }

    ASSERT_EQ(sut_.deactivate(kMonitor), Status::kOk);
    for (int cycle = 0; cycle < 3; ++cycle) {
        run(kMonitor);
        EXPECT_EQ(end_cycle(), GlobalStatus::kFailed) << cycle;
    }
}

TEST_F(ExecutionSupervisorTest, OverrunBetweenTwoGoodRunsOfOneStepExpires) {
    verifies("SWR-SUP-008", Technique::kFaultInjection, Polarity::kViolation);
    for (const std::size_t component : {kControl, kMonitor}) {
        ASSERT_EQ(sut_.watch(component, kLimits), Status::kOk);
    }
    for (int cycle = 0; cycle < 3; ++cycle) {
        run(kControl);
        run(kMonitor);
        ASSERT_EQ(end_cycle(), GlobalStatus::kOk) << cycle;
    }

    run(kControl);
    run(kMonitor);
    sut_.on_budget_overrun(0U, kMonitor, now_);
    run(kMonitor);
    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_cause(kMonitor), ExpiryCause::kBudgetOverrun);
    EXPECT_EQ(sut_.get_local_status(kControl), LocalStatus::kOk);
}

TEST_F(ExecutionSupervisorTest, LocalScopeKeepsItsFailureOutOfTheGlobalStatus) {
    verifies("SWR-SUP-009", Technique::kEquivalenceClasses);
    ASSERT_EQ(sut_.watch(kControl, kLocalLimits), Status::kOk);
    ASSERT_EQ(sut_.watch(kMonitor, kLimits), Status::kOk);
    run(kMonitor);
    sut_.on_budget_overrun(0U, kControl, now_);

    EXPECT_EQ(end_cycle(), GlobalStatus::kOk);
    EXPECT_EQ(sut_.get_local_status(kControl), LocalStatus::kExpired);
    EXPECT_EQ(sut_.get_first_expired(), kControl);
}

TEST_F(ExecutionSupervisorTest, WorstComponentOfGlobalScopeDecides) {
    verifies("SWR-SUP-009", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, {{1U, 9U}, {Duration{0}, 100_us}, {}}), Status::kOk);
    ASSERT_EQ(sut_.watch(kMonitor, {{9U, 9U}, {Duration{0}, 100_us}, {}}), Status::kOk);
    run(kMonitor);
    EXPECT_EQ(end_cycle(), GlobalStatus::kFailed);

    run(kMonitor, 101_us);
    EXPECT_EQ(end_cycle(), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_global_status(), GlobalStatus::kExpired);
}

TEST_F(ExecutionSupervisorTest, WhereNothingIsSupervisedNothingIsProven) {
    verifies("SWR-SUP-009", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(sut_.get_global_status(), GlobalStatus::kFailed) << "before the first step";
    EXPECT_EQ(end_cycle(), GlobalStatus::kFailed) << "nothing is watched";
    ASSERT_EQ(sut_.watch(kControl, kLocalLimits), Status::kOk);
    EXPECT_EQ(end_cycle(), GlobalStatus::kFailed) << "only a component of local scope";
    ASSERT_EQ(sut_.watch(kMonitor, kLimits), Status::kOk);
    run(kMonitor);
    EXPECT_EQ(end_cycle(), GlobalStatus::kOk);
    ASSERT_EQ(sut_.deactivate(kMonitor), Status::kOk);
    EXPECT_EQ(end_cycle(), GlobalStatus::kFailed) << "the only one is switched off";
    ASSERT_EQ(sut_.activate(kMonitor), Status::kOk);
    run(kMonitor);
    EXPECT_EQ(end_cycle(), GlobalStatus::kOk);
}

TEST_F(ExecutionSupervisorTest, RunsOfAComponentThatNobodyWatchesProveNothing) {
    verifies("SWR-SUP-009", Technique::kErrorGuessing, Polarity::kViolation);

    for (int cycle = 0; cycle < 3; ++cycle) {
        run(kLogger);
        EXPECT_EQ(end_cycle(), GlobalStatus::kFailed) << cycle;
    }
}

TEST_F(ExecutionSupervisorTest, NoComponentAndNoLateReleaseSaySo) {
    verifies("SWR-SUP-010", Technique::kInterface);

    EXPECT_EQ(ExecutionSupervisor::kNoComponent, std::numeric_limits<std::size_t>::max());
    const LateRelease none = sut_.get_late_release();
    EXPECT_EQ(none.count, 0U);
    EXPECT_EQ(none.window, 0U);
    EXPECT_EQ(none.lateness, Duration{0});
    EXPECT_EQ(none.at, Instant{});
}

TEST_F(ExecutionSupervisorTest, SupervisorOfStaticStorageIsReadyBeforeMain) {
    verifies("SWR-SUP-009", Technique::kInterface);

    EXPECT_EQ(g_supervisor.get_global_status(), GlobalStatus::kFailed);
    EXPECT_TRUE(std::is_trivially_destructible_v<ExecutionSupervisor>);
}

TEST_F(ExecutionSupervisorTest, LatenessWithinItsLimitIsTolerated) {
    verifies("SWR-SUP-010", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    run(kControl);
    sut_.on_late_release(0U, Duration{0}, now_);
    sut_.on_late_release(1U, 10_us, now_);

    EXPECT_EQ(end_cycle(), GlobalStatus::kOk);
    EXPECT_EQ(sut_.get_late_release().count, 0U);
}

TEST_F(ExecutionSupervisorTest, LateReleaseFailsItsCycleAndIsKeptWithItsWindow) {
    verifies("SWR-SUP-010", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    run(kControl);
    sut_.on_late_release(1U, 10_us + Duration{1}, Instant{77});
    sut_.on_late_release(0U, 500_us, Instant{88});

    EXPECT_EQ(end_cycle(), GlobalStatus::kFailed);
    run(kControl);
    EXPECT_EQ(end_cycle(), GlobalStatus::kOk);
    EXPECT_EQ(sut_.get_late_release().count, 2U);
    EXPECT_EQ(sut_.get_late_release().window, 1U);
    EXPECT_EQ(sut_.get_late_release().lateness, 10_us + Duration{1});
    EXPECT_EQ(sut_.get_late_release().at, Instant{77});
    sut_.acknowledge_late_release();
    EXPECT_EQ(sut_.get_late_release().count, 0U);
}

TEST_F(ExecutionSupervisorTest, NegativeLatenessIsNoBetterThanALateWindow) {
    verifies("SWR-SUP-010", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.watch(kControl, kLimits), Status::kOk);
    run(kControl);
    sut_.on_late_release(2U, Duration{-1}, now_);

    EXPECT_EQ(end_cycle(), GlobalStatus::kFailed);
    EXPECT_EQ(sut_.get_late_release().count, 1U);
}

}  // namespace
}  // namespace mamori::safety

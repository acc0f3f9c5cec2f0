// SPDX-License-Identifier: Apache-2.0
// Goal: each rule of the object model (R), each decision where the standard leaves a choice or
// OpenRTM-aist 2.x departs from it (D), each error path (E), and the requirements on components and contexts.
// Method: one table of scenarios (support/context_script.hpp); every step is compared in result, actions and
// their order. A scenario that shows several requirements runs once for each. docs/design/rtc_semantics.md
// explains the numbers.
#include <ostream>
#include <vector>

#include "mamori/trace/verifies.hpp"
#include "support/context_script.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

/// What a scenario verifies: one result for each of them.
class Tags {
  public:
    using Tag = void (*)();

    static void life_fault_violation() {
        verifies("SWR-KRN-011", Technique::kFaultInjection, Polarity::kViolation);
    }
    static void life_guess_violation() {
        verifies("SWR-KRN-011", Technique::kErrorGuessing, Polarity::kViolation);
    }
    static void life_state() { verifies("SWR-KRN-011", Technique::kStateTransition); }
    static void life_state_violation() {
        verifies("SWR-KRN-011", Technique::kStateTransition, Polarity::kViolation);
    }
    static void context_classes_violation() {
        verifies("SWR-KRN-012", Technique::kEquivalenceClasses, Polarity::kViolation);
    }
    static void context_fault_violation() {
        verifies("SWR-KRN-012", Technique::kFaultInjection, Polarity::kViolation);
    }
    static void context_guess_violation() {
        verifies("SWR-KRN-012", Technique::kErrorGuessing, Polarity::kViolation);
    }
    static void context_state() { verifies("SWR-KRN-012", Technique::kStateTransition); }
    static void context_state_violation() {
        verifies("SWR-KRN-012", Technique::kStateTransition, Polarity::kViolation);
    }
    static void cycle_rule() { verifies("SWR-KRN-013", Technique::kRequirementsBased); }
    static void cycle_state() { verifies("SWR-KRN-013", Technique::kStateTransition); }
    static void error_fault_violation() {
        verifies("SWR-KRN-014", Technique::kFaultInjection, Polarity::kViolation);
    }
    static void error_rule() { verifies("SWR-KRN-014", Technique::kRequirementsBased); }
    static void error_state_violation() {
        verifies("SWR-KRN-014", Technique::kStateTransition, Polarity::kViolation);
    }
    static void range_back_to_back() { verifies("SWR-RTC-002", Technique::kBackToBack); }
    static void range_interface() { verifies("SWR-RTC-002", Technique::kInterface); }
    static void rate_state() { verifies("SWR-RTC-003", Technique::kStateTransition); }
    static void refused_rate_fault_violation() {
        verifies("SWR-RTC-004", Technique::kFaultInjection, Polarity::kViolation);
    }
    static void refused_rate_interface() { verifies("SWR-RTC-004", Technique::kInterface); }
    static void policy_back_to_back() { verifies("SWR-RTC-005", Technique::kBackToBack); }
    static void policy_fault() { verifies("SWR-RTC-005", Technique::kFaultInjection); }
    static void policy_state() { verifies("SWR-RTC-005", Technique::kStateTransition); }
    static void exit_state() { verifies("SWR-RTC-010", Technique::kStateTransition); }
    static void exit_state_violation() {
        verifies("SWR-RTC-010", Technique::kStateTransition, Polarity::kViolation);
    }
    static void rtc_classes() { verifies("SWR-RTC-011", Technique::kEquivalenceClasses); }
    static void rtc_classes_violation() {
        verifies("SWR-RTC-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    }
    static void rtc_fault_violation() {
        verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    }
    static void rtc_guess_violation() {
        verifies("SWR-RTC-011", Technique::kErrorGuessing, Polarity::kViolation);
    }
    static void rtc_interface_violation() {
        verifies("SWR-RTC-011", Technique::kInterface, Polarity::kViolation);
    }
    static void rtc_limits_violation() {
        verifies("SWR-RTC-011", Technique::kBoundaryValues, Polarity::kViolation);
    }
    static void rtc_state() { verifies("SWR-RTC-011", Technique::kStateTransition); }
    static void rtc_state_violation() {
        verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    }
};
struct Scenario {
    const char* name;
    std::vector<Tags::Tag> tags;
    const char* steps;
};

const std::vector<Scenario> kScenarios{
    // The life of a component.
    {"R2_D6_InitializeCallsOnInitializeOnceAndOnlyWhenCreated",
     {Tags::rtc_state, Tags::rtc_state_violation, Tags::life_state, Tags::life_state_violation},
     "is_alive stranger = no; initialize stranger: stranger.initialize; is_alive stranger = yes;"
     "initialize stranger = P; initialize a = P"},
    {"R2_AFailedInitializeIsReturnedAndStaysCreated",
     {Tags::rtc_fault_violation, Tags::life_fault_violation},
     "fail stranger.initialize *; initialize stranger = *: stranger.initialize; is_alive stranger = no; heal;"
     "initialize stranger: stranger.initialize; is_alive stranger = yes"},
    {"R2_FinalizeIsForAliveComponentsOutsideContexts",
     {Tags::rtc_state_violation, Tags::life_state_violation},
     "finalize stranger = P; finalize a = P; is_alive a = yes; detach; finalize a: a.finalize; is_alive a = "
     "no"},
    {"FinalizeCallsTheActionOnceAndALifeMayBeginAgain",
     {Tags::life_state},
     "initialize stranger: stranger.initialize; finalize stranger: stranger.finalize; is_alive stranger = no;"
     "finalize stranger = P; initialize stranger: stranger.initialize"},
    {"AFailingFinalizeIsReportedButEndsTheLife",
     {Tags::life_fault_violation},
     "initialize stranger: stranger.initialize; fail stranger.finalize *;"
     "finalize stranger = *: stranger.finalize; is_alive stranger = no"},
    {"OperationsFromWithinTheActionsOfTheComponentAreRejected",
     {Tags::life_guess_violation},
     "within stranger {initialize stranger = P, finalize stranger = P};"
     "initialize stranger: stranger.initialize; finalize stranger: stranger.finalize"},
    {"R2_E14_ExitDeactivatesAndFinalizesWhileTheOthersContinue",
     {Tags::exit_state, Tags::rtc_state_violation},
     "active; finalize a = P; exit a: a.deactivated a.finalize; is_alive a = no; states = CA; is_running = "
     "yes;"
     "cycle: b.execute b.state_update; stop: b.shutdown"},
    {"R2_AfterExitALifeMayBeginInTheSamePosition",
     {Tags::exit_state},
     "active; broken; exit a: a.finalize; initialize a: a.initialize; states = IA; activate a: a.activated;"
     "cycle: a.execute b.execute a.state_update b.state_update"},
    {"R2_ExitOutsideAContextFinalizesOnly",
     {Tags::exit_state},
     "initialize stranger: stranger.initialize; exit stranger: stranger.finalize"},
    {"R2_ExitIsRejectedWhenCreatedAndFromWithinActions",
     {Tags::exit_state_violation},
     "exit stranger = P; active; within a {exit a = P, exit b = P};"
     "cycle: a.execute b.execute a.state_update b.state_update; is_alive a = yes; is_alive b = yes"},
    {"D9_ASecondExitIsRejected", {Tags::rtc_state_violation}, "exit a: a.finalize; exit a = P"},
    {"D10_BeingAliveDoesNotDependOnAContext",
     {Tags::rtc_classes_violation},
     "initialize stranger: stranger.initialize; is_alive stranger = yes; is_alive a = yes; active; broken;"
     "is_alive a = yes"},
    {"D11_TheStateOfAStrangerIsABadParameterAndNeverCreated",
     {Tags::rtc_classes_violation},
     "exit a: a.finalize; get_state stranger = B; get_state a = B"},

    // Start and stop.
    {"StartCallsOnStartupOfEveryParticipantInOrder",
     {Tags::context_state},
     "start: a.startup b.startup; is_running = yes; states = II; refusing = none"},
    {"E12_StopKeepsActiveComponentsActive",
     {Tags::rtc_state_violation, Tags::context_state},
     "active; stop: a.shutdown b.shutdown; is_running = no; states = AA; start: a.startup b.startup;"
     "cycle: a.execute b.execute a.state_update b.state_update"},
    {"R3_E13_ErrorIsKeptAcrossStopAndStart",
     {Tags::rtc_state, Tags::rtc_state_violation, Tags::context_state},
     "active; broken; stop: a.shutdown b.shutdown; states = EA; start: a.startup b.startup; states = EA;"
     "cycle: a.error b.execute b.state_update"},
    {"R3_StartNeedsEveryParticipantAlive",
     {Tags::rtc_state_violation, Tags::context_state_violation},
     "exit a: a.finalize; start = P; refusing = 0; activate a = B; deactivate a = B; reset a = P; get_state "
     "a = B;"
     "initialize a: a.initialize; start: a.startup b.startup; refusing = none"},
    {"AStartThatAParticipantCannotFollowNamesIt",
     {Tags::context_guess_violation},
     "fail a.startup E; start = E: a.startup; refusing = 0; exit b: b.finalize; start = P; refusing = 1"},
    {"D5_AFailedStartupKeepsTheContextStoppedAndShutsTheStartedDown",
     {Tags::rtc_fault_violation, Tags::context_fault_violation},
     "fail b.startup *; start = *: a.startup b.startup a.shutdown; is_running = no; refusing = 1; heal;"
     "start: a.startup b.startup; refusing = none"},
    {"AFailingShutdownIsReportedButStopsAnyway",
     {Tags::context_fault_violation},
     "active; fail a.shutdown U; fail b.shutdown E; stop = U: a.shutdown b.shutdown; is_running = no"},
    {"E11_StartWhileRunningAndStopWhileStoppedAreRejected",
     {Tags::rtc_state_violation, Tags::context_state_violation},
     "stop = P; start: a.startup b.startup; start = P; is_running = yes; stop: a.shutdown b.shutdown; detach;"
     "start = P"},
    {"R32_D13_NothingRunsUnlessTheContextRunsAndTheComponentIsActive",
     {Tags::rtc_state_violation, Tags::cycle_state, Tags::context_state_violation},
     "begin = P; turn = no; start: a.startup b.startup; turn = yes; cycle; turn = yes; cycle; turn = yes; "
     "cycle;"
     "is_running = yes; activate b: b.activated; cycle: b.execute b.state_update"},

    // Attach and detach.
    {"D7_DetachIsRejectedWhileRunningOrActiveOrEmpty",
     {Tags::rtc_state_violation, Tags::context_state_violation},
     "active; detach = P; remove a = U; stop: a.shutdown b.shutdown; detach = P; remove a = U; participants "
     "= 2;"
     "deactivate a: a.deactivated; detach = P; deactivate b: b.deactivated; detach; detach = P"},
    {"ADetachedComponentIsInactiveInItsNextContextEvenAfterAnError",
     {Tags::context_state},
     "active; broken; deactivate b: b.deactivated; stop: a.shutdown b.shutdown; detach; get_state a = B; "
     "attach;"
     "states = II"},
    {"R35_E16_AComponentBelongsToOneContextAndItsErrorStaysThere",
     {Tags::rtc_classes_violation, Tags::rtc_fault_violation, Tags::error_fault_violation},
     "share = B; other: stranger.initialize stranger.startup stranger.activated; active; broken; states = EA;"
     "other_state = A; is_other_running = yes"},
    {"E18_ParticipantsDoNotChangeDuringACycle",
     {Tags::rtc_guess_violation},
     "active; within a {detach = P, add stranger = U, remove b = U, exit b = P};"
     "cycle: a.execute b.execute a.state_update b.state_update; participants = 2"},

    // Activation, deactivation, reset.
    {"R3_D19_ActivationAndDeactivationReturnAfterTheirActions",
     {Tags::rtc_state, Tags::rtc_state_violation, Tags::context_state},
     "activate a: a.activated; states = AI; deactivate a: a.deactivated; states = II; start: a.startup "
     "b.startup;"
     "activate a: a.activated; states = AI; deactivate a: a.deactivated; states = II"},
    {"D2_E1_E2_AFailedActivationIsReturnedAndLeadsToErrorAtOnce",
     {Tags::rtc_fault_violation, Tags::rtc_classes_violation, Tags::error_fault_violation},
     "start: a.startup b.startup; within a {is_active a = no}; fail a.activated *;"
     "activate a = *: a.activated a.aborting; states = EI; cycle: a.error; cycle: a.error; cycle: a.error"},
    {"D3_AFailedDeactivationIsReturnedAndLeadsToInactive",
     {Tags::rtc_fault_violation, Tags::context_fault_violation},
     "active; fail a.deactivated *; deactivate a = *: a.deactivated; states = IA; failure a = "
     "on_deactivated,*"},
    {"E7_E8_ActivationAndDeactivationInTheWrongStateAreRejected",
     {Tags::rtc_state_violation, Tags::context_state_violation},
     "deactivate a = P; active; broken; activate a = P; activate b = P; deactivate a = P; reset b = P; "
     "states = EA;"
     "deactivate b: b.deactivated; deactivate b = P; reset b = P; states = EI"},
    {"R3_E6_AResetWhileActiveOrInactiveIsRejectedWithoutAChange",
     {Tags::rtc_state_violation},
     "reset a = P; states = II; active; reset a = P; states = AA"},
    {"E5_AResetLeadsToInactiveAndNeedsAnActivation",
     {Tags::rtc_state_violation, Tags::context_state},
     "active; broken; reset a: a.reset; states = IA; cycle: b.execute b.state_update; activate a: "
     "a.activated;"
     "cycle: a.execute b.execute a.state_update b.state_update"},
    {"E4_AFailedResetStaysInErrorWithoutASecondAbort",
     {Tags::rtc_fault_violation, Tags::error_fault_violation},
     "active; broken; fail a.reset *; reset a = *: a.reset; states = EA;"
     "cycle: a.error b.execute b.state_update; heal; reset a: a.reset; states = IA"},
    {"E9_EveryOperationOnAStrangerIsABadParameter",
     {Tags::rtc_classes_violation, Tags::context_classes_violation},
     "initialize stranger: stranger.initialize; active; activate stranger = B; deactivate stranger = B;"
     "reset stranger = B; get_state stranger = B; get_handle stranger = B"},

    // Cycles.
    {"R32_D14_AllExecuteBeforeAnyUpdatesItsState",
     {Tags::rtc_state, Tags::rtc_interface_violation, Tags::cycle_rule, Tags::error_rule},
     "active; cycle: a.execute b.execute a.state_update b.state_update;"
     "cycle: a.execute b.execute a.state_update b.state_update"},
    {"D14_TheEventDrivenContextCallsNoDataFlowAction",
     {Tags::rtc_interface_violation},
     "event_driven; active; cycle"},
    {"R32_OnErrorReplacesBothActions",
     {Tags::rtc_state_violation, Tags::cycle_state},
     "active; broken; cycle: a.error b.execute b.state_update; cycle: a.error b.execute b.state_update"},
    {"R31_EachActionIsCalledAsOftenAsTheStandardRequires",
     {Tags::rtc_state},
     "start: a.startup b.startup; activate a: a.activated; cycle: a.execute a.state_update;"
     "cycle: a.execute a.state_update; fail a.execute E; cycle: a.execute a.aborting; cycle: a.error;"
     "cycle: a.error; heal; reset a: a.reset; activate a: a.activated; deactivate a: a.deactivated;"
     "stop: a.shutdown b.shutdown; detach; finalize a: a.finalize"},
    {"D1_E1_E2_E15_AFailedExecuteAbortsOnceAndTheOtherComponentContinues",
     {Tags::rtc_state_violation, Tags::rtc_fault_violation, Tags::rtc_classes_violation,
      Tags::error_fault_violation},
     "active; fail a.execute *; cycle: a.execute a.aborting b.execute b.state_update; states = EA;"
     "cycle: a.error b.execute b.state_update; cycle: a.error b.execute b.state_update"},
    {"E1_E2_AFailedStateUpdateAbortsOnceAndTheOtherComponentContinues",
     {Tags::rtc_fault_violation, Tags::rtc_classes_violation, Tags::error_fault_violation},
     "active; fail a.state_update *;"
     "cycle: a.execute b.execute a.state_update a.aborting b.state_update; states = EA;"
     "cycle: a.error b.execute b.state_update; cycle: a.error b.execute b.state_update"},
    {"D4_NoFailureOfAnActionIsHidden",
     {Tags::rtc_fault_violation},
     "active; fail a.execute *; fail b.state_update E;"
     "cycle: a.execute a.aborting b.execute b.state_update b.aborting; states = EE;"
     "failure a = on_execute,*; failure b = on_state_update,E"},
    {"E3_FailuresOfOnAbortingAndOnErrorChangeNothing",
     {Tags::rtc_fault_violation, Tags::error_fault_violation},
     "active; fail a.execute *; fail a.aborting *; fail a.error *;"
     "cycle: a.execute a.aborting b.execute b.state_update; cycle: a.error b.execute b.state_update;"
     "cycle: a.error b.execute b.state_update; states = EA"},
    {"EachEntryIntoErrorAbortsOnce",
     {Tags::error_state_violation},
     "active; fail a.execute E; cycle: a.execute a.aborting b.execute b.state_update; heal; reset a: a.reset;"
     "activate a: a.activated; fail a.execute E; cycle: a.execute a.aborting b.execute b.state_update; heal;"
     "reset a: a.reset; activate a: a.activated; fail a.execute E;"
     "cycle: a.execute a.aborting b.execute b.state_update"},
    {"E17_AnErrorWinsOverADeactivationInTheSameCycle",
     {Tags::rtc_state_violation, Tags::error_state_violation},
     "active; fail a.execute E; within a {deactivate a = P}; within b {deactivate a = P};"
     "cycle: a.execute a.aborting b.execute b.state_update; states = EA; deactivate a = P"},
    {"E19_OperationsFromWithinAnyActionAreRejected",
     {Tags::rtc_guess_violation, Tags::context_guess_violation},
     "within a {start = P, stop = P, detach = P, begin = P, activate a = P, activate b = P, deactivate a = P,"
     "deactivate b = P, reset a = P, reset b = P, exit a = P, exit b = P, acting = 0};"
     "within b {start = P, stop = P, detach = P, begin = P, activate a = P, activate b = P, deactivate a = P,"
     "deactivate b = P, reset a = P, reset b = P, exit a = P, exit b = P, acting = 1};"
     "start: a.startup b.startup; activate a: a.activated; cycle: a.execute a.state_update; fail "
     "a.state_update E;"
     "cycle: a.execute a.state_update a.aborting; cycle: a.error; reset a: a.reset; activate a: a.activated;"
     "deactivate a: a.deactivated; stop: a.shutdown b.shutdown; acting = none"},
    {"D20_BetweenTheActionsOfACycleTheContextIsBusy",
     {Tags::rtc_interface_violation, Tags::context_guess_violation},
     "active; within a {is_busy = yes}; begin; execute 0: a.execute; is_busy = yes; begin = P; stop = P;"
     "detach = P; deactivate a = P; states = AA; execute 1: b.execute; is_busy = yes; update 0: "
     "a.state_update;"
     "update 1: b.state_update; end; is_busy = no; deactivate a: a.deactivated"},
    {"ARangeRunsAsItsPositionsDoOneByOne",
     {Tags::range_back_to_back, Tags::range_interface},
     "active; within a {acting = 0}; within b {acting = 1};"
     "ranges: a.execute b.execute a.state_update b.state_update; acting = none;"
     "cycle: a.execute b.execute a.state_update b.state_update; broken; states = EA"},

    // Rates.
    {"R3_OnlyAPeriodicContextHasARate",
     {Tags::rtc_classes},
     "rate = 1000; divisor = 1; kind = 0; event_driven; rate = none; kind = 1"},
    {"E10_AnInvalidRateIsABadParameterAndTheRateStays",
     {Tags::rtc_limits_violation},
     "set_rate 0 = B; set_rate -1 = B; set_rate nan = B; set_rate inf = B; apply = no; rate = 1000"},
    {"R3_SetRateStoresAndThenInformsEveryParticipant",
     {Tags::rtc_state},
     "start: a.startup b.startup; set_rate 500; apply = yes; within a {rate = 500};"
     "cycle: a.rate_changed b.rate_changed"},
    {"EveryParticipantIsInformedOnceInItsFirstCycleAtTheNewRate",
     {Tags::rate_state},
     "active; deactivate b: b.deactivated; set_rate 500; apply = yes;"
     "cycle: a.rate_changed a.execute b.rate_changed a.state_update; cycle: a.execute a.state_update"},
    {"D12_E1_E2_AnActiveComponentThatRejectsTheRateGoesToErrorAndTheRateStays",
     {Tags::rtc_fault_violation, Tags::rtc_classes_violation, Tags::refused_rate_fault_violation},
     "active; set_rate 500; apply = yes; fail a.rate_changed *;"
     "cycle: a.rate_changed a.aborting b.rate_changed b.execute b.state_update; states = EA; rate = 500;"
     "failure a = on_rate_changed,*; cycle: a.error b.execute b.state_update;"
     "cycle: a.error b.execute b.state_update"},
    {"AnInactiveOrFailedComponentThatRejectsTheRateKeepsItsState",
     {Tags::refused_rate_fault_violation},
     "active; broken; set_rate 500; apply = yes; fail a.rate_changed *;"
     "cycle: a.rate_changed a.error b.rate_changed b.execute b.state_update; states = EA; reset a: a.reset;"
     "set_rate 1000; apply = yes; cycle: a.rate_changed b.rate_changed b.execute b.state_update; states = IA;"
     "failure a = on_rate_changed,*"},
    {"TheLastFailureNamesTheActionThatFailed",
     {Tags::refused_rate_interface},
     "failure a = none; fail a.startup U; start = U: a.startup; failure a = on_startup,U; heal;"
     "start: a.startup b.startup; fail a.shutdown U; stop = U: a.shutdown b.shutdown; failure a = "
     "on_shutdown,U;"
     "heal; start: a.startup b.startup; fail a.activated U; activate a = U: a.activated a.aborting;"
     "failure a = on_activated,U; heal; fail a.reset U; reset a = U: a.reset; failure a = on_reset,U; heal;"
     "reset a: a.reset; activate a: a.activated; fail a.execute U; fail a.aborting E; fail a.error E;"
     "cycle: a.execute a.aborting; cycle: a.error; failure a = on_execute,U; heal; reset a: a.reset;"
     "activate a: a.activated; fail a.state_update U; fail a.aborting E; fail a.error E;"
     "cycle: a.execute a.state_update a.aborting; cycle: a.error; failure a = on_state_update,U; heal;"
     "reset a: a.reset; activate a: a.activated; fail a.deactivated U; deactivate a = U: a.deactivated;"
     "failure a = on_deactivated,U"},

    // The order of actions of OpenRTM-aist.
    {"D1_UnderOpenRtmCompatOnDeactivatedComesBeforeOnAborting",
     {Tags::rtc_state_violation, Tags::policy_state},
     "compatible; active; fail a.execute *; fail b.state_update *; cycle: a.execute a.deactivated a.aborting"
     " b.execute b.state_update b.deactivated b.aborting; cycle: a.error b.error"},
    {"UnderOpenRtmCompatAFailedActivationIsCleanedUpToo",
     {Tags::policy_fault},
     "compatible; within a {is_active a = no}; fail a.activated *;"
     "activate a = *: a.activated a.deactivated a.aborting; states = EI"},
    {"AnOrderlyDeactivationIsTheSameUnderBothPolicies",
     {Tags::policy_back_to_back},
     "compatible; active; deactivate a: a.deactivated; states = IA"},
};

struct TaggedScenario {
    std::string name;
    Tags::Tag verify;
    const char* steps;
};
/// The value in the result file: no addresses.
void PrintTo(const TaggedScenario& scenario, std::ostream* out) {
    *out << scenario.steps;
}

std::vector<TaggedScenario> get_tagged_scenarios() {
    std::vector<TaggedScenario> result;
    for (const Scenario& scenario : kScenarios) {
        std::size_t count = 0U;
        for (const Tags::Tag tag : scenario.tags) {
            ++count;
            result.push_back(
                {scenario.name + (count == 1U ? "" : "_" + std::to_string(count)), tag, scenario.steps});
        }
    }
    return result;
}

class RtcScenarioTest : public ::testing::TestWithParam<TaggedScenario> {};

TEST_P(RtcScenarioTest, Scenario) {
    GetParam().verify();

    ContextScript::run_all(GetParam().steps);
}

INSTANTIATE_TEST_SUITE_P(Table, RtcScenarioTest, ::testing::ValuesIn(get_tagged_scenarios()),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace mamori

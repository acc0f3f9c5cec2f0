// SPDX-License-Identifier: Apache-2.0
// Goal: the host rules accept a host that complies with its contract and report each violation. Method: hosts
// with one defect each, in simulated time if possible, else with real threads.
#include "mamori/ports/conformance/host_contract.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "mamori/ports/conformance/rule_runner.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/exact_host.hpp"
#include "support/recording_host.hpp"
#include "support/rule_names.hpp"
#include "support/stuck_host.hpp"
#include "support/thread_host.hpp"

namespace mamori::ports::conformance {
namespace {

using namespace verification;

TrialFactory make_exact(HostFlaw flaw) {
    return make_host_trials([flaw] { return std::make_unique<ExactHostRig>(flaw); });
}
TrialFactory make_threaded(ThreadFlaw flaw) {
    return make_host_trials([flaw] { return std::make_unique<ThreadHostRig>(flaw); });
}

struct FlawCase {
    HostFlaw flaw;
    const char* requirement;
    const char* sentence;  ///< part of the finding
};

void PrintTo(const FlawCase& flaw, std::ostream* out) {
    *out << flaw.sentence;
}

class HostFlawTest : public ::testing::TestWithParam<FlawCase> {};

TEST_P(HostFlawTest, IsReportedInTheFixedOrderAndInTheShortestWalk) {
    verifies(GetParam().requirement, Technique::kFaultInjection, Polarity::kViolation);

    const Report in_order = run_in_order(make_exact(GetParam().flaw));
    const Report shortest = explore(make_exact(GetParam().flaw), 3U);

    ASSERT_EQ(in_order.findings.size(), 1U);
    EXPECT_NE(in_order.findings[0].find(GetParam().sentence), std::string::npos) << in_order.to_text();
    EXPECT_FALSE(shortest.is_kept());
    EXPECT_FALSE(run_randomly(make_exact(GetParam().flaw), 1U, 1000U).is_kept());
}

INSTANTIATE_TEST_SUITE_P(
    All, HostFlawTest,
    ::testing::Values(
        FlawCase{HostFlaw::kClockGoesBack, "SWR-CNF-002", "the clock ran backwards"},
        FlawCase{HostFlaw::kRunsStepTwice, "SWR-CNF-002", "ran twice"},
        FlawCase{HostFlaw::kSkipsStep, "SWR-CNF-002", "did not run"},
        FlawCase{HostFlaw::kRunsBackwards, "SWR-CNF-002", "the order was wrong"},
        FlawCase{HostFlaw::kIgnoresFirstNumber, "SWR-CNF-002", "the order was wrong"},
        FlawCase{HostFlaw::kForgetsSecondPass, "SWR-CNF-002", "did not run"},
        FlawCase{HostFlaw::kWakesEarly, "SWR-CNF-002", "a wait ended before its instant"},
        FlawCase{HostFlaw::kStepsOverlap, "SWR-CNF-002", "began before the previous step had ended"},
        FlawCase{HostFlaw::kRunsOneStepMore, "SWR-CNF-002", "more steps ran than the work has"},
        FlawCase{HostFlaw::kCountedStepEndsLate, "SWR-CNF-003", "a counted step ended after the deadline"},
        FlawCase{HostFlaw::kStepEndsBeforeItBegins, "SWR-CNF-002", "ended before it began"},
        FlawCase{HostFlaw::kCountsCutOffStep, "SWR-CNF-003", "cannot have returned"},
        FlawCase{HostFlaw::kCountsTooFew, "SWR-CNF-003", "before its deadline"},
        FlawCase{HostFlaw::kCountsTooMany, "SWR-CNF-003", "cannot have returned"},
        FlawCase{HostFlaw::kIsGenerous, "SWR-CNF-003", "cannot have returned"},
        FlawCase{HostFlaw::kIgnoresPassedDeadline, "SWR-CNF-003", "cannot have returned"},
        FlawCase{HostFlaw::kCutsTooEarly, "SWR-CNF-004", "aborted before its deadline"},
        FlawCase{HostFlaw::kDoesNotCut, "SWR-CNF-004", "did not end at the expected instant"},
        FlawCase{HostFlaw::kNeedsOthersToReturn, "SWR-CNF-004", "steps counted"},
        FlawCase{HostFlaw::kLateStepEndsInTime, "SWR-CNF-004", "did not end after the deadline"},
        FlawCase{HostFlaw::kRunsAbandonedStepLater, "SWR-CNF-005", "after the reported end of its work"},
        FlawCase{HostFlaw::kEntersAllAbandonedSteps, "SWR-CNF-005", "more than one further step"},
        FlawCase{HostFlaw::kForgetsReturnOfAHang, "SWR-CNF-005", "released work never returned"},
        FlawCase{HostFlaw::kNeverSaysReturned, "SWR-CNF-005", "late work never returned"}));

TEST(HostContractTest, ACompliantHostIsAccepted) {
    verifies("SWR-CNF-003", Technique::kStateTransition);
    EXPECT_EQ(run_in_order(make_exact(HostFlaw::kNone)).to_text().substr(0U, 8U), "28 rules");
    EXPECT_TRUE(run_randomly(make_exact(HostFlaw::kNone), 3U, 5000U).is_kept());
    EXPECT_TRUE(run_in_order(make_exact(HostFlaw::kEntersOneAbandonedStep)).is_kept());
    EXPECT_TRUE(run_in_order(make_threaded(ThreadFlaw::kNone)).is_kept());
    EXPECT_TRUE(run_randomly(make_threaded(ThreadFlaw::kNone), 5U, 300U).is_kept());
}

TEST(HostContractTest, AFalseReportOfTheEndOfAHangIsReported) {
    verifies("SWR-CNF-005", Technique::kFaultInjection, Polarity::kViolation);
    const Report report = run_in_order(make_threaded(ThreadFlaw::kSaysReturnedTooEarly));
    EXPECT_FALSE(report.is_kept());
}

TEST(HostContractTest, AFindingComesWithTheFirstRuleThatCanShowIt) {
    verifies("SWR-CNF-003", Technique::kFaultInjection, Polarity::kViolation);
    struct Case {
        HostFlaw flaw;
        Walk walk;
        const char* sentence;
    };
    for (const Case& shown :
         {Case{HostFlaw::kCountedStepEndsLate, {0U}, "a counted step ended after the deadline"},
          Case{HostFlaw::kCountedStepEndsLate, {1U}, "a counted step ended after the deadline"},
          Case{HostFlaw::kRunsAbandonedStepLater, {6U, 25U, 25U}, "after the reported end of its work"}}) {
        const Report report = replay(make_exact(shown.flaw), shown.walk);
        ASSERT_FALSE(report.is_kept()) << shown.sentence;
        EXPECT_EQ(report.step_count, shown.walk.size());
        EXPECT_NE(report.findings[0].find(shown.sentence), std::string::npos) << report.to_text();
    }
}

TEST(HostContractTest, WorkDuringAHangNeedsTheHangOfTheNamedWindow) {
    verifies("SWR-CNF-004", Technique::kStateTransition);
    for (const Walk& walk : {Walk{11U, 23U}, Walk{17U, 24U}}) {
        EXPECT_TRUE(replay(make_exact(HostFlaw::kNone), walk).is_kept());
    }
    for (const Walk& walk : {Walk{23U}, Walk{24U}, Walk{17U, 23U}, Walk{11U, 24U}}) {
        EXPECT_FALSE(replay(make_exact(HostFlaw::kNone), walk).is_kept());
    }
}

TEST(HostContractTest, AReportedEndOfAStepThatStillRunsIsReported) {
    verifies("SWR-CNF-005", Technique::kFaultInjection, Polarity::kViolation);
    struct Case {
        std::vector<std::string> rules;
        std::size_t stuck_step;
        std::size_t count;
        const char* sentence;
    };
    for (const Case& stuck :
         {Case{{"work that fits, window 0"}, 3U, 4U, "the end of a step that still ran"},
          Case{{"a late step, window 0"}, 1U, 1U, "the host reported the end of work while a step ran"},
          Case{{"a hang of the second step, window 1", "query during the hang, window 1"},
               1U,
               1U,
               "the end of hanging work was reported"}}) {
        const TrialFactory factory = make_host_trials(
            [&stuck] { return std::make_unique<StuckHostRig>(stuck.stuck_step, stuck.count); });
        const Report report = run_in_order(select_rules(factory, stuck.rules));
        ASSERT_FALSE(report.is_kept()) << stuck.sentence;
        EXPECT_NE(report.findings[0].find(stuck.sentence), std::string::npos) << report.to_text();
    }
}

TEST(HostContractTest, WorkAbortedBeforeItsDeadlineIsReportedInRealTimeToo) {
    verifies("SWR-CNF-004", Technique::kFaultInjection, Polarity::kViolation);
    const Report report = run_in_order(make_threaded(ThreadFlaw::kCutsTooEarly));
    ASSERT_FALSE(report.is_kept());
    EXPECT_NE(report.findings[0].find("aborted before its deadline"), std::string::npos) << report.to_text();
}

TEST(HostContractTest, ACountedHangIsReportedInRealTimeToo) {
    verifies("SWR-CNF-003", Technique::kFaultInjection, Polarity::kViolation);
    const Report report = run_in_order(make_threaded(ThreadFlaw::kCountsWhatHangs));
    ASSERT_FALSE(report.is_kept());
    EXPECT_NE(report.findings[0].find("cannot have returned"), std::string::npos) << report.to_text();
}

TEST(HostContractTest, AStepThatRunsTwiceIsReportedInRealTimeToo) {
    verifies("SWR-CNF-002", Technique::kFaultInjection, Polarity::kViolation);
    const Report report = run_in_order(make_threaded(ThreadFlaw::kRunsStepTwice));
    ASSERT_FALSE(report.is_kept());
    EXPECT_NE(report.findings[0].find("ran twice"), std::string::npos) << report.to_text();
}

/// Requests of the fixed order with a tick of 1000 ns: the rules of window 0 run until the hangs of the
/// windows 1 and 2 have been released. At the end, the model releases what still hangs.
constexpr const char* kRequests =
    R"(execute, component 0, from 0: 0 1000 0 1000 within 60000000, spent 0:0 0:1000 0:0 0:1000
execute, component 0, from 0: 1000 within 60000000, spent 0:1000
execute, component 0, from 7: 0 0 within 60000000, spent 0:0 0:0
update, component 0, from 0: 0 0 0 within 60000000, spent 0:0 0:0 0:0
mode, component 0, from 0: 1000 0 within 60000000, spent 0:1000 0:0
mode, component 0, from 0: 3000 0 within 2000, spent 0:3000
ask 0
execute, component 0, from 0: 0 5000 0 0 within 3000, spent 0:0 0:5000
ask 0
execute, component 0, from 0: 1000 2000 within 3000, spent 0:1000 0:2000
execute, component 0, from 0: 1000 2000 within 2999, spent 0:1000 0:2000
ask 0
execute, component 0, from 0: 0 1000 within 0, spent 0:0 0:1000
ask 0
execute, component 0, from 0: 0 0 within -1, spent 0:0
ask 0
execute, component 4, from 0: 0 hang 0 within 2000, spent 1:0
ask 1
execute, component 4, from 0: hang 0 0 0 within 2000, spent
release 1
ask 1
mode, component 4, from 0: 0 hang within 2000, spent 1:0
execute, component 8, from 0: 0 hang 0 within 2000, spent 2:0
ask 2
execute, component 8, from 0: hang 0 0 0 within 2000, spent
release 2
ask 2
mode, component 8, from 0: 0 hang within 2000, spent 2:0
execute, component 0, from 0: 0 0 0 within 60000000, spent 0:0 0:0 0:0
wait 1000
execute, component 0, from 0: 0 1000 0 1000 within 60000000, spent 0:0 0:1000 0:0 0:1000
execute, component 0, from 0: 1000 within 60000000, spent 0:1000
execute, component 0, from 7: 0 0 within 60000000, spent 0:0 0:0
update, component 0, from 0: 0 0 0 within 60000000, spent 0:0 0:0 0:0
mode, component 0, from 0: 1000 0 within 60000000, spent 0:1000 0:0
mode, component 0, from 0: 3000 0 within 2000, spent 0:3000
ask 0
execute, component 0, from 0: 0 5000 0 0 within 3000, spent 0:0 0:5000
ask 0
execute, component 0, from 0: 1000 2000 within 3000, spent 0:1000 0:2000
execute, component 0, from 0: 1000 2000 within 2999, spent 0:1000 0:2000
ask 0
execute, component 0, from 0: 0 1000 within 0, spent 0:0 0:1000
ask 0
execute, component 0, from 0: 0 0 within -1, spent 0:0
ask 0
ask 1
execute, component 4, from 0: hang within -1000, spent
release 1
ask 1
execute, component 4, from 0: 0 0 0 within 60000000, spent 1:0 1:0 1:0
execute, component 4, from 0: 0 1000 0 1000 within 60000000, spent 1:0 1:1000 1:0 1:1000
execute, component 4, from 0: 0 5000 0 0 within 3000, spent 1:0 1:5000
ask 1
execute, component 4, from 0: 0 hang 0 within 2000, spent 1:0
ask 2
execute, component 8, from 0: hang within -1000, spent
release 1
ask 1
release 2
ask 2
)";

TEST(HostContractTest, EachRuleRequestsTheWorkThatItsNameStates) {
    verifies("SWR-CNF-003", Technique::kBoundaryValues);
    std::string calls;
    EXPECT_TRUE(run_in_order(make_host_trials([&calls] {
                    return std::make_unique<RecordingHostRig>(calls);
                })).is_kept());
    EXPECT_EQ(calls, kRequests);
}

TEST(HostContractTest, TheStateNamesEachWindow) {
    verifies("SWR-CNF-003", Technique::kStateTransition);
    EXPECT_EQ(list_states(make_exact(HostFlaw::kNone), {0U, 6U, 11U, 13U, 17U}),
              (std::vector<std::string>{"new new new ", "in-time new new ", "late new new ",
                                        "late hangs new ", "late late new ", "late late hangs "}));
}

TEST(HostContractTest, EachRuleHasANameOfItsOwnAndARequirement) {
    verifies("SWR-CNF-003", Technique::kInterface);
    expect_named_rules(make_exact(HostFlaw::kNone));
}

}  // namespace
}  // namespace mamori::ports::conformance

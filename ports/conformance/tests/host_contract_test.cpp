// SPDX-License-Identifier: Apache-2.0
// Goal: the host rules accept a host that complies with its contract and report each violation. Method: hosts
// with one defect each, in simulated time if possible, else with real threads.
#include "mamori/ports/conformance/host_contract.hpp"

#include <gtest/gtest.h>

#include <ostream>

#include "mamori/ports/conformance/rule_runner.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/exact_host.hpp"
#include "support/rule_names.hpp"
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
        FlawCase{HostFlaw::kNeverSaysReturned, "SWR-CNF-005", "never returned"}));

TEST(HostContractTest, ACompliantHostIsAccepted) {
    verifies("SWR-CNF-003", Technique::kStateTransition);
    EXPECT_EQ(run_in_order(make_exact(HostFlaw::kNone)).to_text().substr(0U, 8U), "28 rules");
    EXPECT_TRUE(run_randomly(make_exact(HostFlaw::kNone), 3U, 5000U).is_kept());
    EXPECT_TRUE(run_in_order(make_threaded(ThreadFlaw::kNone)).is_kept());
    EXPECT_TRUE(run_randomly(make_threaded(ThreadFlaw::kNone), 5U, 300U).is_kept());
}

TEST(HostContractTest, AFalseReportOfTheEndOfAHangIsReported) {
    verifies("SWR-CNF-005", Technique::kFaultInjection, Polarity::kViolation);
    const Report report = run_in_order(make_threaded(ThreadFlaw::kSaysReturnedTooEarly));
    EXPECT_FALSE(report.is_kept());
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

TEST(HostContractTest, EachRuleHasANameOfItsOwnAndARequirement) {
    verifies("SWR-CNF-003", Technique::kInterface);
    expect_named_rules(make_exact(HostFlaw::kNone));
}

}  // namespace
}  // namespace mamori::ports::conformance

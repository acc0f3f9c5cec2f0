// SPDX-License-Identifier: Apache-2.0
// Goal: a run fails on exact evidence only, passes only without any doubt, and is inconclusive in between.
// Method: evidence made by hand, both sides of every limit.
#include "mamori/verification/run_verdict.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace mamori::verification {
namespace {

constexpr HostFigures kQuiet{};
HostFigures make_noisy(std::uint64_t stalls) {
    HostFigures host;
    host.stalls = stalls;
    host.longest_stall = Duration{345'678};
    return host;
}
RunEvidence make(const HostFigures& host) {
    RunEvidence evidence;
    evidence.instances = 1000U;
    evidence.shown = 20U;
    evidence.requested = 20U;
    evidence.host = host;
    return evidence;
}
RunVerdict assess(std::uint64_t RunEvidence::* member, std::uint64_t number, std::uint64_t stalls) {
    RunEvidence evidence = make(make_noisy(stalls));
    evidence.*member = number;
    return assess_run(evidence).verdict;
}

TEST(RunVerdictTest, ARunWithoutDeviationsPassesHoweverNoisyTheHostIs) {
    verifies("SWR-VER-022", Technique::kRequirementsBased);
    EXPECT_EQ(assess_run(make(kQuiet)).verdict, RunVerdict::kPassed);
    EXPECT_EQ(assess_run(make(kQuiet)).reason, "");
    EXPECT_EQ(assess_run(make(make_noisy(1'000'000U))).verdict, RunVerdict::kPassed);
}

TEST(RunVerdictTest, AViolationFailsWhateverTheHostDid) {
    verifies("SWR-VER-022", Technique::kFaultInjection, Polarity::kViolation);
    RunEvidence evidence = make(make_noisy(1'000'000U));
    evidence.violations = 1U;
    evidence.unexplained = 1U;
    evidence.suspected = 1U;
    evidence.set_aside = 1000U;
    evidence.shown = 0U;
    EXPECT_EQ(assess_run(evidence).verdict, RunVerdict::kFailed);
    EXPECT_EQ(assess_run(evidence).reason.find("1 violations; host: 1000000 stalls, longest 345 us"), 0U);
}

TEST(RunVerdictTest, DeviationsWhileNothingDisturbedFailUnlessAHundredTimesAsManyDisturbancesWereSeen) {
    verifies("SWR-VER-022", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(assess(&RunEvidence::unexplained, 1U, 0U), RunVerdict::kFailed);
    EXPECT_EQ(assess(&RunEvidence::unexplained, 1U, 99U), RunVerdict::kFailed);
    EXPECT_EQ(assess(&RunEvidence::unexplained, 1U, 100U), RunVerdict::kInconclusive);
    EXPECT_EQ(assess(&RunEvidence::unexplained, 3U, 299U), RunVerdict::kFailed);
    EXPECT_EQ(assess(&RunEvidence::unexplained, 3U, 300U), RunVerdict::kInconclusive);
}

TEST(RunVerdictTest, APartlyExplainedDeviationIsInconclusive) {
    verifies("SWR-VER-022", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(assess(&RunEvidence::suspected, 1U, 10U), RunVerdict::kInconclusive);
}

TEST(RunVerdictTest, OneInstanceOfAHundredMayBeSetAside) {
    verifies("SWR-VER-022", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(assess(&RunEvidence::set_aside, 10U, 10U), RunVerdict::kPassed);
    EXPECT_EQ(assess(&RunEvidence::set_aside, 11U, 10U), RunVerdict::kInconclusive);
}

TEST(RunVerdictTest, FaultsThatDidNotTakeEffectAreTheHostsOnlyIfItWasDisturbed) {
    verifies("SWR-VER-022", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(assess(&RunEvidence::shown, 19U, 1U), RunVerdict::kPassed);
    EXPECT_EQ(assess(&RunEvidence::shown, 18U, 1U), RunVerdict::kInconclusive);
    EXPECT_EQ(assess(&RunEvidence::shown, 18U, 0U), RunVerdict::kFailed);
}

TEST(RunVerdictTest, EachVerdictHasItsNameAndItsExitStatus) {
    verifies("SWR-VER-022", Technique::kInterface);
    EXPECT_STREQ(get_name(RunVerdict::kPassed), "passed");
    EXPECT_STREQ(get_name(RunVerdict::kFailed), "failed");
    EXPECT_STREQ(get_name(RunVerdict::kInconclusive), "inconclusive");
    EXPECT_EQ(get_exit_status(RunVerdict::kPassed), 0);
    EXPECT_EQ(get_exit_status(RunVerdict::kFailed), 1);
    EXPECT_EQ(get_exit_status(RunVerdict::kInconclusive), 4);
}

}  // namespace
}  // namespace mamori::verification

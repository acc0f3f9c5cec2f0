// SPDX-License-Identifier: Apache-2.0
// Goal: the runners apply rules whose preconditions hold, report the findings of the rules, and report how to
// reproduce them. Method: a trial whose port is a number.
#include "mamori/ports/conformance/rule_runner.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "mamori/ports/conformance/rule_trial.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::ports::conformance {
namespace {

using namespace verification;

struct Number {
    int value{0};
    std::string describe_state() const { return std::to_string(value); }
};

bool is_always(const Number&) {
    return true;
}
void add_one(Number& number, Judge&) {
    ++number.value;
}

/// Increments and decrements within 0 .. 3; reports a finding when the number reaches `limit`.
Rules<Number> make_steps(int limit) {
    return {{"down", "SWR-A-001", [](const Number& number) { return number.value > 0; },
             [](Number& number, Judge&) { --number.value; }},
            {"up", "SWR-A-002", [](const Number& number) { return number.value < 3; },
             [limit](Number& number, Judge& judge) {
                 ++number.value;
                 judge.expect(number.value < limit, "too high");
             }}};
}
TrialFactory make(const Rules<Number>& rules) {
    return [shared = std::make_shared<const Rules<Number>>(rules)] {
        return std::make_unique<RuleTrial<Number>>(shared, std::make_unique<Number>());
    };
}

TEST(RuleRunnerTest, TheFixedOrderRespectsPreconditionsAndRunsEachRule) {
    verifies("SWR-CNF-008", Technique::kStateTransition);
    const Report report = run_in_order(make(make_steps(10)));

    EXPECT_TRUE(report.is_kept()) << report.to_text();
    ASSERT_EQ(report.rules.size(), 2U);
    EXPECT_EQ(report.rules[0].count, 1U);
    EXPECT_EQ(report.rules[1].count, 1U);
    EXPECT_EQ(report.to_text(), "2 rules, 1 sequences, 2 steps, 2 states\n");
}

TEST(RuleRunnerTest, TheFixedOrderRepeatsRulesIfAPreconditionRequiresIt) {
    verifies("SWR-CNF-008", Technique::kBoundaryValues);
    Rules<Number> rules = make_steps(10);
    rules.push_back({"at three", "SWR-A-003", [](const Number& number) { return number.value == 3; },
                     [](Number&, Judge&) {}});
    rules.erase(rules.begin());

    EXPECT_TRUE(run_in_order(make(rules)).is_kept());
}

TEST(RuleRunnerTest, ASeedReproducesItsSequenceAndAnotherSeedGivesAnother) {
    verifies("SWR-CNF-008", Technique::kBackToBack);
    const std::string first = run_randomly(make(make_steps(3)), 7U, 1000U).to_text();

    EXPECT_EQ(run_randomly(make(make_steps(3)), 7U, 1000U).to_text(), first);
    EXPECT_NE(run_randomly(make(make_steps(3)), 8U, 1000U).to_text(), first);
}

TEST(RuleRunnerTest, TheRandomSequenceIsThatOfSplitMix64OnEachHost) {
    verifies("SWR-CNF-008", Technique::kBackToBack);
    Rules<Number> rules;
    for (const char* const name : {"a", "b", "c", "d", "e", "f", "g"}) {
        rules.push_back({name, "SWR-A-001", &is_always, [](Number& number, Judge& judge) {
                             judge.expect(++number.value < 12, "twelve steps");
                         }});
    }

    EXPECT_EQ(run_randomly(make(rules), 7U, 1000U).findings.at(0),
              "random order, seed 7, after 12 steps: rule 'b' (SWR-A-001): twelve steps; sequence: 2 3 0 3 5 "
              "6 5 0 6 0 6 1");
}

TEST(RuleRunnerTest, TheFixedOrderEndsAfterEightStepsPerRule) {
    verifies("SWR-CNF-009", Technique::kBoundaryValues, Polarity::kViolation);
    const auto run_with = [](int value) {
        return run_in_order(
            make({{"up", "SWR-A-001", &is_always, &add_one},
                  {"at", "SWR-A-002", [value](const Number& number) { return number.value == value; },
                   &add_one}}));
    };
    EXPECT_EQ(run_with(15).to_text(), "2 rules, 1 sequences, 16 steps, 17 states\n");
    const Report late = run_with(16);
    ASSERT_EQ(late.findings.size(), 1U);
    EXPECT_EQ(late.step_count, 16U);
    EXPECT_EQ(late.findings[0].find("fixed order, after 16 steps: rule 'at' (SWR-A-002) never ran"), 0U);
}

TEST(RuleRunnerTest, TheFixedOrderPrefersTheLeastAppliedRuleAndThenTheFirst) {
    verifies("SWR-CNF-008", Technique::kEquivalenceClasses);
    Rules<Number> rules{{"a", "SWR-A-001", &is_always, &add_one}, {"b", "SWR-A-002", &is_always, &add_one}};
    rules.push_back({"at five", "SWR-A-003", [](const Number& number) { return number.value == 5; },
                     [](Number&, Judge& judge) { judge.expect(false, "end"); }});

    EXPECT_EQ(run_in_order(make(rules)).findings.at(0),
              "fixed order, after 6 steps: rule 'at five' (SWR-A-003): end; sequence: 0 1 0 1 0 2");
}

/// A port of which only one may exist at a time.
struct Exclusive {
    explicit Exclusive(int& users) : users_(users) { EXPECT_EQ(++users_, 1); }
    ~Exclusive() { --users_; }
    Exclusive(const Exclusive&) = delete;
    Exclusive& operator=(const Exclusive&) = delete;
    std::string describe_state() const { return ""; }

  private:
    int& users_;
};

TEST(RuleRunnerTest, APortEndsBeforeTheNextOneBeginsAndBeforeTheReport) {
    verifies("SWR-CNF-010", Technique::kInterface);
    int users = 0;
    int trials = 0;
    const Rules<Exclusive> rules{
        {"a", "SWR-A-001", [](const Exclusive&) { return true; }, [](Exclusive&, Judge&) {}},
        {"b", "SWR-A-002", [](const Exclusive&) { return true; }, [](Exclusive&, Judge&) {}}};
    const TrialFactory factory = make_trials<Exclusive>(rules, [&users, &trials] {
        ++trials;
        return std::make_unique<Exclusive>(users);
    });

    const Report report = explore(factory, 2U);
    EXPECT_EQ(users, 0);
    EXPECT_EQ(report.sequence_count, 4U);
    EXPECT_EQ(trials, 2 + 4) << "the sequences of one rule, and of two";
}

TEST(RuleRunnerTest, AFindingNamesSeedSequenceRuleAndRequirementAndEndsTheRun) {
    verifies("SWR-CNF-008", Technique::kErrorGuessing, Polarity::kViolation);
    const Report report = run_randomly(make(make_steps(1)), 7U, 1000U);

    ASSERT_EQ(report.findings.size(), 1U);
    EXPECT_EQ(report.findings[0],
              "random order, seed 7, after 1 steps: rule 'up' (SWR-A-002): too high; sequence: 1");
    EXPECT_EQ(report.step_count, 1U);
    EXPECT_EQ(report.to_text(), report.findings[0] + "\n  0 down\n  1 up\n");
}

TEST(RuleRunnerTest, ASequenceIsReplayed) {
    verifies("SWR-CNF-008", Technique::kEquivalenceClasses);
    EXPECT_TRUE(replay(make(make_steps(3)), {1U, 0U, 1U}).is_kept());
    EXPECT_TRUE(replay(make(make_steps(3)), {}).is_kept());
    EXPECT_EQ(replay(make(make_steps(3)), {1U, 1U, 1U}).findings.at(0),
              "replay, after 3 steps: rule 'up' (SWR-A-002): too high; sequence: 1 1 1");
}

TEST(RuleRunnerTest, AnInapplicableSequenceIsAFinding) {
    verifies("SWR-CNF-008", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_EQ(replay(make(make_steps(3)), {0U}).findings.at(0),
              "replay, after 0 steps: rule 0 is not applicable here; sequence:");
    EXPECT_FALSE(replay(make(make_steps(3)), {2U}).is_kept());
}

TEST(RuleRunnerTest, ARuleThatNeverRanIsAFindingInEachOrder) {
    verifies("SWR-CNF-009", Technique::kErrorGuessing, Polarity::kViolation);
    Rules<Number> rules = make_steps(10);
    rules.push_back({"never", "SWR-A-003", [](const Number& number) { return number.value > 3; }, &add_one});

    for (const Report& report :
         {run_in_order(make(rules)), run_randomly(make(rules), 1U, 100U), explore(make(rules), 4U)}) {
        ASSERT_EQ(report.findings.size(), 1U);
        EXPECT_NE(report.findings[0].find("rule 'never' (SWR-A-003) never ran"), std::string::npos);
    }
    std::swap(rules.front(), rules.back());
    EXPECT_FALSE(run_in_order(make(rules)).is_kept()) << "also for the first rule";
}

TEST(RuleRunnerTest, AStateWithoutApplicableRuleIsAFinding) {
    verifies("SWR-CNF-009", Technique::kErrorGuessing, Polarity::kViolation);
    Rules<Number> rules = make_steps(10);
    rules.erase(rules.begin());

    EXPECT_EQ(run_randomly(make(rules), 1U, 100U).findings.at(0),
              "random order, seed 1, after 3 steps: no rule is applicable in state 3; sequence: 0 0 0");
    EXPECT_FALSE(explore(make(rules), 4U).is_kept());
    EXPECT_TRUE(explore(make(rules), 3U).is_kept());
}

TEST(RuleRunnerTest, WithoutMissingRulesThereIsNoFinding) {
    verifies("SWR-CNF-009");
    const Report report = run_randomly(make(make_steps(10)), 1U, 100U);
    EXPECT_TRUE(report.is_kept());
    EXPECT_EQ(report.step_count, 100U);
    EXPECT_TRUE(run_randomly(make(make_steps(10)), 1U, 0U).is_kept())
        << "the fixed order runs what is missing";
}

TEST(RuleRunnerTest, EveryOrderIsAppliedOnce) {
    verifies("SWR-CNF-010", Technique::kBoundaryValues);
    const Rules<Number> rules{{"a", "SWR-A-001", &is_always, &add_one},
                              {"b", "SWR-A-002", &is_always, &add_one},
                              {"c", "SWR-A-003", &is_always, &add_one}};

    EXPECT_EQ(explore(make(rules), 1U).to_text(), "3 rules, 3 sequences, 3 steps, 2 states\n");
    EXPECT_EQ(explore(make(rules), 4U).to_text(), "3 rules, 81 sequences, 324 steps, 5 states\n");
    // Up and down between 0 and 3: u{ud{u},du}
    EXPECT_EQ(explore(make(make_steps(10)), 3U).to_text(), "2 rules, 3 sequences, 9 steps, 4 states\n");
}

TEST(RuleRunnerTest, AFindingInEveryOrderShowsAShortestSequence) {
    verifies("SWR-CNF-010", Technique::kErrorGuessing, Polarity::kViolation);
    const Report report = explore(make(make_steps(2)), 9U);

    ASSERT_EQ(report.findings.size(), 1U);
    EXPECT_EQ(report.findings[0],
              "every order, depth 2, after 2 steps: rule 'up' (SWR-A-002): too high; sequence: 1 1");
}

TEST(RuleRunnerTest, AFindingInTheFirstStepShowsASequenceOfOneRule) {
    verifies("SWR-CNF-010", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(explore(make(make_steps(1)), 3U).findings.at(0),
              "every order, depth 1, after 1 steps: rule 'up' (SWR-A-002): too high; sequence: 1");
}

TEST(RuleRunnerTest, ADepthOfZeroAndAMissingPortAreContractViolations) {
    verifies("SWR-CNF-010", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_CHECK_FAILS(static_cast<void>(explore(make(make_steps(10)), 0U)), "rule_runner.cpp", 2);
    EXPECT_CHECK_FAILS(static_cast<void>(replay([] { return nullptr; }, {})), "rule_runner.cpp", 1);
}

TEST(JudgeTest, TheFirstFailedExpectationIsKept) {
    verifies("SWR-CNF-008", Technique::kEquivalenceClasses);
    Judge sut;
    sut.expect(true, "a");
    sut.expect_equal(1, 1, "b");
    sut.expect_equal(Instant{2}, Instant{2}, "c");
    EXPECT_FALSE(sut.has_finding());

    sut.expect_equal(Instant{3}, Instant{4}, "d");
    sut.expect_equal(5, 6, "e");
    sut.expect(false, "f");
    EXPECT_TRUE(sut.has_finding());
    EXPECT_EQ(sut.get_finding(), "d: 3, expected 4");
}

TEST(RuleRunnerTest, SelectedRulesAreAppliedWithoutTheOthers) {
    verifies("SWR-CNF-010", Technique::kEquivalenceClasses);
    const TrialFactory up = select_rules(make(make_steps(10)), {"up"});

    EXPECT_EQ(explore(up, 3U).to_text(), "1 rules, 1 sequences, 3 steps, 4 states\n");
    EXPECT_EQ(run_in_order(up).rules.at(0).requirement, "SWR-A-002");
    EXPECT_EQ(run_in_order(select_rules(make(make_steps(10)), {"up", "down"})).rules.size(), 2U);
}

TEST(RuleRunnerTest, AnUnknownRuleNameIsAContractViolation) {
    verifies("SWR-CNF-010", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_CHECK_FAILS(static_cast<void>(select_rules(make(make_steps(10)), {"u"})()), "trial.cpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(select_rules(make(make_steps(10)), {})()), "trial.cpp", 1);
}

TEST(RuleRunnerTest, ANondeterministicPortIsAFinding) {
    verifies("SWR-CNF-010", Technique::kFaultInjection, Polarity::kViolation);
    int trials = 0;
    Rules<Number> rules = make_steps(10);
    rules.push_back({"moody", "SWR-A-003", [&trials](const Number&) { return trials % 2 == 1; }, &add_one});
    const TrialFactory inner = make(rules);

    const Report report = explore(
        [&trials, &inner] {
            ++trials;
            return inner();
        },
        2U);

    ASSERT_EQ(report.findings.size(), 1U);
    EXPECT_NE(report.findings[0].find("led to a different state"), std::string::npos) << report.to_text();
}

}  // namespace
}  // namespace mamori::ports::conformance

// SPDX-License-Identifier: Apache-2.0
// Goal: the clock rules accept a clock that complies with its contract and report each violation. Method:
// clocks with one defect each.
#include "mamori/ports/conformance/clock_contract.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "mamori/ports/conformance/rule_runner.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/rule_names.hpp"

namespace mamori::ports::conformance {
namespace {

using namespace verification;

enum class ClockFlaw {
    kNone,
    kGoesBack,
    kSetBackByWaiting,
    kWakesEarly,
    kSkipsShortWaits,
    kOversleeps,
    kRunsAlone
};
using Calls = std::vector<std::string>;

class FlawedClock final : public ClockRig {
  public:
    FlawedClock(ClockFlaw flaw, bool is_exact, Calls* calls)
        : flaw_(flaw), is_exact_(is_exact), calls_(calls) {}

    Instant get_now() const override {
        ++readings_;
        if (flaw_ == ClockFlaw::kGoesBack && readings_ % 100U == 0U) {
            return now_ - 1_ns;
        }
        return flaw_ == ClockFlaw::kRunsAlone ? now_ + Duration{readings_} : now_;
    }
    void wait_until(Instant instant) override {
        if (calls_ != nullptr) {
            calls_->push_back(std::to_string(readings_) + " readings, wait " +
                              std::to_string((instant - now_).ns));
            readings_ = 0;
        }
        const bool is_skipped = flaw_ == ClockFlaw::kSkipsShortWaits && instant <= now_ + 1_ns;
        if (instant > now_ && !is_skipped) {
            now_ = flaw_ == ClockFlaw::kWakesEarly   ? instant - 1_ns
                   : flaw_ == ClockFlaw::kOversleeps ? instant + 1_ns
                                                     : instant;
        } else if (flaw_ == ClockFlaw::kSetBackByWaiting) {
            now_ = instant;
        }
    }
    Duration get_tick() const override { return 1_ms; }
    bool is_exact() const override { return is_exact_; }

  private:
    ClockFlaw flaw_;
    bool is_exact_;
    Calls* calls_;
    Instant now_{1'234'567};
    mutable std::int64_t readings_{0};
};

/// @param[out] calls receives the waits with the number of readings before each, unless it is nullptr.
TrialFactory make(ClockFlaw flaw, bool is_exact, Calls* calls = nullptr) {
    return make_clock_trials(
        [flaw, is_exact, calls] { return std::make_unique<FlawedClock>(flaw, is_exact, calls); });
}

struct FlawCase {
    ClockFlaw flaw;
    bool is_exact;
    const char* sentence;
};
void PrintTo(const FlawCase& flaw, std::ostream* out) {
    *out << flaw.sentence << (flaw.is_exact ? ", exact" : "");
}

class ClockFlawTest : public ::testing::TestWithParam<FlawCase> {};

TEST_P(ClockFlawTest, IsReportedInEachOrder) {
    verifies("SWR-CNF-001", Technique::kFaultInjection, Polarity::kViolation);
    const TrialFactory factory = make(GetParam().flaw, GetParam().is_exact);

    const Report report = run_in_order(factory);
    ASSERT_FALSE(report.is_kept());
    EXPECT_NE(report.findings[0].find(GetParam().sentence), std::string::npos) << report.to_text();
    EXPECT_FALSE(run_randomly(factory, 1U, 1000U).is_kept());
    EXPECT_FALSE(explore(factory, 3U).is_kept());
}

INSTANTIATE_TEST_SUITE_P(
    All, ClockFlawTest,
    ::testing::Values(FlawCase{ClockFlaw::kGoesBack, false, "the clock ran backwards"},
                      FlawCase{ClockFlaw::kSetBackByWaiting, false, "the clock ran backwards"},
                      FlawCase{ClockFlaw::kWakesEarly, false, "ended before its instant"},
                      FlawCase{ClockFlaw::kSkipsShortWaits, false, "ended before its instant"},
                      FlawCase{ClockFlaw::kOversleeps, true, "did not end at its instant"},
                      FlawCase{ClockFlaw::kRunsAlone, true, "time passed without a wait"}));

TEST(ClockContractTest, ACompliantClockIsAccepted) {
    verifies("SWR-CNF-001", Technique::kEquivalenceClasses);
    EXPECT_TRUE(explore(make(ClockFlaw::kNone, true), 3U).is_kept());
    EXPECT_TRUE(explore(make(ClockFlaw::kNone, false), 3U).is_kept());
    EXPECT_TRUE(run_in_order(make(ClockFlaw::kOversleeps, false)).is_kept()) << "a busy host";
    EXPECT_TRUE(run_in_order(make(ClockFlaw::kRunsAlone, false)).is_kept()) << "as real time does";
}

TEST(ClockContractTest, EachRuleReadsAndWaitsAsItsNameStates) {
    verifies("SWR-CNF-001", Technique::kBoundaryValues);
    Calls calls;
    EXPECT_TRUE(run_in_order(make(ClockFlaw::kNone, true, &calls)).is_kept());
    EXPECT_EQ(calls, (Calls{"1002 readings, wait 1000000", "2 readings, wait 1", "2 readings, wait 0",
                            "2 readings, wait -2000000", "2 readings, wait 1999999"}));

    calls.clear();
    EXPECT_TRUE(replay(make(ClockFlaw::kNone, true, &calls), {1U, 1U, 1U, 1U, 5U, 5U}).is_kept());
    ASSERT_EQ(calls.size(), 6U);
    EXPECT_EQ(calls[4], "2 readings, wait 2000000") << "to the next multiple of three ticks";
    EXPECT_EQ(calls[5], "2 readings, wait 3000000");
}

TEST(ClockContractTest, TheStateIsThePositionInAPeriodOfTheSchedule) {
    verifies("SWR-CNF-001", Technique::kStateTransition);
    EXPECT_EQ(list_states(make(ClockFlaw::kNone, true), {1U, 2U, 1U, 1U, 3U}),
              (Calls{"0", "1000000", "1000001", "2000001", "1", "1"}));
    EXPECT_EQ(list_states(make(ClockFlaw::kNone, false), {1U}), (Calls{"running", "running"}));
}

TEST(ClockContractTest, EachRuleHasANameOfItsOwnAndARequirement) {
    verifies("SWR-CNF-001", Technique::kInterface);
    expect_named_rules(make(ClockFlaw::kNone, true));
}

}  // namespace
}  // namespace mamori::ports::conformance

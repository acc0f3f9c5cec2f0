// SPDX-License-Identifier: Apache-2.0
// Goal: the watchdog rules accept a watchdog that complies with its contract and report each violation.
// Method: watchdogs with one defect each, in simulated time and in a time that also passes between two
// readings.
#include "mamori/ports/conformance/watchdog_contract.hpp"

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

enum class WatchdogFlaw {
    kNone,
    kStartsByItself,
    kBitesEarly,
    kBitesLate,
    kNeverBites,
    kClosesAgain,
    kTakesServiceWhenOpen,
    kLateServiceHidesIt,
    kRefusesInTime,
    kHidesItsRelay,
    kShowsItsRelayOpen,
};

class FlawedWatchdog final : public WatchdogRig, public safety::Watchdog {
  public:
    /// @param[in]  step  time of each reading of the clock.
    /// @param[out] calls receives one line per request, unless it is nullptr.
    FlawedWatchdog(WatchdogFlaw flaw, Duration step, std::string* calls)
        : flaw_(flaw), step_(step), calls_(calls) {
        note("new");
    }

    ~FlawedWatchdog() override { note("end"); }
    FlawedWatchdog(const FlawedWatchdog&) = delete;
    FlawedWatchdog& operator=(const FlawedWatchdog&) = delete;

    safety::Watchdog& get_watchdog() override { return *this; }
    Duration get_timeout() const override { return kTimeout; }
    Instant get_now() const override {
        now_ = now_ + step_;
        return now_;
    }
    void let_pass(Duration time) override {
        note("wait " + std::to_string(time.ns));
        now_ = now_ + time;
    }
    bool has_expired() override {
        note("look");
        check();
        return (is_open_ && !has(WatchdogFlaw::kHidesItsRelay)) || has(WatchdogFlaw::kShowsItsRelayOpen);
    }
    Status service(Instant now) noexcept override {
        note(now == now_ ? "service" : "service at another time");
        check_unless_hidden();
        if (has(WatchdogFlaw::kClosesAgain)) {
            is_open_ = false;
        }
        if ((is_open_ && !has(WatchdogFlaw::kTakesServiceWhenOpen)) ||
            (has(WatchdogFlaw::kRefusesInTime) && is_started_)) {
            return Status::kError;
        }
        is_started_ = true;
        serviced_at_ = now_;
        return Status::kOk;
    }

  private:
    static constexpr Duration kTimeout{1000};

    bool has(WatchdogFlaw flaw) const noexcept { return flaw_ == flaw; }
    void note(const std::string& call) {
        if (calls_ != nullptr) {
            *calls_ += call + "\n";
        }
    }
    void check_unless_hidden() noexcept {
        if (!has(WatchdogFlaw::kLateServiceHidesIt)) {
            check();
        }
    }
    void check() noexcept {
        const Duration limit = has(WatchdogFlaw::kBitesEarly)  ? kTimeout - 1_ns
                               : has(WatchdogFlaw::kBitesLate) ? kTimeout * 4
                                                               : kTimeout;
        const bool is_counting = is_started_ || has(WatchdogFlaw::kStartsByItself);
        const bool is_over = is_counting && now_ - serviced_at_ > limit;
        is_open_ = is_open_ || (is_over && !has(WatchdogFlaw::kNeverBites));
    }

    WatchdogFlaw flaw_;
    Duration step_;
    std::string* calls_;
    mutable Instant now_{};
    Instant serviced_at_{};
    bool is_started_{false};
    bool is_open_{false};
};

TrialFactory make(WatchdogFlaw flaw, Duration step, std::string* calls = nullptr) {
    return make_watchdog_trials(
        [flaw, step, calls] { return std::make_unique<FlawedWatchdog>(flaw, step, calls); });
}

struct FlawCase {
    WatchdogFlaw flaw;
    const char* sentence;
};
void PrintTo(const FlawCase& flaw, std::ostream* out) {
    *out << flaw.sentence;
}

class WatchdogFlawTest : public ::testing::TestWithParam<FlawCase> {};

TEST_P(WatchdogFlawTest, IsReportedInEachOrder) {
    verifies("SWR-CNF-006", Technique::kFaultInjection, Polarity::kViolation);
    const TrialFactory factory = make(GetParam().flaw, 0_ns);

    const Report report = run_in_order(factory);
    ASSERT_FALSE(report.is_kept());
    EXPECT_NE(report.findings[0].find(GetParam().sentence), std::string::npos) << report.to_text();
    EXPECT_FALSE(run_randomly(factory, 1U, 1000U).is_kept());
    EXPECT_FALSE(explore(factory, 3U).is_kept());
}

INSTANTIATE_TEST_SUITE_P(
    All, WatchdogFlawTest,
    ::testing::Values(
        FlawCase{WatchdogFlaw::kStartsByItself, "opened before the timeout"},
        FlawCase{WatchdogFlaw::kBitesEarly, "opened before the timeout"},
        FlawCase{WatchdogFlaw::kBitesLate, "a service was accepted though the relay is open"},
        FlawCase{WatchdogFlaw::kNeverBites, "a service was accepted though the relay is open"},
        FlawCase{WatchdogFlaw::kClosesAgain, "a service was accepted though the relay is open"},
        FlawCase{WatchdogFlaw::kTakesServiceWhenOpen, "a service was accepted though the relay is open"},
        FlawCase{WatchdogFlaw::kLateServiceHidesIt, "a service was accepted though the relay is open"},
        FlawCase{WatchdogFlaw::kRefusesInTime, "a service in time was rejected"},
        FlawCase{WatchdogFlaw::kHidesItsRelay, "the relay is closed though the timeout has elapsed"},
        FlawCase{WatchdogFlaw::kShowsItsRelayOpen, "the relay opened before the timeout"}));

TEST(WatchdogContractTest, ACompliantWatchdogIsAcceptedInEachOrder) {
    verifies("SWR-CNF-006", Technique::kStateTransition);
    for (const Duration step : {0_ns, 1_ns, 300_ns}) {
        EXPECT_TRUE(run_in_order(make(WatchdogFlaw::kNone, step)).is_kept());
        EXPECT_TRUE(explore(make(WatchdogFlaw::kNone, step), 4U).is_kept());
    }
}

TEST(WatchdogContractTest, TimeThatPassesDuringReadingsHidesNoLargeDefect) {
    verifies("SWR-CNF-006", Technique::kErrorGuessing, Polarity::kViolation);
    for (const WatchdogFlaw flaw :
         {WatchdogFlaw::kStartsByItself, WatchdogFlaw::kNeverBites, WatchdogFlaw::kClosesAgain,
          WatchdogFlaw::kTakesServiceWhenOpen, WatchdogFlaw::kRefusesInTime}) {
        EXPECT_FALSE(run_in_order(make(flaw, 10_ns)).is_kept()) << static_cast<int>(flaw);
    }
}

TEST(WatchdogContractTest, EachRuleRequestsWhatItsNameStates) {
    verifies("SWR-CNF-006", Technique::kBoundaryValues);
    std::string calls;
    EXPECT_TRUE(run_in_order(make(WatchdogFlaw::kNone, 0_ns, &calls)).is_kept());
    EXPECT_EQ(calls,
              "new\nwait 2000\nlook\n"
              "service\nlook\n"
              "service\nlook\n"
              "wait 250\nlook\n"
              "wait 750\nlook\nservice\nlook\n"
              "wait 1001\nservice\nlook\n"
              "service\nlook\n"
              "wait 2000\nlook\n"
              "end\nnew\nlook\n"
              "wait 2000\nlook\n"
              "service\nlook\n"
              "wait 2000\nlook\nend\n");
}

TEST(WatchdogContractTest, AWaitForALimitSubtractsTheTimeOfTheReadingsAndIsNeverNegative) {
    verifies("SWR-CNF-006", Technique::kBoundaryValues);
    for (const auto& [step, wait] : {std::make_pair(0_ns, "1001"), std::make_pair(1_ns, "997"),
                                     std::make_pair(250_ns, "1"), std::make_pair(400_ns, "0")}) {
        std::string calls;
        EXPECT_TRUE(replay(make(WatchdogFlaw::kNone, step, &calls), {1U, 5U}).is_kept());
        EXPECT_EQ(calls, "new\nservice\nlook\nwait " + std::string{wait} + "\nservice\nlook\nend\n");
    }
}

TEST(WatchdogContractTest, TheStateContainsTheQuartersOfTheTimeoutSinceTheLastService) {
    verifies("SWR-CNF-006", Technique::kStateTransition);
    EXPECT_EQ(list_states(make(WatchdogFlaw::kNone, 0_ns), {0U, 1U, 3U, 3U, 2U, 3U, 3U, 3U, 3U, 6U, 9U}),
              (std::vector<std::string>{"0 0", "0 0", "1 0", "1 1", "1 2", "1 0", "1 1", "1 2", "1 3", "1 4",
                                        "2 0", "0 0"}));
    EXPECT_EQ(list_states(make(WatchdogFlaw::kNone, 450_ns), {1U}).back(), "1 4") << "at most four";
    EXPECT_EQ(list_states(make(WatchdogFlaw::kNone, 300_ns), {1U}).back(), "1 3")
        << "300 ns for each of the three readings";
}

TEST(WatchdogContractTest, EachRuleHasANameOfItsOwnAndARequirement) {
    verifies("SWR-CNF-006", Technique::kInterface);
    expect_named_rules(make(WatchdogFlaw::kNone, 1_ns));
}

}  // namespace
}  // namespace mamori::ports::conformance

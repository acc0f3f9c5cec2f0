// SPDX-License-Identifier: Apache-2.0
// Goal: the timer rules accept a timer that complies with its contract and report each violation. Method:
// timers in simulated time with one defect each.
#include "mamori/ports/conformance/timer_contract.hpp"

#include <gtest/gtest.h>

#include <array>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "mamori/kernel/run/frame_schedule.hpp"
#include "mamori/ports/conformance/rule_runner.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/rule_names.hpp"

namespace mamori::ports::conformance {
namespace {

using namespace verification;

enum class TimerFlaw {
    kNone,
    kDrifts,
    kOpensEarly,
    kWorksEarly,
    kOpensLate,
    kSkipsAfterOverrun,
    kOpensTwice,
    kGoesBack,
    kRunsOneMore,
    kRunsTwentyMore,
    kFirstOpensOnceMore,
    kSecondOpensOnceMore,
    kBeginsLate,
    kSkipsSilently,
    kSkipsAndReports,
    kReportsFalseSkip,
    kReportsNoOverrun,
    kReportsFalseOverrun,
    kFirstNeverReturns,
    kSecondNeverReturns,
    kOpensVeryLate
};

/// What the rules request of a timer.
struct Requests {
    std::vector<std::string> calls;
    std::set<std::string> windows;  ///< budget of a window and time that its component spends
};

/// Runs work immediately, with the execution time that the test specifies. Aborted work returns 3 ms
/// later.
class SpotHost final : public WindowHost {
  public:
    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return step_end; }
    bool has_returned(std::size_t window) const noexcept override {
        return window != lost_window && now >= returns_at;
    }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        const Duration time = work.component == 0U ? time_of_first : Duration{0};
        const bool is_in_time = now + time <= deadline;
        step_end = is_in_time ? now + time : deadline + 1_ns;
        now = now - early;
        work.run(work.argument, work.first, work.first + 1U);
        now = now + early;
        requests->windows.insert(std::to_string(work.window) + ": " + std::to_string((deadline - now).ns) +
                                 " spends " + std::to_string(spent.ns));
        now = is_in_time ? now + time : deadline;
        returns_at = is_in_time ? returns_at : deadline + 3_ms;
        return is_in_time ? 1U : 0U;
    }

    Instant now{};
    Instant step_end{};
    Duration time_of_first{};
    Duration early{};  ///< amount by which the clock is early during the work
    Duration spent{};
    Instant returns_at{};
    std::size_t lost_window{2U};  ///< whose work never returns
    Requests* requests{nullptr};
};

class FlawedTimer final : public TimerRig {
  public:
    FlawedTimer(Executive& executive, TimerFlaw flaw, bool is_exact, Requests* requests)
        : executive_(executive), flaw_(flaw), is_exact_(is_exact), requests_(requests) {
        host_.early = has(TimerFlaw::kWorksEarly) ? 1_ns : 0_ns;
        host_.lost_window = has(TimerFlaw::kFirstNeverReturns)    ? 0U
                            : has(TimerFlaw::kSecondNeverReturns) ? 1U
                                                                  : 2U;
        host_.requests = requests_ == nullptr ? &ignored_ : requests_;
        frame_ = has(TimerFlaw::kBeginsLate) ? Instant{} + kFrame : Instant{};
    }

    void run(std::uint64_t frame_count) override {
        host_.requests->calls.push_back("run " + std::to_string(frame_count));
        const std::uint64_t count = frame_count + (has(TimerFlaw::kRunsOneMore)      ? 1U
                                                   : has(TimerFlaw::kRunsTwentyMore) ? 20U
                                                                                     : 0U);
        for (std::uint64_t i = 0U; i < count; ++i) {
            run_frame();
        }
        if (has(TimerFlaw::kFirstOpensOnceMore)) {
            open(0U, frame_);
        } else if (has(TimerFlaw::kSecondOpensOnceMore)) {
            open(1U, frame_ + 4_ms);
        }
        if (has(TimerFlaw::kGoesBack)) {
            frame_ = frame_ - kFrame;
        }
    }
    Counts get_counts() const override { return counts_; }
    WindowHost& get_host() override { return host_; }
    void wait_until(Instant instant) override {
        const Duration time = instant - host_.now;
        host_.requests->calls.push_back("wait " + std::to_string(time.ns));
        host_.now = time > Duration{0} ? instant : host_.now;
    }
    bool is_exact() const override { return is_exact_; }
    void plan(std::size_t component, Duration time) override {
        host_.requests->calls.push_back("plan " + std::to_string(component) + " " + std::to_string(time.ns));
        host_.time_of_first = time;
    }
    void spend(Duration time) noexcept override { host_.spent = time; }

  private:
    static constexpr Duration kFrame = 8_ms;

    bool has(TimerFlaw flaw) const { return flaw_ == flaw; }

    void run_frame() {
        const bool has_overrun = open(0U, frame_);
        if (has(TimerFlaw::kOpensTwice)) {
            open(0U, frame_);
        }
        const bool is_skipped = (has_overrun && has(TimerFlaw::kSkipsAfterOverrun)) ||
                                has(TimerFlaw::kSkipsSilently) || has(TimerFlaw::kSkipsAndReports);
        if (!is_skipped) {
            open(1U, frame_ + 4_ms);
        }
        counts_.missed += has(TimerFlaw::kSkipsAndReports) || has(TimerFlaw::kReportsFalseSkip) ? 1U : 0U;
        frame_ = frame_ + kFrame + (has(TimerFlaw::kDrifts) ? 1_us : 0_us);
    }

    bool open(std::size_t window, Instant planned) {
        host_.now = has(TimerFlaw::kOpensEarly)      ? planned - 1_ns
                    : has(TimerFlaw::kOpensLate)     ? planned + 1_ns
                    : has(TimerFlaw::kOpensVeryLate) ? planned + 2_ms
                                                     : planned;
        const bool has_overrun = executive_.run_window(window, planned, host_) == WindowOutcome::kOverrun;
        const bool is_reported =
            (has_overrun && !has(TimerFlaw::kReportsNoOverrun)) || has(TimerFlaw::kReportsFalseOverrun);
        counts_.overran += is_reported ? 1U : 0U;
        return has_overrun;
    }

    Executive& executive_;
    TimerFlaw flaw_;
    bool is_exact_;
    Requests* requests_;
    Requests ignored_;
    SpotHost host_;
    Instant frame_{};
    Counts counts_{};
};

TrialFactory make(TimerFlaw flaw, bool is_exact = true, Requests* requests = nullptr) {
    return make_timer_trials([flaw, is_exact, requests](Executive& executive) {
        return std::make_unique<FlawedTimer>(executive, flaw, is_exact, requests);
    });
}

struct FlawCase {
    TimerFlaw flaw;
    const char* sentence;
};
void PrintTo(const FlawCase& flaw, std::ostream* out) {
    *out << flaw.sentence;
}

class TimerFlawTest : public ::testing::TestWithParam<FlawCase> {};

TEST_P(TimerFlawTest, IsReportedInEachOrder) {
    verifies("SWR-CNF-011", Technique::kFaultInjection, Polarity::kViolation);
    const TrialFactory factory = make(GetParam().flaw);

    const Report report = run_in_order(factory);
    ASSERT_FALSE(report.is_kept());
    EXPECT_NE(report.findings[0].find(GetParam().sentence), std::string::npos) << report.to_text();
    EXPECT_FALSE(run_randomly(factory, 1U, 1000U).is_kept());
    EXPECT_FALSE(explore(factory, 3U).is_kept());
}

INSTANTIATE_TEST_SUITE_P(
    All, TimerFlawTest,
    ::testing::Values(FlawCase{TimerFlaw::kDrifts, "started at an instant that is not on the schedule"},
                      FlawCase{TimerFlaw::kWorksEarly, "started before its instant"},
                      FlawCase{TimerFlaw::kOpensLate, "did not start at its instant"},
                      FlawCase{TimerFlaw::kSkipsAfterOverrun, "window instances: 1, expected 2"},
                      FlawCase{TimerFlaw::kOpensTwice, "started twice in a major frame"},
                      FlawCase{TimerFlaw::kGoesBack, "out of order"},
                      FlawCase{TimerFlaw::kRunsOneMore, "more major frames ran"},
                      FlawCase{TimerFlaw::kRunsTwentyMore, "more major frames ran"},
                      FlawCase{TimerFlaw::kFirstOpensOnceMore, "more major frames ran"},
                      FlawCase{TimerFlaw::kSecondOpensOnceMore, "more major frames ran"},
                      FlawCase{TimerFlaw::kBeginsLate, "first major frame: 1, expected 0"},
                      FlawCase{TimerFlaw::kSkipsSilently, "did not start and was not reported as skipped"},
                      FlawCase{TimerFlaw::kReportsFalseSkip, "started more than once in a major frame"},
                      FlawCase{TimerFlaw::kReportsNoOverrun, "overruns: 0, expected 1"},
                      FlawCase{TimerFlaw::kReportsFalseOverrun, "overruns: 2, expected 0"},
                      FlawCase{TimerFlaw::kFirstNeverReturns, "late work never returned"},
                      FlawCase{TimerFlaw::kSecondNeverReturns, "late work never returned"}));

TEST(TimerContractTest, ATimerThatStartsWindowsEarlyFailsACheckOfTheKernel) {
    verifies("SWR-CNF-011", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_CHECK_FAILS(static_cast<void>(run_in_order(make(TimerFlaw::kOpensEarly))), "executive.cpp", 3);
}

TEST(TimerContractTest, ACompliantTimerIsAcceptedInEachOrder) {
    verifies("SWR-CNF-011", Technique::kStateTransition);
    EXPECT_TRUE(run_randomly(make(TimerFlaw::kNone), 1U, 2000U).is_kept());
    EXPECT_EQ(explore(make(TimerFlaw::kNone), 8U).to_text(),
              "6 rules, 6561 sequences, 52488 steps, 4 states\n");
}

TEST(TimerContractTest, ATimerOfABusyHostIsAccepted) {
    verifies("SWR-CNF-011", Technique::kEquivalenceClasses);
    for (const TimerFlaw late : {TimerFlaw::kOpensLate, TimerFlaw::kOpensVeryLate, TimerFlaw::kBeginsLate,
                                 TimerFlaw::kSkipsAndReports, TimerFlaw::kReportsFalseOverrun}) {
        const Report report = run_randomly(make(late, false), 1U, 200U);
        EXPECT_TRUE(report.is_kept()) << static_cast<int>(late) << ": " << report.to_text();
    }
}

TEST(TimerContractTest, EachRuleRequestsTheWindowsThatItsNameStates) {
    verifies("SWR-CNF-011", Technique::kBoundaryValues);
    Requests requests;
    EXPECT_TRUE(run_in_order(make(TimerFlaw::kNone, true, &requests)).is_kept());
    EXPECT_EQ(requests.calls,
              (std::vector<std::string>{"run 1", "run 4", "plan 0 5000000", "run 1", "wait 1000000", "run 4",
                                        "wait 1000000", "plan 0 0"}));
    EXPECT_EQ(requests.windows, (std::set<std::string>{"0: 2000000 spends 0", "0: 2000000 spends 5000000",
                                                       "1: 2000000 spends 0"}));

    Requests late;
    EXPECT_TRUE(run_in_order(make(TimerFlaw::kOpensVeryLate, false, &late)).is_kept());
    EXPECT_EQ(late.windows, (std::set<std::string>{"0: 1000000 spends 0", "0: 1000000 spends 5000000",
                                                   "1: 1000000 spends 0"}))
        << "each window ends 3 ms after its planned start";
}

TEST(TimerContractTest, TheStateStatesWhetherAComponentIsSlowAndATimerHasRun) {
    verifies("SWR-CNF-011", Technique::kStateTransition);
    EXPECT_EQ(list_states(make(TimerFlaw::kNone), {2U, 5U, 0U, 2U}),
              (std::vector<std::string>{"fast new", "slow new", "fast new", "fast running", "slow running"}));
}

TEST(TimerContractTest, EachRuleHasANameOfItsOwnAndARequirement) {
    verifies("SWR-CNF-011", Technique::kInterface);
    expect_named_rules(make(TimerFlaw::kNone));
}

}  // namespace
}  // namespace mamori::ports::conformance

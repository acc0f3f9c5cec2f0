// SPDX-License-Identifier: Apache-2.0
// Goal: the timer rules accept a timer that complies with its contract and report each violation. Method:
// timers in simulated time with one defect each.
#include "mamori/ports/conformance/timer_contract.hpp"

#include <gtest/gtest.h>

#include <array>
#include <ostream>

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
    kRunsOneMore
};

/// Runs work immediately, with the execution time that the test specifies.
class SpotHost final : public WindowHost {
  public:
    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return step_end; }
    bool has_returned(std::size_t) const noexcept override { return true; }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        const Duration time = work.component == 0U ? time_of_first : Duration{0};
        const bool is_in_time = now + time <= deadline;
        step_end = is_in_time ? now + time : deadline + 1_ns;
        now = now - early;
        work.run(work.argument, work.first, work.first + 1U);
        now = now + early;
        now = is_in_time ? now + time : deadline;
        return is_in_time ? 1U : 0U;
    }

    Instant now{};
    Instant step_end{};
    Duration time_of_first{};
    Duration early{};  ///< amount by which the clock is early during the work
};

class FlawedTimer final : public TimerRig {
  public:
    FlawedTimer(Executive& executive, TimerFlaw flaw) : executive_(executive), flaw_(flaw) {
        host_.early = has(TimerFlaw::kWorksEarly) ? 1_ns : 0_ns;
    }

    void run(std::uint64_t frame_count) override {
        const std::uint64_t count = frame_count + (has(TimerFlaw::kRunsOneMore) ? 1U : 0U);
        for (std::uint64_t i = 0U; i < count; ++i) {
            run_frame();
        }
        if (has(TimerFlaw::kGoesBack)) {
            frame_ = frame_ - kFrame;
        }
    }
    Counts get_counts() const override { return counts_; }
    WindowHost& get_host() override { return host_; }
    void wait_until(Instant instant) override { host_.now = instant > host_.now ? instant : host_.now; }
    bool is_exact() const override { return true; }
    void plan(std::size_t, Duration time) override { host_.time_of_first = time; }
    void spend(Duration) noexcept override {}

  private:
    static constexpr Duration kFrame = 8_ms;

    bool has(TimerFlaw flaw) const { return flaw_ == flaw; }

    void run_frame() {
        const bool has_overrun = open(0U, frame_);
        if (has(TimerFlaw::kOpensTwice)) {
            open(0U, frame_);
        }
        if (!(has_overrun && has(TimerFlaw::kSkipsAfterOverrun))) {
            open(1U, frame_ + 4_ms);
        }
        frame_ = frame_ + kFrame + (has(TimerFlaw::kDrifts) ? 1_us : 0_us);
    }

    bool open(std::size_t window, Instant planned) {
        host_.now = has(TimerFlaw::kOpensEarly)  ? planned - 1_ns
                    : has(TimerFlaw::kOpensLate) ? planned + 1_ns
                                                 : planned;
        const bool has_overrun = executive_.run_window(window, planned, host_) == WindowOutcome::kOverrun;
        counts_.overran += has_overrun ? 1U : 0U;
        return has_overrun;
    }

    Executive& executive_;
    TimerFlaw flaw_;
    SpotHost host_;
    Instant frame_{};
    Counts counts_{};
};

TrialFactory make(TimerFlaw flaw) {
    return make_timer_trials(
        [flaw](Executive& executive) { return std::make_unique<FlawedTimer>(executive, flaw); });
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
                      FlawCase{TimerFlaw::kRunsOneMore, "more major frames ran"}));

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

TEST(TimerContractTest, EachRuleHasANameOfItsOwnAndARequirement) {
    verifies("SWR-CNF-011", Technique::kInterface);
    expect_named_rules(make(TimerFlaw::kNone));
}

}  // namespace
}  // namespace mamori::ports::conformance

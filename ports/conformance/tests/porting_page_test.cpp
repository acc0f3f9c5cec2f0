// SPDX-License-Identifier: Apache-2.0
// Goal: the code of docs/manual/porting.md compiles and accepts a clock. Method: a copy of its code blocks;
// verification/checks/manual_samples.py compares both.
#include <gtest/gtest.h>

#include <memory>

#include "mamori/trace/verifies.hpp"
#include "support/my_clock.hpp"

#include "mamori/ports/conformance/clock_contract.hpp"
#include "mamori/ports/conformance/rule_runner.hpp"
namespace conformance = mamori::ports::conformance;

class MyClockRig final : public conformance::ClockRig {
  public:
    mamori::Instant get_now() const override { return clock_.get_now(); }
    void wait_until(mamori::Instant instant) override { clock_.wait_until(instant); }
    mamori::Duration get_tick() const override { return mamori::Duration{1'000'000}; }
    bool is_exact() const override { return false; }  // true where time is simulated

  private:
    MyClock clock_;
};

TEST(PortingPageTest, TheClockOfThePageIsCompliant) {
    mamori::verification::verifies("SWR-CNF-008", mamori::verification::Technique::kInterface);

    const auto trials = conformance::make_clock_trials([] { return std::make_unique<MyClockRig>(); });
    for (const conformance::Report& report :
         {conformance::run_in_order(trials), conformance::run_randomly(trials, 1U, 1000U),
          conformance::explore(trials, 3U)}) {
        EXPECT_TRUE(report.is_kept()) << report.to_text();
    }
}

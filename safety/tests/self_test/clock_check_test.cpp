// SPDX-License-Identifier: Apache-2.0
// Goal: a clock that is not as fast as another one, or two that stand, fail their test.
// Method: two scripted clocks, both sides of the bound.
#include "mamori/safety/self_test/clock_check.hpp"

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_clock.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

class ClockCheckTest : public ::testing::Test {
  protected:
    SelfTestStatus run_pass() {
        sut_.begin();
        SelfTestStatus status = SelfTestStatus::kRunning;
        for (std::size_t i = 0U; i < sut_.get_step_count() && status == SelfTestStatus::kRunning; ++i) {
            status = sut_.step();
        }
        return status;
    }

    FakeClock reference_{100000};
    FakeClock checked_{100000};
    ClockCheck sut_{
        reference_, checked_, {Duration{1000000}, 1000U}, 11U};  // 1000 ns in a window of ten steps
};

TEST_F(ClockCheckTest, ClocksThatRunAlikePass) {
    verifies("SWR-SLF-011", Technique::kBoundaryValues);
    EXPECT_EQ(sut_.get_step_count(), 11U);
    EXPECT_EQ(run_pass(), SelfTestStatus::kPassed);

    checked_.step_ns = 100100;
    EXPECT_EQ(run_pass(), SelfTestStatus::kPassed);
    checked_.step_ns = 99900;
    EXPECT_EQ(run_pass(), SelfTestStatus::kPassed);
}

TEST_F(ClockCheckTest, ClockThatIsTooFastOrTooSlowFails) {
    verifies("SWR-SLF-011", Technique::kBoundaryValues, Polarity::kViolation);

    for (const std::int64_t step_ns : {100101, 99899, 200000, 1, 0, -100000}) {
        checked_.step_ns = step_ns;
        EXPECT_EQ(run_pass(), SelfTestStatus::kFailed) << step_ns;
    }
    checked_.step_ns = 100000;
    EXPECT_EQ(run_pass(), SelfTestStatus::kPassed) << "each pass begins anew";
    reference_.step_ns = 0;
    EXPECT_EQ(run_pass(), SelfTestStatus::kFailed);
}

TEST_F(ClockCheckTest, ClocksThatBothStandOrCrawlFail) {
    verifies("SWR-SLF-011", Technique::kFaultInjection, Polarity::kViolation);

    for (const std::int64_t step_ns : {99999, 0}) {
        reference_.step_ns = step_ns;
        checked_.step_ns = step_ns;
        EXPECT_EQ(run_pass(), SelfTestStatus::kFailed) << "no window was over: " << step_ns;
    }
}

TEST_F(ClockCheckTest, PassOfOneStepGoesToTheAssertionHandler) {
    verifies("SWR-SLF-011", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS((ClockCheck{reference_, checked_, {Duration{1}, 1U}, 1U}), "clock_check.hpp", 1);
}

}  // namespace
}  // namespace mamori::safety

// SPDX-License-Identifier: Apache-2.0
// Goal: each kind of check tells what holds from what does not, and from what is not known yet.
// Method: scripted clocks, provisions and self tests; the real processor in the mode of floating point that
// it must not have.
#include "mamori/safety/assumptions/assumption_checks.hpp"

#include <cfenv>

#include "mamori/safety/self_test/cpu_check.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_clock.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

class TickSourceCheckTest : public ::testing::Test {
  protected:
    /// @return answer of the step that ends the first window of ten steps.
    SelfTestStatus check_window() {
        for (std::size_t i = 0U; i < 10U; ++i) {
            EXPECT_EQ(sut_.check(), SelfTestStatus::kRunning) << i;
        }
        return sut_.check();
    }

    FakeClock reference_{100000};
    FakeClock tick_{100000};
    TickSourceCheck sut_{reference_, tick_, {Duration{1000000}, 1000U}};
};

TEST_F(TickSourceCheckTest, TickAtItsRateHolds) {
    verifies("SWR-AOU-004", Technique::kBoundaryValues);
    tick_.step_ns = 99900;

    EXPECT_EQ(check_window(), SelfTestStatus::kPassed);
    EXPECT_EQ(sut_.check(), SelfTestStatus::kPassed);
}

TEST_F(TickSourceCheckTest, TickThatIsSlowOrStandsDoesNot) {
    verifies("SWR-AOU-004", Technique::kBoundaryValues, Polarity::kViolation);
    tick_.step_ns = 99899;
    EXPECT_EQ(check_window(), SelfTestStatus::kFailed);

    FakeClock frozen(0);
    TickSourceCheck other(reference_, frozen, {Duration{1000000}, 1000U});
    SelfTestStatus status = SelfTestStatus::kRunning;
    for (std::size_t i = 0U; i < 11U; ++i) {
        status = other.check();
    }
    EXPECT_EQ(status, SelfTestStatus::kFailed);
    frozen.step_ns = 100000;
    EXPECT_EQ(other.check(), SelfTestStatus::kFailed);
}

class FakeProvision final : public Provision {
  public:
    bool is_in_effect() noexcept override { return answer; }
    bool answer{false};
};

TEST(ProvisionCheckTest, ProvisionThatIsInEffectHolds) {
    verifies("SWR-AOU-005", Technique::kStateTransition);
    FakeProvision watchdog;
    ProvisionCheck sut(watchdog);
    EXPECT_EQ(sut.check(), SelfTestStatus::kRunning) << "it may be armed in the next cycle";

    watchdog.answer = true;
    EXPECT_EQ(sut.check(), SelfTestStatus::kPassed);
    EXPECT_EQ(sut.check(), SelfTestStatus::kPassed);
}

TEST(ProvisionCheckTest, ProvisionThatNeverIsOrIsNoMoreDoesNot) {
    verifies("SWR-AOU-005", Technique::kFaultInjection, Polarity::kViolation);
    FakeProvision protection;
    ProvisionCheck sut(protection);
    for (std::size_t i = 0U; i < 5U; ++i) {
        EXPECT_EQ(sut.check(), SelfTestStatus::kRunning) << "the monitor bounds the time";
    }

    protection.answer = true;
    ASSERT_EQ(sut.check(), SelfTestStatus::kPassed);
    protection.answer = false;
    EXPECT_EQ(sut.check(), SelfTestStatus::kFailed) << "somebody switched it off";
}

TEST(SelfTestCheckTest, TestThatPassesOnceHolds) {
    verifies("SWR-AOU-006");
    CpuCheck<NativeCpu> cpu;
    static_cast<void>(cpu.step());  // whatever became of a pass before
    SelfTestCheck sut(cpu);

    for (std::size_t step = 1U; step < cpu.get_step_count(); ++step) {
        ASSERT_EQ(sut.check(), SelfTestStatus::kRunning);
    }
    EXPECT_EQ(sut.check(), SelfTestStatus::kPassed);
    EXPECT_EQ(sut.check(), SelfTestStatus::kPassed) << "no step beyond the pass is done";
}

TEST(SelfTestCheckTest, ProcessorInAnotherModeDoesNot) {
    verifies("SWR-AOU-006", Technique::kFaultInjection, Polarity::kViolation);
    CpuCheck<NativeCpu> cpu;
    SelfTestCheck sut(cpu);
    SelfTestStatus status = SelfTestStatus::kRunning;
    ASSERT_EQ(std::fesetround(FE_TOWARDZERO), 0);
    for (std::size_t step = 0U; step < cpu.get_step_count(); ++step) {
        status = sut.check();
    }
    ASSERT_EQ(std::fesetround(FE_TONEAREST), 0);

    EXPECT_EQ(status, SelfTestStatus::kFailed);
    EXPECT_EQ(sut.check(), SelfTestStatus::kFailed) << "it does not heal";
}

}  // namespace
}  // namespace mamori::safety

// SPDX-License-Identifier: Apache-2.0
// Goal: one cycle for each tick, no tick lost without a count. Method: ticks before, between and during
// cycles, at the limit of the backlog, while Stopped, across the wrap of the counter, and from two threads.
#include "mamori/kernel/component/external_trigger.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/spy_component.hpp"

namespace mamori {
namespace {

using testing_support::Calls;
using testing_support::SpyComponent;
using namespace verification;

class ExternalTriggerTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ContextPlan plan{1_ms};
        plan.kind = ExecutionKind::kOther;
        plan.trigger = &trigger_;
        ASSERT_EQ(component_.initialize(), Status::kOk);
        ASSERT_EQ(context_.attach(0, participants_, plan), Status::kOk);
    }
    void start() {
        ASSERT_EQ(context_.start({}), Status::kOk);
        ASSERT_EQ(context_.activate_component(component_, {}), Status::kOk);
        calls_.clear();
    }
    /// One window. @return whether a cycle ran in it.
    bool run_window() {
        if (!context_.take_turn()) {
            return false;
        }
        EXPECT_EQ(context_.begin_cycle({}), Status::kOk);
        context_.execute(0U);
        context_.update_state(0U);
        context_.end_cycle();
        return true;
    }

    ExternalTrigger trigger_{3U};
    Calls calls_;
    SpyComponent component_{"c", calls_};
    std::array<Component*, 1> participants_{&component_};
    ExecutionContext context_;
};

TEST_F(ExternalTriggerTest, ACycleRunsForATickAndNoneWithout) {
    verifies("SWR-RTC-008");
    start();

    EXPECT_FALSE(run_window());
    trigger_.tick();
    EXPECT_TRUE(run_window());
    EXPECT_FALSE(run_window());

    EXPECT_EQ(calls_, (Calls{"c.on_execute", "c.on_state_update"}));
}

TEST_F(ExternalTriggerTest, ABurstIsWorkedOffOneCycleInEachWindow) {
    verifies("SWR-RTC-008", Technique::kBoundaryValues);
    start();
    trigger_.tick();
    trigger_.tick();
    trigger_.tick();
    EXPECT_EQ(trigger_.get_backlog(), 3U);

    EXPECT_TRUE(run_window());
    EXPECT_TRUE(run_window());
    EXPECT_TRUE(run_window());
    EXPECT_FALSE(run_window());

    EXPECT_EQ(trigger_.get_overflow_count(), 0U);
}

TEST_F(ExternalTriggerTest, ATickDuringACycleIsServedInTheNextWindow) {
    verifies("SWR-RTC-008", Technique::kErrorGuessing);
    start();
    trigger_.tick();
    component_.inside = [this](const std::string& action) {
        if (action == "on_execute") {
            trigger_.tick();
        }
    };
    EXPECT_TRUE(run_window());
    component_.inside = nullptr;

    EXPECT_TRUE(run_window());
    EXPECT_FALSE(run_window());
}

TEST_F(ExternalTriggerTest, TicksBeyondTheBacklogAreCounted) {
    verifies("SWR-RTC-008", Technique::kBoundaryValues, Polarity::kViolation);
    start();
    for (int tick = 0; tick < 5; ++tick) {
        trigger_.tick();
    }
    int cycles = 0;

    while (run_window()) {
        ++cycles;
    }

    EXPECT_EQ(cycles, 3);
    EXPECT_EQ(trigger_.get_overflow_count(), 2U);
}

TEST_F(ExternalTriggerTest, TicksWhileStoppedAreIgnoredAndCounted) {
    verifies("SWR-RTC-008", Technique::kStateTransition, Polarity::kViolation);
    trigger_.tick();
    EXPECT_FALSE(run_window());
    start();
    EXPECT_FALSE(run_window());
    ASSERT_EQ(context_.stop({}), Status::kOk);
    trigger_.tick();
    trigger_.tick();
    EXPECT_FALSE(context_.take_turn());
    ASSERT_EQ(context_.start({}), Status::kOk);

    EXPECT_FALSE(run_window());
    EXPECT_EQ(trigger_.get_ignored_count(), 3U);
    EXPECT_EQ(trigger_.get_overflow_count(), 0U);
}

TEST_F(ExternalTriggerTest, WithoutABacklogEveryTickOverflows) {
    verifies("SWR-RTC-008", Technique::kBoundaryValues, Polarity::kViolation);
    ExternalTrigger none{0U};
    none.tick();

    EXPECT_FALSE(none.take());
    EXPECT_EQ(none.get_overflow_count(), 1U);
    EXPECT_EQ(none.get_backlog(), 0U);
}

TEST_F(ExternalTriggerTest, NoTickOfTwoThreadsIsLost) {
    verifies("SWR-RTC-008", Technique::kErrorGuessing);
    constexpr int kTicks = 20000;
    ExternalTrigger trigger;
    const auto tick_all = [&trigger] {
        for (int i = 0; i < kTicks; ++i) {
            trigger.tick();
        }
    };
    std::thread first{tick_all};
    std::thread second{tick_all};
    int taken = 0;

    while (taken < kTicks) {
        taken += trigger.take() ? 1 : 0;
    }
    first.join();
    second.join();
    while (trigger.take()) {
        ++taken;
    }

    EXPECT_EQ(taken, 2 * kTicks);
}

}  // namespace
}  // namespace mamori

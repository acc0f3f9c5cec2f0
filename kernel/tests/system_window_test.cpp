// SPDX-License-Identifier: Apache-2.0
// Goal: a system window runs its function in each instance and each mode, under a budget like any window.
// Method: a fake host that cuts work off on both sides of the budget; a table with modes, switched by hand.
#include <gtest/gtest.h>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/table/system_check.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Heard = std::vector<std::string>;
using Pass = WindowHost::Pass;

struct Calls {
    std::vector<Instant> at;
    std::vector<std::int32_t> windows;
    Status answer{Status::kOk};
};
Status note(Calls& calls, ContextHandle context) noexcept {
    calls.at.push_back(context.now);
    calls.windows.push_back(context.id);
    return calls.answer;
}
int g_plain_count = 0;
Status count_plainly(ContextHandle) noexcept {
    ++g_plain_count;
    return Status::kOk;
}

/// A counter in window 0; a function every 500 ns with a budget of 50 ns in window 1.
class SystemWindowTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        ASSERT_EQ(sut_.start(), Status::kOk);
        sut_.set_observer(&observer_);
    }
    WindowOutcome run(std::size_t window, std::int64_t release) {
        host_.now = Instant{release};
        return sut_.run_window(window, Instant{release}, host_);
    }

    Calls calls_;
    Counter counter_;
    SystemFunction<&note> function_{"function", calls_};
    SystemTable<2U, 2U, 1U, 0U> table_ =
        system(frame(1000_ns), window("work", 0_ns, 400_ns, budget(300_ns), mamori::run(counter_)),
               system_window("notice", 400_ns, 100_ns, every(500_ns), budget(50_ns), function_));
    FakeHost host_;
    SpyObserver observer_;
    ExecutiveFor<decltype(table_)> sut_{table_};
};

TEST_F(SystemWindowTest, ItsFunctionIsCalledWithItsContextInEachInstance) {
    verifies("SWR-KRN-096");
    EXPECT_EQ(run(0U, 0), WindowOutcome::kCompleted);
    EXPECT_EQ(run(1U, 400), WindowOutcome::kCompleted);
    EXPECT_EQ(run(1U, 900), WindowOutcome::kCompleted);

    EXPECT_EQ(calls_.at, (std::vector<Instant>{Instant{400}, Instant{900}}));
    EXPECT_EQ(calls_.windows, (std::vector<std::int32_t>{1, 1}));
    EXPECT_EQ(counter_.value, 10);
    EXPECT_EQ(observer_.heard, Heard{});
    EXPECT_EQ(observer_.take_seen(2U),
              (std::vector<std::uint32_t>{ExecutionRecord::kWithin, ExecutionRecord::kWithin}));
}

TEST_F(SystemWindowTest, TheRowsOfTheTableNameWindowAndFunction) {
    verifies("SWR-KRN-096");
    EXPECT_FALSE(table_.windows[0].is_system);
    EXPECT_TRUE(table_.windows[1].is_system);
    EXPECT_STREQ(table_.windows[1].name, "notice");
    EXPECT_EQ(table_.windows[1].budget, 50_ns);
    EXPECT_EQ(table_.windows[1].period, 500_ns);
    EXPECT_FALSE(table_.windows[1].has_second_pass);
    EXPECT_STREQ(table_.components[1]->get_name(), "function");
    EXPECT_EQ(check(make_view(table_)).rule, Rule::kNone);
}

TEST(SystemFunctionTest, AFunctionWithoutContextRuns) {
    verifies("SWR-KRN-096");
    SystemFunction<&count_plainly> function{"plain"};
    const auto table = system(frame(1000_ns), system_window("w", 0_ns, 400_ns, budget(300_ns), function));
    ExecutiveFor sut{table};
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    FakeHost host;
    g_plain_count = 0;

    EXPECT_EQ(sut.run_window(0U, Instant{0}, host), WindowOutcome::kCompleted);
    EXPECT_EQ(g_plain_count, 1);
}

TEST_F(SystemWindowTest, AFunctionThatUsesItsWholeBudgetIsInTime) {
    verifies("SWR-KRN-097", Technique::kBoundaryValues);
    host_.durations[{1U, Pass::kExecute}] = 50_ns;

    EXPECT_EQ(run(1U, 400), WindowOutcome::kCompleted);
    EXPECT_EQ(observer_.heard, Heard{});
}

TEST_F(SystemWindowTest, OneNanosecondMoreIsAnOverrunOfTheFunction) {
    verifies("SWR-KRN-097", Technique::kBoundaryValues, Polarity::kViolation);
    host_.durations[{1U, Pass::kExecute}] = 51_ns;

    EXPECT_EQ(run(1U, 400), WindowOutcome::kOverrun);
    EXPECT_EQ(observer_.heard, (Heard{"overrun window 1 component 1 @450"}));
    EXPECT_EQ(observer_.take_seen(2U), (std::vector<std::uint32_t>{0U, 0U}));
}

TEST_F(SystemWindowTest, AFunctionThatHangsIsNamedInEachInstanceAndTheOtherWindowRuns) {
    verifies("SWR-KRN-097", Technique::kFaultInjection, Polarity::kViolation);
    host_.hangs[{1U, Pass::kExecute}] = true;
    host_.is_work_out = true;

    EXPECT_EQ(run(1U, 400), WindowOutcome::kOverrun);
    EXPECT_EQ(run(1U, 900), WindowOutcome::kOverrun);
    EXPECT_EQ(run(0U, 1000), WindowOutcome::kCompleted);

    EXPECT_EQ(observer_.heard,
              (Heard{"overrun window 1 component 1 @450", "overrun window 1 component 1 @900"}));
    EXPECT_EQ(calls_.at, std::vector<Instant>{});
}

TEST_F(SystemWindowTest, AFunctionThatFailsIsCalledNoMoreUntilItIsReset) {
    verifies("SWR-KRN-097", Technique::kFaultInjection, Polarity::kViolation);
    calls_.answer = Status::kError;
    EXPECT_EQ(run(1U, 400), WindowOutcome::kCompleted);
    EXPECT_EQ(run(1U, 900), WindowOutcome::kCompleted);
    EXPECT_EQ(calls_.at.size(), 1U);
    EXPECT_EQ(function_.get_last_failure().status, Status::kError);

    calls_.answer = Status::kOk;
    ASSERT_EQ(sut_.get_context(1U).reset_component(function_, Instant{950}), Status::kOk);
    ASSERT_EQ(sut_.get_context(1U).activate_component(function_, Instant{950}), Status::kOk);
    EXPECT_EQ(run(1U, 1400), WindowOutcome::kCompleted);
    EXPECT_EQ(calls_.at.size(), 2U);
}

enum class Event { kGo, kBack };

TEST(SystemWindowModeTest, ItsFunctionRunsInEachModeAndThroughEachSwitch) {
    verifies("SWR-KRN-098", Technique::kStateTransition);
    Calls calls;
    Counter always{"always"};
    Counter worker{"worker"};
    SystemFunction<&note> function{"function", calls};
    const auto table = system(
        frame(1000_ns), window("work", 0_ns, 400_ns, budget(300_ns), run(always, worker)),
        system_window("notice", 400_ns, 100_ns, budget(50_ns), function), system_mode("idle", runs(always)),
        system_mode("work", runs(always, worker)), safe_mode("halt", runs(always)),
        mode_transition("idle", Event::kGo, "work"), mode_transition("work", Event::kBack, "idle"));
    ASSERT_EQ(check(make_view(table)).rule, Rule::kNone);
    SystemModes modes{make_view(table)};
    ExecutiveFor sut{table, modes};
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    FakeHost host;
    std::int64_t frames = 0;
    const auto run_frames = [&](int count) {
        for (int i = 0; i < count; ++i) {
            for (const std::size_t window : {0U, 1U}) {
                const Instant release{frames * 1000 + table.windows[window].offset.ns};
                host.now = release;
                ASSERT_EQ(sut.run_window(window, release, host), WindowOutcome::kCompleted);
            }
            ++frames;
        }
    };

    run_frames(2);
    EXPECT_EQ(worker.value, 0);
    ASSERT_EQ(modes.request(Event::kGo), Status::kOk);
    run_frames(8);
    EXPECT_EQ(modes.get_mode(), 1U);
    EXPECT_GT(worker.value, 0);
    ASSERT_EQ(modes.request_safe_mode(), Status::kOk);
    run_frames(8);
    EXPECT_EQ(modes.get_mode(), 2U);
    EXPECT_EQ(calls.at.size(), static_cast<std::size_t>(frames)) << "once per frame";
}

}  // namespace
}  // namespace mamori

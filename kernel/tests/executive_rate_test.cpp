// SPDX-License-Identifier: Apache-2.0
// Goal: windows run as often as their periods and chosen rates say, from the boundary of a frame on.
// Method: a schedule walked by hand; the cycles of each window are counted.
#include <gtest/gtest.h>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/frame_schedule.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"

namespace mamori {
namespace {

using testing_support::FakeHost;
using testing_support::SpyObserver;
using namespace verification;

class Beat final : public Component {
  public:
    explicit Beat(const char* name) : Component(name) {}
    std::vector<std::int64_t> cycles;
    int rate_changes{0};
    Status rate_answer{Status::kOk};
    Status on_execute(ContextHandle context) noexcept override {
        cycles.push_back(context.now.ns);
        return Status::kOk;
    }
    Status on_rate_changed(ContextHandle) noexcept override {
        ++rate_changes;
        return rate_answer;
    }
};

class ExecutiveRateTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        ASSERT_EQ(sut_.start(), Status::kOk);
    }
    void run_until(std::int64_t end) {
        for (; schedule_.get_next().release < Instant{end}; schedule_.advance()) {
            host_.now = schedule_.get_next().release;
            static_cast<void>(sut_.run_window(schedule_.get_next().window, host_));
        }
    }
    using Times = std::vector<std::int64_t>;

    Beat fast_{"fast"};
    Beat slow_{"slow"};
    SystemTable<2U, 2U, 0U, 0U> table_ = system(
        frame(40_ns),
        window("fast", 0_ns, 5_ns, every(10_ns), rate(Rate{1.0e8}, Rate{5.0e7}), budget(5_ns), run(fast_)),
        window("slow", 5_ns, 5_ns, every(20_ns), budget(5_ns), run(slow_)));
    FakeHost host_;
    ExecutiveFor<decltype(table_)> sut_{table_};
    FrameSchedule schedule_{sut_.get_view(), 0U, Instant{0}};
};

TEST_F(ExecutiveRateTest, EachWindowRunsAtItsOwnPeriod) {
    verifies("SWR-KRN-027");
    run_until(40);

    EXPECT_EQ(fast_.cycles, (Times{0, 10, 20, 30}));
    EXPECT_EQ(slow_.cycles, (Times{5, 25}));
}

TEST_F(ExecutiveRateTest, AChosenRateComesWithTheNextFrame) {
    verifies("SWR-RTC-003", Technique::kBoundaryValues);
    run_until(11);
    ASSERT_EQ(sut_.get_context(0U).set_rate(5.0e7), Status::kOk);
    run_until(80);

    EXPECT_EQ(fast_.cycles, (Times{0, 10, 20, 30, 40, 60}));
    EXPECT_EQ(fast_.rate_changes, 1);
    EXPECT_EQ(slow_.cycles, (Times{5, 25, 45, 65}));
    EXPECT_EQ(slow_.rate_changes, 0);
}

TEST_F(ExecutiveRateTest, ATurnWithANewRateIsARunOfWhoeverWasActiveWhenItBegan) {
    verifies("SWR-KRN-030", Technique::kStateTransition);
    SpyObserver observer;
    sut_.set_observer(&observer);
    const auto take_turn_at_new_rate = [this, &observer](double rate_hz, std::int64_t boundary) {
        EXPECT_EQ(sut_.get_context(0U).set_rate(rate_hz), Status::kOk);
        run_until(boundary);
        static_cast<void>(observer.take_seen(1U));
        run_until(boundary + 1);
        return observer.take_seen(1U)[0];
    };

    EXPECT_EQ(take_turn_at_new_rate(5.0e7, 40), ExecutionRecord::kWithin);
    ASSERT_EQ(sut_.get_context(0U).deactivate_component(fast_, host_.now), Status::kOk);
    EXPECT_EQ(take_turn_at_new_rate(1.0e8, 80), 0U);
    ASSERT_EQ(sut_.get_context(0U).activate_component(fast_, host_.now), Status::kOk);
    fast_.rate_answer = Status::kError;
    EXPECT_EQ(take_turn_at_new_rate(5.0e7, 120), ExecutionRecord::kWithin) << "as after a failed on_execute";
    EXPECT_EQ(take_turn_at_new_rate(1.0e8, 160), 0U) << "in Error";
    EXPECT_EQ(fast_.rate_changes, 4);
}

TEST_F(ExecutiveRateTest, ARateThatTheTableDoesNotDeclareChangesNothing) {
    verifies("SWR-RTC-003", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_EQ(sut_.get_context(0U).set_rate(2.5e7), Status::kUnsupported);
    EXPECT_EQ(sut_.get_context(1U).set_rate(1.0e7), Status::kUnsupported);
    run_until(80);

    EXPECT_EQ(fast_.cycles.size(), 8U);
    EXPECT_EQ(slow_.cycles.size(), 4U);
}

}  // namespace
}  // namespace mamori

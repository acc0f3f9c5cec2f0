// SPDX-License-Identifier: Apache-2.0
// Goal: work that was cut off and has not come back harms nobody: its window stays closed and names it, what
// it writes late is thrown away, and a step of it that begins late does nothing. Method: a host that abandons
// work on a thread of its own, as a port with a guard does; one that lets work begin after it was cut off.
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <optional>
#include <thread>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Heard = std::vector<std::string>;
using Pass = WindowHost::Pass;

/// Waits for its release once when told to, and writes then.
class HangingComponent final : public Component {
  public:
    explicit HangingComponent() noexcept : Component("hanging") {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&HangingComponent::out>;

    std::promise<void> entered;
    std::promise<void> released;
    std::atomic<bool> is_to_hang{false};

    Status on_execute(ContextHandle) noexcept override {
        if (is_to_hang.exchange(false)) {
            entered.set_value();
            released.get_future().wait();
            out.write(666);
        }
        return Status::kOk;
    }
};

/// Runs the work of component 0 on a thread and abandons it when it hangs, as a port's guard does.
class AbandoningHost final : public WindowHost {
  public:
    explicit AbandoningHost(HangingComponent& component) : component_(component) {}
    ~AbandoningHost() {
        if (thread_.joinable()) {
            thread_.join();
        }
    }
    Instant now{};

    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return now; }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        const auto run_all = [work] { work.run(work.argument, work.first, work.first + work.count); };
        if (work.component != 0U || !component_.is_to_hang) {
            run_all();
            return work.count;
        }
        is_out_ = true;
        thread_ = std::thread(run_all);
        component_.entered.get_future().wait();
        now = deadline;
        return 0U;
    }
    void let_it_return() {
        component_.released.set_value();
        thread_.join();
        is_out_ = false;
    }
    bool has_returned(std::size_t) const noexcept override { return !is_out_; }

  private:
    HangingComponent& component_;
    std::thread thread_;
    bool is_out_{false};
};

TEST(ExecutiveAbandonedWorkTest, WorkThatHangsIsNamedEachFrameAndNeverPublishesWhatItWroteLate) {
    verifies("SWR-KRN-022", Technique::kFaultInjection, Polarity::kViolation);
    HangingComponent hanging;
    Counter other;
    const auto table = system(frame(1000_ns), window("first", 0_ns, 400_ns, budget(300_ns), run(hanging)),
                              window("second", 400_ns, 600_ns, budget(500_ns), run(other)));
    ExecutiveFor sut{table};
    SpyObserver observer;
    AbandoningHost host{hanging};
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    sut.set_observer(&observer);

    hanging.is_to_hang = true;
    EXPECT_EQ(sut.run_window(0U, Instant{0}, host), WindowOutcome::kOverrun);
    host.now = Instant{400};
    EXPECT_EQ(sut.run_window(1U, Instant{400}, host), WindowOutcome::kCompleted);
    host.now = Instant{1000};
    EXPECT_EQ(sut.run_window(0U, Instant{1000}, host), WindowOutcome::kOverrun);
    EXPECT_EQ(sut.get_context(0U).deactivate_component(hanging, host.now), Status::kPreconditionNotMet);

    host.let_it_return();
    EXPECT_EQ(observer.take_seen(2U), (std::vector<std::uint32_t>{0U, ExecutionRecord::kWithin}));
    ASSERT_TRUE(hanging.out.is_staged());
    host.now = Instant{2000};
    EXPECT_EQ(sut.run_window(0U, Instant{2000}, host), WindowOutcome::kCompleted);

    EXPECT_EQ(hanging.out.get_sequence(), 0U);
    hanging.out.write(7);  // as an activation would
    EXPECT_EQ(sut.run_window(0U, Instant{2000}, host), WindowOutcome::kCompleted);
    EXPECT_EQ(hanging.out.get_published(), 7) << "only what was written late is thrown away";
    EXPECT_EQ(observer.heard,
              (Heard{"overrun window 0 component 0 @300", "overrun window 0 component 0 @1000"}));
    EXPECT_EQ(other.out.get_sequence(), 1U);
}

/// Writes in both passes and when it is deactivated.
class TwoPasses final : public Component {
  public:
    explicit TwoPasses(const char* name = "two passes") noexcept : Component(name) {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&TwoPasses::out>;
    int executed{0};
    int updated{0};
    int deactivated{0};

    Status on_deactivated(ContextHandle) noexcept override {
        ++deactivated;
        out.write(666);
        return Status::kOk;
    }
    Status on_execute(ContextHandle) noexcept override {
        out.write(++executed);
        return Status::kOk;
    }
    Status on_state_update(ContextHandle) noexcept override {
        out.write(100 + ++updated);
        return Status::kOk;
    }
};

/// Cuts off one pass of window 0 before its thread has begun it; the test lets that begin later.
class DelayingHost final : public WindowHost {
  public:
    Instant now{};
    std::optional<Pass> to_cut;
    std::optional<Work> late;

    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return now; }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        if (work.window == 0U && to_cut == work.pass) {
            late = work;
            to_cut.reset();
            now = deadline;
            return 0U;
        }
        work.run(work.argument, work.first, work.first + work.count);
        return work.count;
    }
    bool has_returned(std::size_t window) const noexcept override {
        ++question_count;
        return window != 0U || !late.has_value();
    }
    mutable int question_count{0};
    void run_late() const noexcept { late->run(late->argument, late->first, late->first + late->count); }
};

class ExecutiveLateEntryTest : public ::testing::TestWithParam<Pass> {
  protected:
    void SetUp() override {
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        ASSERT_EQ(sut_.start(), Status::kOk);
        sut_.set_observer(&observer_);
    }
    WindowOutcome open(std::size_t window, std::int64_t at) {
        host_.now = Instant{at};
        return sut_.run_window(window, Instant{at}, host_);
    }

    TwoPasses component_;
    Counter other_;
    SystemTable<2U, 2U, 2U, 0U> table_ =
        system(frame(1000_ns), window("first", 0_ns, 400_ns, budget(300_ns), run(component_)),
               window("second", 400_ns, 600_ns, budget(500_ns), run(other_)));
    DelayingHost host_;
    SpyObserver observer_;
    ExecutiveFor<decltype(table_)> sut_{table_};
};

TEST_P(ExecutiveLateEntryTest, AStepThatBeginsAfterItWasCutOffDoesNothingWheneverThatIs) {
    verifies("SWR-KRN-032", Technique::kFaultInjection, Polarity::kViolation);
    host_.to_cut = GetParam();
    ASSERT_EQ(open(0U, 0), WindowOutcome::kOverrun);
    const int executed = component_.executed;

    host_.run_late();  // between two windows
    EXPECT_EQ(open(1U, 400), WindowOutcome::kCompleted);
    EXPECT_EQ(open(0U, 1000), WindowOutcome::kOverrun);
    host_.run_late();  // in a later frame
    EXPECT_EQ(component_.executed, executed);
    EXPECT_EQ(component_.updated, 0);

    host_.late.reset();
    EXPECT_EQ(open(0U, 2000), WindowOutcome::kCompleted);
    EXPECT_EQ(component_.updated, 1);
    EXPECT_EQ(component_.out.get_sequence(), 1U) << "only the cycle that came through is published";
    EXPECT_EQ(component_.out.get_published(), 101);
    EXPECT_EQ(observer_.heard,
              (Heard{"overrun window 0 component 0 @300", "overrun window 0 component 0 @1000"}));
}

TEST_P(ExecutiveLateEntryTest, StopIsRefusedWhileWorkIsOutAndNeedsNoOpeningAfterwards) {
    verifies("SWR-KRN-032", Technique::kErrorGuessing, Polarity::kViolation);
    host_.to_cut = GetParam();
    ASSERT_EQ(open(0U, 0), WindowOutcome::kOverrun);
    const ExecutionContext& context = sut_.get_context(0U);

    EXPECT_TRUE(context.is_busy());
    EXPECT_EQ(context.get_acting_position().get_value(), 0U);
    EXPECT_EQ(sut_.get_context(0U).deactivate_component(component_, host_.now), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.get_context(0U).begin_cycle(host_.now), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.stop(), Status::kPreconditionNotMet);
    EXPECT_TRUE(context.is_running());
    EXPECT_FALSE(sut_.get_context(1U).is_running()) << "what can be stopped is";

    host_.late.reset();
    EXPECT_EQ(sut_.stop(), Status::kOk);
    EXPECT_FALSE(context.is_busy());
    EXPECT_FALSE(context.is_running());
    EXPECT_FALSE(context.get_acting_position().has_value());
}

TEST_P(ExecutiveLateEntryTest, AHostWhoseWorkHasComeBackIsNotAskedAgain) {
    verifies("SWR-KRN-032", Technique::kErrorGuessing);
    host_.to_cut = GetParam();
    ASSERT_EQ(open(0U, 0), WindowOutcome::kOverrun);
    host_.late.reset();
    ASSERT_EQ(open(0U, 1000), WindowOutcome::kCompleted);
    const int question_count = host_.question_count;

    EXPECT_EQ(sut_.stop(), Status::kOk);
    EXPECT_EQ(host_.question_count, question_count) << "it may have ended";
}

TEST_P(ExecutiveLateEntryTest, AWindowThatCouldNotBeStoppedRunsNoCycleAnyMore) {
    verifies("SWR-KRN-033", Technique::kFaultInjection, Polarity::kViolation);
    host_.to_cut = GetParam();
    ASSERT_EQ(open(0U, 0), WindowOutcome::kOverrun);
    ASSERT_EQ(sut_.stop(), Status::kPreconditionNotMet);
    const int executed = component_.executed;

    EXPECT_EQ(open(0U, 1000), WindowOutcome::kOverrun);
    EXPECT_EQ(sut_.start(), Status::kPreconditionNotMet) << "not yet stopped";
    host_.late.reset();
    EXPECT_EQ(open(0U, 2000), WindowOutcome::kStopped);
    EXPECT_EQ(component_.deactivated, 1);
    EXPECT_FALSE(component_.out.is_staged()) << "what it wrote while it stopped is discarded";
    EXPECT_FALSE(sut_.get_context(0U).is_running());
    EXPECT_EQ(open(0U, 3000), WindowOutcome::kStopped);
    EXPECT_EQ(component_.executed, executed);
    EXPECT_EQ(component_.out.get_sequence(), 0U);

    EXPECT_EQ(sut_.start(), Status::kOk);
    EXPECT_EQ(open(0U, 4000), WindowOutcome::kCompleted);
}

TEST_P(ExecutiveLateEntryTest, AStopThatComesLateHasTheBudgetOfItsWindow) {
    verifies("SWR-KRN-033", Technique::kFaultInjection, Polarity::kViolation);
    host_.to_cut = GetParam();
    ASSERT_EQ(open(0U, 0), WindowOutcome::kOverrun);
    ASSERT_EQ(sut_.stop(), Status::kPreconditionNotMet);
    host_.late.reset();
    host_.to_cut = Pass::kModeStep;

    EXPECT_EQ(open(0U, 1000), WindowOutcome::kOverrun);
    EXPECT_EQ(host_.now, Instant{1300}) << "cut off at the end of the budget";
    host_.late.reset();
    EXPECT_EQ(open(0U, 2000), WindowOutcome::kStopped);
    EXPECT_EQ(component_.deactivated, 1);
    EXPECT_EQ(observer_.heard,
              (Heard{"overrun window 0 component 0 @300", "overrun window 0 component 0 @1300"}));
}

/// Two components whose stop takes longer than the budget, on a clock that the test sets.
TEST(ExecutiveLateStopTest, AStopThatTakesTooLongGoesOnInTheNextOpening) {
    verifies("SWR-KRN-033", Technique::kFaultInjection, Polarity::kViolation);
    TwoPasses first{"first"};
    TwoPasses second{"second"};
    const auto table = system(frame(1000_ns), window("w", 0_ns, 400_ns, budget(300_ns), run(first, second)));
    ExecutiveFor sut{table};
    FakeHost host;
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    host.hangs[{0U, Pass::kExecute}] = true;
    host.is_work_out = true;
    ASSERT_EQ(sut.run_window(0U, Instant{0}, host), WindowOutcome::kOverrun);
    ASSERT_EQ(sut.stop(), Status::kPreconditionNotMet);
    host.hangs.clear();
    host.is_work_out = false;
    host.durations[{0U, Pass::kModeStep}] = 301_ns;

    host.now = Instant{1000};
    EXPECT_EQ(sut.run_window(0U, Instant{1000}, host), WindowOutcome::kOverrun);
    EXPECT_EQ(first.deactivated, 1);
    EXPECT_EQ(second.deactivated, 0) << "its turn did not come";
    EXPECT_FALSE(sut.get_context(0U).is_busy());
    EXPECT_TRUE(sut.get_context(0U).is_running());
    host.durations.clear();
    host.now = Instant{2000};
    EXPECT_EQ(sut.run_window(0U, Instant{2000}, host), WindowOutcome::kStopped);
    EXPECT_EQ(first.deactivated, 1) << "not twice";
    EXPECT_EQ(second.deactivated, 1);
    EXPECT_EQ(first.executed + second.executed, 0);
}

TEST(ExecutiveLateStopTest, AStopThatHangsIsNamedAndKeepsItsWindowClosed) {
    verifies("SWR-KRN-033", Technique::kFaultInjection, Polarity::kViolation);
    Counter other;
    TwoPasses first{"first"};
    TwoPasses second{"second"};
    const auto table = system(frame(1000_ns), window("v", 0_ns, 400_ns, budget(300_ns), run(other)),
                              window("w", 400_ns, 400_ns, budget(300_ns), run(first, second)));
    ExecutiveFor sut{table};
    SpyObserver observer;
    FakeHost host;
    FakeHost stopping_host;
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    sut.set_observer(&observer);
    const auto open = [&sut](FakeHost& by, std::int64_t at) {
        by.now = Instant{at};
        return sut.run_window(1U, Instant{at}, by);
    };
    host.hangs[{1U, Pass::kExecute}] = true;
    host.is_work_out = true;
    ASSERT_EQ(open(host, 400), WindowOutcome::kOverrun);
    ASSERT_EQ(sut.stop(), Status::kPreconditionNotMet);
    host.is_work_out = false;
    stopping_host.hangs[{2U, Pass::kModeStep}] = true;
    stopping_host.is_work_out = true;

    EXPECT_EQ(open(stopping_host, 1400), WindowOutcome::kOverrun);
    EXPECT_EQ(open(stopping_host, 2400), WindowOutcome::kOverrun);
    EXPECT_EQ(stopping_host.deadlines.size(), 1U) << "it waits for the work that is out";
    EXPECT_EQ(observer.heard,
              (Heard{"overrun window 1 component 1 @700", "overrun window 1 component 2 @1700",
                     "overrun window 1 component 2 @2400"}));
    EXPECT_TRUE(sut.get_context(1U).is_running());

    stopping_host.hangs.clear();
    stopping_host.is_work_out = false;
    EXPECT_EQ(open(stopping_host, 3400), WindowOutcome::kStopped);
    EXPECT_EQ(first.deactivated, 1);
    EXPECT_EQ(second.deactivated, 1);
}

TEST(ExecutiveLateStopTest, AHostThatRunsAllStepsInOneCallStopsEachComponent) {
    verifies("SWR-KRN-033", Technique::kInterface);
    TwoPasses first{"first"};
    TwoPasses second{"second"};
    const auto table = system(frame(1000_ns), window("w", 0_ns, 400_ns, budget(300_ns), run(first, second)));
    ExecutiveFor sut{table};
    DelayingHost host;
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    host.to_cut = Pass::kExecute;
    ASSERT_EQ(sut.run_window(0U, Instant{0}, host), WindowOutcome::kOverrun);
    ASSERT_EQ(sut.stop(), Status::kPreconditionNotMet);
    host.late.reset();
    host.now = Instant{1000};

    EXPECT_EQ(sut.run_window(0U, Instant{1000}, host), WindowOutcome::kStopped);
    EXPECT_EQ(first.deactivated, 1);
    EXPECT_EQ(second.deactivated, 1);
}

INSTANTIATE_TEST_SUITE_P(BothPasses, ExecutiveLateEntryTest,
                         ::testing::Values(Pass::kExecute, Pass::kStateUpdate), [](const auto& pass) {
                             return pass.param == Pass::kExecute ? std::string{"Execute"}
                                                                 : std::string{"Update"};
                         });

}  // namespace
}  // namespace mamori

// SPDX-License-Identifier: Apache-2.0
// Goal: every step of every component is recorded with its instants; the windows are not affected. Method: a
// real executive in virtual time, with steps of modelled duration, and a log that is too small.
#include "mamori/timing/measuring_host.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <thread>

#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::timing {
namespace {

using namespace verification;
using Opening = FrameSchedule::Opening;
using literals::operator""_ms;

/// A clock that advances by 10 ns at each reading.
class TickingHost final : public WindowHost {
  public:
    Instant get_now() const noexcept override {
        now_ = now_ + Duration{10};
        return now_;
    }
    Instant get_step_end() const noexcept override { return now_; }
    std::size_t run_within(const Work& work, Instant) noexcept override {
        work.run(work.argument, work.first, work.first + work.count);
        return work.count - cut_off_count;
    }
    bool has_returned(std::size_t window) const noexcept override { return window != hanging_window; }
    void wait_until(Instant instant) noexcept { now_ = instant; }

    std::size_t cut_off_count{0U};
    std::size_t hanging_window{kNoIndex};

  private:
    mutable Instant now_{};
};

class Worker final : public Component {
  public:
    explicit Worker(const char* name) noexcept : Component(name) {}
    Status on_execute(ContextHandle) noexcept override {
        ++run_count;
        for (int i = 0; i < sleep_count; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds{1});
        }
        return Status::kOk;
    }
    Status on_state_update(ContextHandle) noexcept override { return Status::kOk; }
    int run_count{0};
    int sleep_count{0};
};

class Devices final : public ports::posix_rt::OpeningObserver {
  public:
    void before_opening(const Opening& opening, Instant) noexcept override { before = opening.window; }
    void after_opening(const Opening& opening, WindowOutcome) noexcept override { after = opening.window; }
    std::size_t before{kNoIndex};
    std::size_t after{kNoIndex};
};

class MeasuringHostTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(executive_.initialize(), Status::kOk);
        ASSERT_EQ(executive_.start(), Status::kOk);
    }
    WindowOutcome open(MeasuringHost& host, std::size_t window, Instant release) {
        inner_.wait_until(release);
        host.before_opening({window, release}, release + Duration{7});
        const WindowOutcome outcome = executive_.run_window(window, release, host);
        host.after_opening({window, release}, outcome);
        return outcome;
    }

    Worker first_{"first"};
    Worker second_{"second"};
    SystemTable<1U, 2U, 0U, 0U> table_ =
        system(frame(10_ms), window("work", 0_ms, 5_ms, budget(5_ms), run(first_, second_)));
    ExecutiveFor<decltype(table_)> executive_{table_};
    TickingHost inner_;
    Devices devices_;
};

TEST_F(MeasuringHostTest, EachStepIsNotedWithItsComponentPassAndInstants) {
    verifies("SWR-TIM-001");
    RunLog log{4U, 16U};
    MeasuringHost sut{inner_, log, 1U, &devices_};

    EXPECT_EQ(open(sut, 0U, Instant{0}), WindowOutcome::kCompleted);

    ASSERT_EQ(log.get_openings().size(), 1U);
    const OpeningRow& opening = log.get_openings()[0];
    EXPECT_EQ(opening.release, Instant{0});
    EXPECT_EQ(opening.woke, Instant{10}) << "the clock is read again after the devices";
    EXPECT_EQ(opening.outcome, WindowOutcome::kCompleted);
    ASSERT_EQ(log.get_steps().size(), 4U) << "two components, two passes";
    std::int64_t before = 0;
    for (std::size_t i = 0U; i < 4U; ++i) {
        const StepRow& row = log.get_steps()[i];
        EXPECT_EQ(row.component, i % 2U);
        EXPECT_EQ(row.pass, i < 2U ? WindowHost::Pass::kExecute : WindowHost::Pass::kStateUpdate);
        EXPECT_GT(row.start_ns.load(), before);
        EXPECT_GT(row.end_ns.load(), row.start_ns.load());
        before = row.end_ns.load();
    }
    EXPECT_GT(opening.closed.ns, before);
    EXPECT_EQ(devices_.before, 0U);
    EXPECT_EQ(devices_.after, 0U);
}

TEST_F(MeasuringHostTest, EachStepHasTheCpuTimeAndSwitchesOfItsThread) {
    verifies("SWR-TIM-042");
    RunLog log{4U, 16U};
    MeasuringHost sut{inner_, log, 1U, nullptr};
    first_.sleep_count = 2;
    EXPECT_EQ(sut.get_thread(0U), 0U);

    EXPECT_EQ(open(sut, 0U, Instant{0}), WindowOutcome::kCompleted);

    EXPECT_EQ(sut.get_thread(0U), static_cast<std::uint32_t>(gettid()));
    for (const StepRow& row : log.get_steps()) {
        EXPECT_GT(row.cpu_ns, 0);
    }
    EXPECT_GE(log.get_steps()[0].voluntary, 2U) << "the step waited twice";
    EXPECT_EQ(log.get_steps()[1].voluntary, 0U);
}

TEST_F(MeasuringHostTest, TimeOfTheReadingOfTheSwitchesIsNotThatOfTheRunner) {
    verifies("SWR-TIM-042");
    RunLog log{4U, 16U};
    SwitchLog switches{8U};
    MeasuringHost sut{inner_, log, 1U, nullptr, &switches};

    EXPECT_EQ(open(sut, 0U, Instant{0}), WindowOutcome::kCompleted);
    EXPECT_EQ(open(sut, 0U, Instant{10'000'000}), WindowOutcome::kCompleted);

    const Span<const OpeningRow> rows = log.get_openings();
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].runner_cpu_ns, kNoInstant.ns) << "no reading before it";
    EXPECT_GT(rows[1].runner_cpu_ns, 0);
    for (const OpeningRow& row : rows) {
        EXPECT_EQ(row.reading, Duration{10}) << "one reading of the clock later";
        EXPECT_GT(row.reading_cpu_ns, 0);
    }
}

TEST_F(MeasuringHostTest, WindowWithOutstandingWorkHasNoState) {
    verifies("SWR-TIM-046", Technique::kFaultInjection, Polarity::kViolation);
    RunLog log{4U, 16U};
    MeasuringHost sut{inner_, log, 1U, nullptr};
    const std::function<std::size_t()> get_state = [] { return std::size_t{3U}; };
    sut.set_state_source(get_state);

    EXPECT_EQ(open(sut, 0U, Instant{0}), WindowOutcome::kCompleted);
    inner_.hanging_window = 0U;
    EXPECT_EQ(open(sut, 0U, Instant{10'000'000}), WindowOutcome::kCompleted);
    inner_.hanging_window = kNoIndex;
    EXPECT_EQ(open(sut, 0U, Instant{20'000'000}), WindowOutcome::kCompleted);

    ASSERT_EQ(log.get_openings().size(), 3U);
    EXPECT_EQ(log.get_openings()[0].state, 3U);
    EXPECT_EQ(log.get_openings()[1].state, kNoState) << "the state of the window before may have changed";
    EXPECT_EQ(log.get_openings()[2].state, 3U);
}

TEST_F(MeasuringHostTest, WhatTheInnerHostSaysGoesThrough) {
    verifies("SWR-TIM-001", Technique::kInterface);
    RunLog log{4U, 16U};
    MeasuringHost sut{inner_, log, 1U, nullptr};

    inner_.cut_off_count = 1U;
    inner_.hanging_window = 0U;
    EXPECT_EQ(open(sut, 0U, Instant{0}), WindowOutcome::kOverrun);

    EXPECT_FALSE(sut.has_returned(0U));
    EXPECT_EQ(log.get_openings()[0].outcome, WindowOutcome::kOverrun);
    EXPECT_EQ(log.get_openings()[0].woke, Instant{7}) << "without devices as the runner says";
    EXPECT_GE(sut.get_step_end(), Instant{10});
}

TEST_F(MeasuringHostTest, RowsBeyondTheRoomAreCountedAndTheWorkIsDoneAllTheSame) {
    verifies("SWR-TIM-001", Technique::kBoundaryValues, Polarity::kViolation);
    RunLog log{1U, 4U};
    MeasuringHost sut{inner_, log, 1U, nullptr};

    EXPECT_EQ(open(sut, 0U, Instant{0}), WindowOutcome::kCompleted);
    EXPECT_EQ(log.get_lost_count(), 0U) << "just enough for one opening";
    EXPECT_EQ(open(sut, 0U, Instant{10'000'000}), WindowOutcome::kCompleted);

    EXPECT_EQ(log.get_lost_count(), 5U) << "four steps and an opening";
    EXPECT_EQ(log.get_openings().size(), 1U);
    EXPECT_EQ(first_.run_count, 2);
    EXPECT_EQ(second_.run_count, 2);
}

}  // namespace
}  // namespace mamori::timing

// SPDX-License-Identifier: Apache-2.0
// Goal: each step of a selected cycle is a separate call with a row; the windows are not affected. Method: a
// real executive in virtual time, with steps that check that they are called alone, and a log that is too
// small.
#include "mamori/timing/counting_host.hpp"

#include <gtest/gtest.h>

#include <array>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::timing {
namespace {

using ports::posix_rt::FrameClock;
using ports::virtual_time::FrameRunner;
using ports::virtual_time::IndexedVirtualHost;
using ports::virtual_time::kNever;
using ports::virtual_time::SimulatedCore;
using namespace verification;
using literals::operator""_ms;
using literals::operator""_us;

class Worker final : public Component {
  public:
    explicit Worker(const char* name) noexcept : Component(name) {}
    Status on_execute(ContextHandle) noexcept override {
        ++run_count;
        return Status::kOk;
    }
    Status on_state_update(ContextHandle) noexcept override { return Status::kOk; }
    int run_count{0};
};

/// Two windows: one starts twice in a major frame, the other one has two components.
class CountingHostTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(executive_.initialize(), Status::kOk);
        ASSERT_EQ(executive_.start(), Status::kOk);
    }
    void run_frames(CountingHost& sut, std::uint64_t count) {
        SimulatedCore core{executive_, clock_, sut};
        FrameRunner runner{{&core, 1U}, devices_};
        for (std::uint64_t i = 0U; i < count; ++i) {
            runner.run_frame();
        }
        overrun_count_ = runner.get_overrun_count();
    }

    Worker fast_{"fast"};
    Worker first_{"first"};
    Worker second_{"second"};
    SystemTable<2U, 3U, 0U, 0U> table_ =
        system(frame(10_ms), window("fast", 1_ms, 1_ms, every(5_ms), budget(500_us), run(fast_)),
               window("slow", 2_ms, 3_ms, budget(2_ms), run(first_, second_)));
    ExecutiveFor<decltype(table_)> executive_{table_};
    std::array<Duration, 3U> times_{100_us, 200_us, 300_us};
    IndexedVirtualHost clock_{times_};
    NoDevices devices_;
    FrameClock wall_ = FrameClock::starting_in(Duration{0});
    std::uint64_t overrun_count_{0U};
};

struct Expected {
    std::int64_t release_us;
    std::size_t component;
    WindowHost::Pass pass;
};

TEST_F(CountingHostTest, EachStepHasARowWithItsPlannedWindowStartInCallOrder) {
    verifies("SWR-TIM-030");
    RunLog log{0U, 64U};
    CountingHost sut{clock_, log, executive_.get_view(), {}, wall_, false};

    run_frames(sut, 1U);

    using Pass = WindowHost::Pass;
    constexpr std::array<Expected, 8U> kExpected{{{1000, 0U, Pass::kExecute},
                                                  {1000, 0U, Pass::kStateUpdate},
                                                  {2000, 1U, Pass::kExecute},
                                                  {2000, 2U, Pass::kExecute},
                                                  {2000, 1U, Pass::kStateUpdate},
                                                  {2000, 2U, Pass::kStateUpdate},
                                                  {6000, 0U, Pass::kExecute},
                                                  {6000, 0U, Pass::kStateUpdate}}};
    const Span<const StepRow> rows = log.get_steps();
    ASSERT_EQ(rows.size(), kExpected.size());
    for (std::size_t i = 0U; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i].release.ns, kExpected[i].release_us * 1000) << i;
        EXPECT_EQ(rows[i].component, kExpected[i].component) << i;
        EXPECT_EQ(rows[i].pass, kExpected[i].pass) << i;
        EXPECT_GE(rows[i].end_ns.load(), rows[i].start_ns.load()) << i;
        EXPECT_NE(rows[i].start_ns.load(), kNoInstant.ns) << i;
    }
    EXPECT_EQ(overrun_count_, 0U);
}

TEST_F(CountingHostTest, UnselectedCyclesRunWithoutRows) {
    verifies("SWR-TIM-030", Technique::kBoundaryValues, Polarity::kViolation);
    RunLog log{0U, 64U};
    CountingHost sut{clock_, log, executive_.get_view(), {1U, 2U}, wall_, false};

    run_frames(sut, 5U);

    EXPECT_EQ(fast_.run_count, 10);
    const Span<const StepRow> rows = log.get_steps();
    ASSERT_EQ(rows.size(), 16U);
    EXPECT_EQ(rows[0].release.ns, 11'000'000);
    EXPECT_EQ(rows[8].release.ns, 31'000'000);
}

TEST_F(CountingHostTest, WorkWithoutARowRunsAndIsCountedAsLost) {
    verifies("SWR-TIM-030", Technique::kBoundaryValues, Polarity::kViolation);
    RunLog log{0U, 3U};
    CountingHost sut{clock_, log, executive_.get_view(), {}, wall_, false};

    run_frames(sut, 1U);

    EXPECT_EQ(log.get_steps().size(), 3U);
    EXPECT_EQ(log.get_lost_count(), 5U);
    EXPECT_EQ(first_.run_count + second_.run_count, 2);
}

TEST_F(CountingHostTest, AStepThatHangsHasNoInstants) {
    verifies("SWR-TIM-030", Technique::kErrorGuessing, Polarity::kViolation);
    times_[1] = kNever;
    RunLog log{0U, 64U};
    CountingHost sut{clock_, log, executive_.get_view(), {}, wall_, false};

    run_frames(sut, 1U);

    EXPECT_EQ(overrun_count_, 1U);
    EXPECT_EQ(log.get_steps()[2].component, 1U);
    EXPECT_EQ(log.get_steps()[2].start_ns.load(), kNoInstant.ns);
}

TEST_F(CountingHostTest, PacedWorkDoesNotBeginBeforeItsInstant) {
    verifies("SWR-TIM-030");
    RunLog log{0U, 64U};
    CountingHost sut{clock_, log, executive_.get_view(), {}, wall_, true};

    run_frames(sut, 2U);

    for (const StepRow& row : log.get_steps()) {
        EXPECT_GE(row.start_ns.load(), row.release.ns);
    }
}

TEST_F(CountingHostTest, CountingDoesNotAffectAWindow) {
    verifies("SWR-TIM-030");
    RunLog log{0U, 64U};
    CountingHost sut{clock_, log, executive_.get_view(), {}, wall_, false};

    run_frames(sut, 2U);

    EXPECT_EQ(sut.get_now(), clock_.get_now());
    EXPECT_EQ(sut.get_step_end(), clock_.get_step_end());
    EXPECT_TRUE(sut.has_returned(0U));
}

}  // namespace
}  // namespace mamori::timing

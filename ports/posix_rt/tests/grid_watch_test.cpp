// SPDX-License-Identifier: Apache-2.0
// Goal: the watch finds an action that the runner of a core does not do in time, closes the outputs and
// latches the finding. Method: the evaluation with a clock that the test sets, on both sides of each limit;
// the thread with runners that hang in a sleep and in the wait of their guard. The tests do not depend on the
// speed of the host: they wait for expected events, and unexpected events have a limit of one hour.
#include "mamori/ports/posix_rt/grid_watch.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_clock.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;
using literals::operator""_us;

class Idle final : public Component {
  public:
    constexpr explicit Idle(const char* name) noexcept : Component(name) {}
    Status on_execute(ContextHandle) noexcept override {
        is_in = is_to_hang.load();
        while (is_to_hang) {
            std::this_thread::yield();
        }
        return Status::kOk;
    }
    std::atomic<bool> is_to_hang{false};
    std::atomic<bool> is_in{false};
};

/// Two windows of one core, made for each test.
struct TestSystem {
    Idle first{"first"};
    Idle second{"second"};
    SystemTable<2U, 2U, 0U, 0U> table =
        system(frame(10_ms), window("first", 0_ms, 3_ms, budget(2_ms), run(first)),
               window("second", 5_ms, 4_ms, budget(2_ms), run(second)));
};

constexpr GridLimits kLimits{1_ms, 200_us, {10_ms, 5000}};

/// One beat and the check, with two clocks that the test sets.
class GridCheckTest : public ::testing::Test {
  protected:
    GridFinding look_at(Instant now) { return sut_.look({now, now.ns, Duration{0}}); }
    TestSystem system_;
    std::array<GridBeat, 2U> beats_{GridBeat{make_view(system_.table), 0U},
                                    GridBeat{make_view(system_.table), 0U}};
    GridCheck sut_{beats_, kLimits};
};

TEST_F(GridCheckTest, NothingIsDueBeforeTheFirstWindowAndAfterARest) {
    verifies("SWR-PRT-031", Technique::kStateTransition);
    EXPECT_EQ(look_at(Instant{0} + 3600_s).fault, GridFault::kNone);
    beats_[0].expect(Instant{0});
    EXPECT_EQ(look_at(Instant{0} + 3601_s).fault, GridFault::kOverdue);
    beats_[0].rest();
    EXPECT_EQ(look_at(Instant{0} + 3602_s).fault, GridFault::kNone);
}

TEST_F(GridCheckTest, LimitsThatMeanNothingAreRejected) {
    verifies("SWR-PRT-031", Technique::kBoundaryValues, Polarity::kViolation);
    const auto make = [this](const GridLimits& limits) {
        const GridCheck check(beats_, limits);
        static_cast<void>(check);
    };

    make({0_ms, Duration{1}, {Duration{1}, 1}});
    EXPECT_CHECK_FAILS(make({Duration{-1}, Duration{1}, {Duration{1}, 1}}), "grid_watch.cpp", 1);
    EXPECT_CHECK_FAILS(make({0_ms, 0_ms, {Duration{1}, 1}}), "grid_watch.cpp", 1);
    EXPECT_CHECK_FAILS(make({0_ms, Duration{1}, {0_ms, 1}}), "grid_watch.cpp", 2);
    EXPECT_CHECK_FAILS(make({0_ms, Duration{1}, {Duration{1}, 0}}), "grid_watch.cpp", 2);
}

TEST_F(GridCheckTest, AWindowMustStartAndEndAtItsPlannedInstants) {
    verifies("SWR-PRT-031");
    GridBeat& beat = beats_[0];
    beat.expect(Instant{1});
    EXPECT_EQ(beat.get_due(), Instant{0} + 5_ms) << "the first window that starts then or later";
    beat.before_opening({1U, Instant{0} + 5_ms}, Instant{0} + 6_ms);
    EXPECT_EQ(beat.get_due(), Instant{0} + 9_ms) << "also after a late start";
    beat.after_opening({1U, Instant{0} + 5_ms}, WindowOutcome::kCompleted);
    EXPECT_EQ(beat.get_due(), Instant{0} + 10_ms);
    beat.before_opening({0U, Instant{0} + 10_ms}, Instant{0} + 10_ms);
    EXPECT_EQ(beat.get_due(), Instant{0} + 13_ms);
    beat.after_opening({0U, Instant{0} + 10_ms}, WindowOutcome::kOverrun);
    EXPECT_EQ(beat.get_due(), Instant{0} + 15_ms);
}

TEST_F(GridCheckTest, AnActionIsOverdueJustAfterTheLatenessAndItsCoreIsNamed) {
    verifies("SWR-PRT-031", Technique::kBoundaryValues, Polarity::kViolation);
    beats_[0].expect(Instant{0} + 10_ms);
    beats_[1].expect(Instant{0} + 5_ms);

    EXPECT_EQ(look_at(Instant{0} + 6_ms).fault, GridFault::kNone);
    const GridFinding finding = look_at(Instant{1} + 6_ms);
    EXPECT_EQ(finding.fault, GridFault::kOverdue);
    EXPECT_EQ(finding.core, 1U);
    EXPECT_EQ(finding.due, Instant{0} + 5_ms);
    EXPECT_EQ(finding.seen, Instant{1} + 6_ms);
    beats_[1].rest();
    EXPECT_EQ(look_at(Instant{0} + 11_ms).fault, GridFault::kNone);
    EXPECT_EQ(look_at(Instant{1} + 11_ms).core, 0U);
}

TEST_F(GridCheckTest, AnInfiniteLatenessIsNeverExceeded) {
    verifies("SWR-PRT-044", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::int64_t kLongest = std::numeric_limits<std::int64_t>::max();
    GridCheck sut{beats_, {Duration{kLongest}, 200_us, {10_ms, 5000}}};
    beats_[0].expect(Instant{0} + 10_ms);
    EXPECT_EQ(sut.look({Instant{0} + 3600_s, (Instant{0} + 3600_s).ns, Duration{0}}).fault, GridFault::kNone);
}

TEST_F(GridCheckTest, AWrongClockRateHasPriorityOverAnOverdueAction) {
    verifies("SWR-PRT-032", Technique::kFaultInjection, Polarity::kViolation);
    beats_[0].expect(Instant{0});
    ASSERT_EQ(sut_.look({Instant{0}, 0, {}}).fault, GridFault::kNone);

    EXPECT_EQ(sut_.look({Instant{2'050'001}, 2'000'000, {}}).fault, GridFault::kFastClock);
    ASSERT_EQ(sut_.look({Instant{2'100'000}, 3'000'000, {}}).fault, GridFault::kOverdue) << "begins again";
    beats_[0].rest();
    ASSERT_EQ(sut_.look({Instant{2'200'000}, 4'000'000, {}}).fault, GridFault::kNone);
    EXPECT_EQ(sut_.look({Instant{2'200'000}, 4'050'001, {}}).fault, GridFault::kSlowClock);
}

TEST_F(GridCheckTest, AnInnerObserverIsCalledFirst) {
    verifies("SWR-PRT-031", Technique::kInterface);
    class Inner final : public OpeningObserver {
      public:
        void before_opening(const FrameSchedule::Opening&, Instant) noexcept override {
            due = beat->get_due();
            ++count;
        }
        void after_opening(const FrameSchedule::Opening&, WindowOutcome) noexcept override { ++count; }
        const GridBeat* beat{nullptr};
        Instant due{};
        int count{0};
    } inner;
    GridBeat beat{make_view(system_.table), 0U, &inner};
    inner.beat = &beat;
    beat.expect(Instant{0});

    beat.before_opening({0U, Instant{0}}, Instant{0});
    beat.after_opening({0U, Instant{0}}, WindowOutcome::kCompleted);
    EXPECT_EQ(inner.due, Instant{0}) << "still due while the observer runs";
    EXPECT_EQ(inner.count, 2);
}

/// The thread with a schedule that a runner executes in another thread.
class GridWatchTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(host_.open(), Status::kOk);
        ASSERT_EQ(executive_.initialize(), Status::kOk);
        ASSERT_EQ(executive_.start(), Status::kOk);
        runner_.set_observer(&beats_[0]);
    }
    void TearDown() override {
        source_.is_stuck = false;
        system_.first.is_to_hang = false;
        runner_.request_stop();
        if (running_.joinable()) {
            running_.join();
        }
        sut_.close();
        while (host_.close() != Status::kOk) {
            std::this_thread::yield();
        }
    }
    void run_for_ever() {
        running_ = std::thread{[this] { runner_.run(1'000'000U); }};
    }
    static void wait_for(const std::atomic<bool>& flag) {
        while (!flag) {
            std::this_thread::yield();
        }
    }
    void wait_until_latched() const {
        while (!sut_.is_latched()) {
            std::this_thread::yield();
        }
    }
    void wait_for_looks(std::uint64_t count) const {
        const std::uint64_t end = sut_.get_look_count() + count;
        while (sut_.get_look_count() < end) {
            std::this_thread::yield();
        }
    }
    static void shut(void* argument) noexcept { ++static_cast<GridWatchTest*>(argument)->shut_count_; }

    /// Large limits: a hanging runner is overdue after 1 s, and the deviation of the clock never reaches 50
    /// %.
    static constexpr GridLimits kPatient{1_s, 200_us, {10_ms, 500'000}};

    TestSystem system_;
    StuckClock source_;
    const FrameClock clock_ = FrameClock::starting_in(0_ms, source_);
    std::array<WindowThread, 2U> threads_;
    GuardedHost host_{threads_, clock_, {}};
    ExecutiveFor<decltype(system_.table)> executive_{system_.table};
    CoreRunner runner_{executive_, host_, clock_};
    std::array<GridBeat, 1U> beats_{GridBeat{make_view(system_.table), 0U}};
    std::atomic<int> shut_count_{0};
    GridWatch sut_{beats_, clock_, get_raw_clock(), kPatient, {&shut, this}, {}};
    std::thread running_;
};

TEST_F(GridWatchTest, AMissingTimerExpiryClosesTheOutputsWithoutTheRunner) {
    verifies("SWR-PRT-031", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.open(), Status::kOk);
    run_for_ever();
    while (beats_[0].get_due() == GridBeat::kNever) {
        std::this_thread::yield();
    }
    EXPECT_FALSE(sut_.is_latched());
    source_.is_stuck = true;

    wait_until_latched();
    EXPECT_EQ(sut_.get_finding().fault, GridFault::kOverdue);
    EXPECT_EQ(sut_.get_finding().core, 0U);
    EXPECT_GT(sut_.get_finding().seen, sut_.get_finding().due + kPatient.lateness);
    EXPECT_EQ(shut_count_, 1);
}

TEST_F(GridWatchTest, AWatchThatIsOpenedAgainWatches) {
    verifies("SWR-PRT-031", Technique::kStateTransition, Polarity::kViolation);
    EXPECT_EQ(sut_.get_look_count(), 0U);
    EXPECT_FALSE(sut_.is_latched());
    ASSERT_EQ(sut_.open(), Status::kOk);
    sut_.close();
    ASSERT_EQ(sut_.open(), Status::kOk);
    wait_for_looks(2U);
    run_for_ever();
    while (beats_[0].get_due() == GridBeat::kNever) {
        std::this_thread::yield();
    }
    source_.is_stuck = true;

    wait_until_latched();
    EXPECT_EQ(sut_.get_finding().fault, GridFault::kOverdue);
}

TEST_F(GridWatchTest, AGuardThatHangsWithItsComponentIsFoundAtTheEndOfTheWindow) {
    verifies("SWR-PRT-031", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.open(), Status::kOk);
    system_.first.is_to_hang = true;
    source_.is_stuck = false;
    // The timers stop after the sleep before the window, so that only the deadline of the guard never comes.
    beats_[0].expect(clock_.get_now());
    running_ = std::thread{[this] {
        WindowOutcome outcome = WindowOutcome::kMissed;
        while (outcome == WindowOutcome::kMissed) {  // because the host stalled
            source_.is_stuck = false;
            const Instant release{(clock_.get_now().ns / 10'000'000 + 1) * 10'000'000};
            clock_.wait_until(release);
            source_.is_stuck = true;
            beats_[0].before_opening({0U, release}, clock_.get_now());
            outcome = executive_.run_window(0U, release, host_);
        }
    }};
    wait_for(system_.first.is_in);

    wait_until_latched();
    EXPECT_EQ(sut_.get_finding().fault, GridFault::kOverdue);
    EXPECT_EQ(sut_.get_finding().due.ns % 10'000'000, 3'000'000) << "the planned end of the window";
    EXPECT_EQ(shut_count_, 1);
}

TEST_F(GridWatchTest, AFindingKeepsItsFirstCauseAndTheOutputsAreClosedOnce) {
    verifies("SWR-PRT-033", Technique::kFaultInjection, Polarity::kViolation);
    beats_[0].expect(clock_.get_now() + 10_ms);
    const Instant due = beats_[0].get_due();
    ASSERT_EQ(sut_.open(), Status::kOk);
    EXPECT_EQ(sut_.open(), Status::kPreconditionNotMet);
    wait_until_latched();

    beats_[0].rest();
    wait_for_looks(3U);
    EXPECT_TRUE(sut_.is_latched()) << "though nothing is overdue now";
    beats_[0].expect(Instant{0});
    wait_for_looks(3U);
    EXPECT_EQ(sut_.get_finding().due, due);
    EXPECT_EQ(shut_count_, 1);
    sut_.close();
    EXPECT_TRUE(sut_.is_latched());
}

TEST_F(GridWatchTest, AResetIsRejectedUntilASpanHadNoViolationAndThenMonitoringResumes) {
    verifies("SWR-PRT-033", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.open(), Status::kOk);
    EXPECT_EQ(sut_.reset(), Status::kPreconditionNotMet) << "nothing is latched";
    beats_[0].expect(Instant{0});
    wait_until_latched();
    wait_for_looks(3U);
    EXPECT_EQ(sut_.reset(), Status::kPreconditionNotMet) << "it is still overdue";

    beats_[0].rest();
    while (sut_.reset() != Status::kOk) {
        std::this_thread::yield();
    }
    EXPECT_FALSE(sut_.is_latched());
    EXPECT_EQ(sut_.get_finding().fault, GridFault::kNone);
    beats_[0].expect(Instant{0});
    wait_until_latched();
    EXPECT_EQ(shut_count_, 2);
}

TEST_F(GridWatchTest, AResetIsRejectedBeforeTheEndOfASpanWithoutViolation) {
    verifies("SWR-PRT-033", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr GridLimits kLongSpan{Duration{0}, 200_us, {3600_s, 500'000}};
    GridWatch sut{beats_, clock_, get_raw_clock(), kLongSpan, {&shut, this}, {}};
    beats_[0].expect(Instant{0});
    ASSERT_EQ(sut.open(), Status::kOk);
    while (!sut.is_latched()) {
        std::this_thread::yield();
    }

    beats_[0].rest();
    const std::uint64_t end = sut.get_look_count() + 3U;
    while (sut.get_look_count() < end) {
        std::this_thread::yield();
    }
    EXPECT_EQ(sut.reset(), Status::kPreconditionNotMet);
    EXPECT_TRUE(sut.is_latched());
    sut.close();
}

TEST_F(GridWatchTest, ARunInTimeAndADeliberateEndAreNotReported) {
    verifies("SWR-PRT-031");
    constexpr GridLimits kHour{3600_s, 200_us, {10_ms, 500'000}};
    GridWatch sut{beats_, clock_, get_raw_clock(), kHour, {&shut, this}, {}};
    ASSERT_EQ(sut.open(), Status::kOk);
    beats_[0].expect(clock_.get_now());
    runner_.run(10U);
    beats_[0].rest();

    EXPECT_GT(sut.get_look_count(), 0U);
    EXPECT_FALSE(sut.is_latched()) << "unless the host stalled for an hour";
    EXPECT_EQ(shut_count_, 0);
    sut.close();
    sut.close();
    EXPECT_EQ(sut.open(), Status::kOk) << "again";
    sut.close();
}

TEST(GridWatchRightsTest, AWatchNeedsOutputsToClose) {
    verifies("SWR-PRT-033", Technique::kBoundaryValues, Polarity::kViolation);
    const FrameClock clock = FrameClock::starting_in(0_ms);
    EXPECT_CHECK_FAILS((GridWatch{{}, clock, get_raw_clock(), kLimits, {nullptr, nullptr}, {}}),
                       "grid_watch.cpp", 3);
}

TEST(GridWatchRightsTest, ItsThreadGetsItsPriority) {
    verifies("SWR-PRT-031", Technique::kErrorGuessing);
    const FrameClock clock = FrameClock::starting_in(0_ms);
    const TestSystem system;
    std::array<GridBeat, 1U> beats{GridBeat{make_view(system.table), 0U}};
    const OutputGate gate{[](void*) noexcept {}, nullptr};
    GridWatch sut{beats, clock, get_raw_clock(), kLimits, gate, {5, ThreadPlace::kAnyProcessor}};
    ASSERT_EQ(sut.open(), Status::kOk);
    const Right right = sut.get_right();
    sut.close();
    if (!right.is_granted) {
        ASSERT_EQ(right.system_error, EPERM);
        GTEST_SKIP()
            << "verdict=no-privilege: this host grants no fixed priority (CAP_SYS_NICE or ulimit -r)";
    }
    EXPECT_EQ(right.system_error, 0);
}

}  // namespace
}  // namespace mamori::ports::posix_rt

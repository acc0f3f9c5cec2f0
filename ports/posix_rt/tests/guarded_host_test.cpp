// SPDX-License-Identifier: Apache-2.0
// Goal: work that is back in time is counted, work that is not is cut off without its help, and nobody else
// suffers. Method: a real executive; components that take longer than the deadline or hang until the test
// lets them go. Nothing is asked of the speed of the machine: deadlines are long, and what takes too long
// waits for the clock itself.
#include "mamori/ports/posix_rt/guarded_host.hpp"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/crash_place.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_clock.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;

class Reader final : public Component {
  public:
    Reader() noexcept : Component("reader") {}
    InPort<std::int64_t> in{*this, "in"};
    using Ports = mamori::Ports<&Reader::in>;
};

/// Does what the test says in its next cycle.
class Actor final : public Component {
  public:
    explicit Actor(const char* name) noexcept : Component(name) {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Actor::out>;

    std::atomic<bool> is_to_hang{false};
    std::atomic<bool> is_hanging{false};
    const FrameClock* clock{nullptr};
    Instant busy_until{};
    std::vector<std::int64_t> starts;

    Status on_execute(ContextHandle handle) noexcept override {
        starts.push_back(handle.now.ns);
        if (is_to_hang) {
            is_hanging = true;
            while (is_to_hang) {
                std::this_thread::yield();
            }
            is_hanging = false;
        }
        while (clock != nullptr && clock->get_now() <= busy_until) {
        }
        out.write(++count_);
        return Status::kOk;
    }

  private:
    std::int64_t count_{0};
};

class Ear final : public ExecutionObserver {
  public:
    std::vector<std::string> heard;
    void on_budget_overrun(std::size_t window, std::size_t component, Instant) noexcept override {
        heard.push_back("window " + std::to_string(window) + " component " + std::to_string(component));
    }
    void on_late_release(std::size_t, Duration, Instant) noexcept override {}
};

/// Two windows of a frame of 10 s, which no machine is too slow for; budgets are as the test needs them.
class GuardedHostTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(host_.open(), Status::kOk);
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        ASSERT_EQ(sut_.start(), Status::kOk);
        sut_.set_observer(&ear_);
    }
    void TearDown() override {
        first_.is_to_hang = false;
        while (host_.close() != Status::kOk) {
            std::this_thread::yield();
        }
    }
    void wait_until_back() const {
        while (!host_.has_returned(0U)) {
            std::this_thread::yield();
        }
    }

    Actor first_{"first"};
    Actor second_{"second"};
    Actor other_{"other"};
    SystemTable<2U, 3U, 3U, 0U> table_ =
        system(frame(10_s), window("guarded", 0_s, 5_s, budget(20_ms), run(first_, second_)),
               window("other", 5_s, 5_s, budget(5_s), run(other_)));
    const FrameClock clock_ = FrameClock::starting_in(0_ms);
    std::array<WindowThread, 2U> threads_;
    GuardedHost host_{threads_, clock_, {}};
    Ear ear_;
    ExecutiveFor<decltype(table_)> sut_{table_};
};

TEST_F(GuardedHostTest, WorkThatIsBackInTimeCompletesItsWindow) {
    verifies("SWR-PRT-003");

    EXPECT_EQ(sut_.run_window(1U, Instant{0}, host_), WindowOutcome::kCompleted);
    EXPECT_EQ(other_.out.get_sequence(), 1U);
    EXPECT_TRUE(host_.get_priority_right().is_granted) << "none was asked for";
    EXPECT_TRUE(host_.get_processor_right().is_granted);
}

TEST_F(GuardedHostTest, AComponentThatHangsIsNamedAndTheOtherWindowRuns) {
    verifies("SWR-PRT-003", Technique::kFaultInjection, Polarity::kViolation);
    first_.is_to_hang = true;

    EXPECT_EQ(sut_.run_window(0U, Instant{0}, host_), WindowOutcome::kOverrun);
    while (!first_.is_hanging) {
        std::this_thread::yield();
    }
    EXPECT_FALSE(host_.has_returned(0U));
    EXPECT_EQ(sut_.run_window(1U, Instant{0}, host_), WindowOutcome::kCompleted);
    EXPECT_EQ(sut_.run_window(0U, Instant{0}, host_), WindowOutcome::kOverrun);
    EXPECT_EQ(host_.close(), Status::kPreconditionNotMet) << "its thread is still out";

    EXPECT_TRUE(second_.starts.empty());
    EXPECT_EQ(ear_.heard, (std::vector<std::string>{"window 0 component 0", "window 0 component 0"}));
    EXPECT_EQ(first_.out.get_sequence(), 0U);
}

TEST_F(GuardedHostTest, WorkThatComesBackLateIsThrownAwayAndTheNextCycleCounts) {
    verifies("SWR-PRT-003", Technique::kFaultInjection, Polarity::kViolation);
    first_.is_to_hang = true;
    ASSERT_EQ(sut_.run_window(0U, Instant{0}, host_), WindowOutcome::kOverrun);
    first_.is_to_hang = false;
    wait_until_back();

    table_.windows[0].budget = 5_s;  // which no machine is too slow for
    EXPECT_EQ(sut_.run_window(0U, clock_.get_now(), host_), WindowOutcome::kCompleted);
    EXPECT_EQ(first_.out.get_sequence(), 1U);
    EXPECT_EQ(second_.out.get_sequence(), 1U);
}

TEST_F(GuardedHostTest, AStepThatEndsAfterTheDeadlineIsNotCountedThoughItCameBack) {
    verifies("SWR-PRT-003", Technique::kBoundaryValues, Polarity::kViolation);
    second_.clock = &clock_;
    second_.busy_until = clock_.get_now() + 500_ms;

    WindowOutcome outcome = sut_.run_window(0U, clock_.get_now(), host_);

    EXPECT_EQ(outcome, WindowOutcome::kOverrun);
    EXPECT_EQ(second_.out.get_sequence(), 0U);
    ASSERT_FALSE(ear_.heard.empty());
}

TEST_F(GuardedHostTest, ThreadsThatAreOpenAreNotOpenedAgain) {
    verifies("SWR-PRT-003", Technique::kErrorGuessing, Polarity::kViolation);
    GuardedHost another{threads_, clock_, {}};

    EXPECT_EQ(host_.open(), Status::kPreconditionNotMet);
    EXPECT_EQ(another.open(), Status::kPreconditionNotMet);
    ASSERT_EQ(host_.close(), Status::kOk);
    EXPECT_EQ(host_.close(), Status::kOk) << "nothing to end";
    EXPECT_EQ(another.open(), Status::kOk);
    EXPECT_EQ(another.close(), Status::kOk);
    EXPECT_EQ(host_.open(), Status::kOk);
}

/// One window whose thread notes on a signal where it is.
class WaitingThreadTest : public ::testing::Test {
  protected:
    static void note(int) {
        place_ = get_crash_place();
        ++noted_;
    }
    static void run_step(void*, std::size_t, std::size_t) noexcept {
        thread_ = ::gettid();
        stack_t stack{};
        static_cast<void>(::sigaltstack(nullptr, &stack));
        has_crash_stack_ = stack.ss_flags != SS_DISABLE;
    }
    std::size_t run_window(Instant deadline) {
        return host_.run_within({&run_step, nullptr, 0U, 0U, 0U, 1U, WindowHost::Pass::kExecute}, deadline);
    }

    static inline std::atomic<int> noted_{0};
    static inline CrashPlace place_{};
    static inline std::atomic<pid_t> thread_{0};
    static inline std::atomic<bool> has_crash_stack_{false};
    const FrameClock clock_ = FrameClock::starting_in(0_ms);
    std::array<WindowThread, 1U> threads_;
    GuardedHost host_{threads_, clock_, {}};
};

TEST_F(WaitingThreadTest, ASignalDoesNotEndTheWaitAndFindsNoComponent) {
    verifies("SWR-PRT-003", Technique::kFaultInjection, Polarity::kViolation);
    struct sigaction action{};
    struct sigaction before{};
    action.sa_handler = &note;  // without SA_RESTART: the wait ends early
    ASSERT_EQ(sigaction(SIGUSR1, &action, &before), 0);
    ASSERT_EQ(host_.open(), Status::kOk);
    for (int i = 1; i <= 3; ++i) {
        ASSERT_EQ(run_window(clock_.get_now() + 600_s), 1U);
        ASSERT_EQ(::syscall(SYS_tgkill, ::getpid(), thread_.load(), SIGUSR1), 0);
        while (noted_ < i) {
            std::this_thread::yield();
        }
        EXPECT_EQ(place_.window, CrashPlace::kNone);
        EXPECT_EQ(place_.component, CrashPlace::kNone);
    }
    EXPECT_EQ(host_.close(), Status::kOk);
    ASSERT_EQ(sigaction(SIGUSR1, &before, nullptr), 0);
}

TEST_F(WaitingThreadTest, AThreadThatIsStartedAgainHasACrashStackAgain) {
    verifies("SWR-PRT-026", Technique::kStateTransition);
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(host_.open(), Status::kOk);
        has_crash_stack_ = false;
        ASSERT_EQ(run_window(clock_.get_now() + 600_s), 1U);
        EXPECT_TRUE(has_crash_stack_) << i;
        ASSERT_EQ(host_.close(), Status::kOk);
    }
}

TEST_F(WaitingThreadTest, WorkNeedsAnOpenThreadThatHasReturned) {
    verifies("SWR-PRT-003", Technique::kInterface, Polarity::kViolation);
    EXPECT_CHECK_FAILS(static_cast<void>(run_window(Instant{})), "guarded_host.cpp", 5);
    EXPECT_CHECK_FAILS(
        {
            static_cast<void>(host_.open());
            const auto hang = [](void*, std::size_t, std::size_t) noexcept {
                for (;;) {
                    static_cast<void>(::pause());
                }
            };
            static_cast<void>(
                host_.run_within({hang, nullptr, 0U, 0U, 0U, 1U, WindowHost::Pass::kExecute}, Instant{}));
            static_cast<void>(run_window(Instant{}));
        },
        "guarded_host.cpp", 5);
}

TEST_F(WaitingThreadTest, AStepThatEndsAtTheDeadlineIsInTime) {
    verifies("SWR-PRT-003", Technique::kBoundaryValues);
    FakeClock source{0};
    source.monotonic_offset_ns = get_monotonic_clock().read_ns() + 600'000'000'000;  // no deadline passes
    const FrameClock clock = FrameClock::starting_in(0_ms, source);
    source.now_ns = 5'000;
    GuardedHost host{threads_, clock, {}};
    ASSERT_EQ(host.open(), Status::kOk);
    const WindowHost::Work work{&run_step, nullptr, 0U, 0U, 0U, 1U, WindowHost::Pass::kExecute};
    EXPECT_EQ(host.run_within(work, Instant{5'000}), 1U);
    EXPECT_EQ(host.run_within(work, Instant{4'999}), 0U);
    EXPECT_EQ(host.close(), Status::kOk);
}

TEST_F(WaitingThreadTest, RightsAreThoseOfTheThreadsOfTheHost) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    GuardedHost elsewhere{threads_, clock_, {0, 100'000}};
    ASSERT_EQ(elsewhere.open(), Status::kOk);
    EXPECT_TRUE(elsewhere.get_priority_right().is_granted);
    EXPECT_FALSE(elsewhere.get_processor_right().is_granted);
    EXPECT_EQ(elsewhere.get_processor_right().system_error, EINVAL);
    ASSERT_EQ(elsewhere.close(), Status::kOk);

    const std::array<WindowRow, 1U> rows{};
    GuardedHost without{threads_, rows, 1U, clock_, {0, 100'000}};
    ASSERT_EQ(without.open(), Status::kOk) << "no window is on its core";
    for (const Right& right : {without.get_priority_right(), without.get_processor_right()}) {
        EXPECT_TRUE(right.is_granted);
        EXPECT_EQ(right.system_error, 0);
    }
    EXPECT_EQ(without.close(), Status::kOk);
}

struct Gate {
    std::atomic<bool> is_closed{false};
    std::atomic<bool> is_reached{false};
};
Status wait_for(Gate& gate, ContextHandle) noexcept {
    gate.is_reached = true;
    while (gate.is_closed) {
        std::this_thread::yield();
    }
    return Status::kOk;
}

TEST(GuardedFunctionTest, ASystemWindowThatHangsIsNamedAndTheOtherWindowRuns) {
    verifies("SWR-KRN-097", Technique::kFaultInjection, Polarity::kViolation);
    Gate gate;
    SystemFunction<&wait_for> function{"function", gate};
    Actor other{"other"};
    auto table = system(frame(10_s), system_window("call", 0_s, 5_s, budget(20_ms), function),
                        window("other", 5_s, 5_s, budget(5_s), run(other)));
    const FrameClock clock = FrameClock::starting_in(0_ms);
    std::array<WindowThread, 2U> threads;
    GuardedHost host{threads, clock, {}};
    Ear ear;
    ExecutiveFor executive{table};
    ASSERT_EQ(host.open(), Status::kOk);
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);
    executive.set_observer(&ear);

    gate.is_closed = true;
    EXPECT_EQ(executive.run_window(0U, Instant{0}, host), WindowOutcome::kOverrun);
    while (!gate.is_reached) {
        std::this_thread::yield();
    }
    EXPECT_EQ(executive.run_window(1U, Instant{0}, host), WindowOutcome::kCompleted);
    EXPECT_EQ(ear.heard, (std::vector<std::string>{"window 0 component 0"}));

    gate.is_closed = false;
    while (!host.has_returned(0U)) {
        std::this_thread::yield();
    }
    table.windows[0].budget = 5_s;
    EXPECT_EQ(executive.run_window(0U, clock.get_now(), host), WindowOutcome::kCompleted);
    ASSERT_EQ(host.close(), Status::kOk);
}

class CoreRunnerTest : public ::testing::Test {
  protected:
    Actor a_{"a"};
    Actor b_{"b"};
    SystemTable<2U, 2U, 2U, 0U> table_ =
        system(frame(20_ms), window("a", 0_ms, 10_ms, budget(10_ms), run(a_)),
               window("b", 10_ms, 10_ms, budget(10_ms), run(b_)));
    const FrameClock clock_ = FrameClock::starting_in(20_ms);
    std::array<WindowThread, 2U> threads_;
    GuardedHost host_{threads_, clock_, {}};
    ExecutiveFor<decltype(table_)> executive_{table_};
    CoreRunner sut_{executive_, host_, clock_};
};

TEST(CoreRunnerMarginTest, ATableOfTwoCoresNeedsAPublicationMargin) {
    verifies("SWR-PRT-047", Technique::kBoundaryValues, Polarity::kViolation);
    Actor writer{"writer"};
    Reader reader;
    Crossing<std::int64_t> crossing;
    const FrameClock clock = FrameClock::starting_in(0_ms);
    const auto run_once = [&](Duration margin, std::size_t reader_core, std::uint64_t frame_count = 1U) {
        const auto table = system(frame(1_ms), publication_margin(margin),
                                  window("w", 0_ms, Duration{400'000}, budget(Duration{1000}), run(writer)),
                                  window("r", Duration{500'000}, Duration{400'000}, core(reader_core),
                                         budget(Duration{1000}), run(reader)),
                                  connect(writer.out, reader.in, through(crossing), any_age()));
        ExecutiveFor executive{table};
        std::array<WindowThread, 2U> threads;
        GuardedHost host{threads, clock, {}};
        CoreRunner sut{executive, host, clock};
        sut.request_stop();
        sut.run(frame_count);
        return sut.get_counts().opened;
    };

    EXPECT_CHECK_FAILS(run_once(0_ms, 1U), "core_runner.cpp", 2);
    EXPECT_CHECK_FAILS(run_once(Duration{1}, 1U, 0U), "core_runner.cpp", 1);
    EXPECT_EQ(run_once(Duration{1}, 1U), 0U) << "stopped, not rejected";
    EXPECT_EQ(run_once(0_ms, 0U), 0U);
}

TEST(CoreRunnerMarginTest, AConnectionWithoutItsWindowsLeavesNoCore) {
    verifies("SWR-PRT-047", Technique::kBoundaryValues);
    std::array<WindowRow, 2U> windows{};
    windows[1U].core = 1U;
    std::array<ConnectionRow, 1U> connections{};
    const auto has_margin = [&](std::size_t source, std::size_t sink) {
        connections[0U].source_window = source;
        connections[0U].sink_window = sink;
        SystemView view{};
        view.windows = windows;
        view.connections = connections;
        return has_publication_margin(view);
    };
    EXPECT_TRUE(has_margin(kNoIndex, 1U));
    EXPECT_TRUE(has_margin(1U, kNoIndex));
    EXPECT_TRUE(has_margin(kNoIndex, kNoIndex));
    EXPECT_TRUE(has_margin(1U, 1U));
    EXPECT_FALSE(has_margin(0U, 1U));
}

TEST_F(CoreRunnerTest, EachWindowOpensAtItsPlaceOnTheGridHoweverLateTheMachineIs) {
    verifies("SWR-PRT-005");
    ASSERT_EQ(host_.open(), Status::kOk);
    ASSERT_EQ(executive_.initialize(), Status::kOk);
    ASSERT_EQ(executive_.start(), Status::kOk);

    sut_.run(10U);
    const Instant ended = clock_.get_now();

    const OpeningCounts& counts = sut_.get_counts();
    EXPECT_EQ(counts.opened, 20U);
    EXPECT_GE(counts.worst_lateness, 0_ms);
    EXPECT_GE(ended, Instant{0} + 190_ms) << "the last window opens there";
    while (host_.close() != Status::kOk) {
        std::this_thread::yield();
    }
    for (const std::int64_t start : a_.starts) {
        EXPECT_EQ(start % 20'000'000, 0);
    }
    for (const std::int64_t start : b_.starts) {
        EXPECT_EQ(start % 20'000'000, 10'000'000);
    }
    EXPECT_LE(a_.starts.size() + b_.starts.size() + counts.missed, 20U);
    EXPECT_GE(a_.starts.size() + b_.starts.size() + counts.missed + counts.overran, 20U);
}

TEST_F(CoreRunnerTest, AListenerIsToldOfEachOpeningBeforeAndAfter) {
    verifies("SWR-PRT-006");
    class Listener final : public OpeningObserver {
      public:
        void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override {
            is_early = is_early || woke < opening.release;
            heard.push_back("before " + std::to_string(opening.window));
        }
        void after_opening(const FrameSchedule::Opening& opening, WindowOutcome) noexcept override {
            heard.push_back("after " + std::to_string(opening.window));
        }
        std::vector<std::string> heard;
        bool is_early{false};
    } listener;
    ASSERT_EQ(host_.open(), Status::kOk);
    ASSERT_EQ(executive_.initialize(), Status::kOk);
    ASSERT_EQ(executive_.start(), Status::kOk);
    sut_.set_observer(&listener);

    sut_.run(1U);
    sut_.set_observer(nullptr);
    sut_.run(1U);

    EXPECT_EQ(listener.heard, (std::vector<std::string>{"before 0", "after 0", "before 1", "after 1"}));
    EXPECT_FALSE(listener.is_early);
    while (host_.close() != Status::kOk) {
        std::this_thread::yield();
    }
}

TEST_F(CoreRunnerTest, AStopEndsTheRunBeforeTheNextOpening) {
    verifies("SWR-PRT-005", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(host_.open(), Status::kOk);
    sut_.request_stop();

    sut_.run(1'000'000U);

    EXPECT_EQ(sut_.get_counts().opened, 0U);
    EXPECT_EQ(host_.close(), Status::kOk);
}

TEST_F(CoreRunnerTest, AWindowThatHangsMovesNoOtherWindow) {
    verifies("SWR-PRT-005", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(host_.open(), Status::kOk);
    ASSERT_EQ(executive_.initialize(), Status::kOk);
    ASSERT_EQ(executive_.start(), Status::kOk);
    a_.is_to_hang = true;

    sut_.run(5U);

    EXPECT_GE(sut_.get_counts().overran, 1U);
    EXPECT_EQ(sut_.get_counts().opened, 10U);
    a_.is_to_hang = false;
    while (host_.close() != Status::kOk) {
        std::this_thread::yield();
    }
    EXPECT_LE(a_.starts.size(), 1U);
    for (const std::int64_t start : b_.starts) {
        EXPECT_EQ(start % 20'000'000, 10'000'000);
    }
}

/// Stops the run after some openings.
class Counter final : public OpeningObserver {
  public:
    void before_opening(const FrameSchedule::Opening& opening, Instant) noexcept override {
        last_release = opening.release;
        ++count;
        if (count == stop_at) {
            runner->request_stop();
        }
    }
    void after_opening(const FrameSchedule::Opening&, WindowOutcome) noexcept override {}

    CoreRunner* runner{nullptr};
    int stop_at{0};
    int count{0};
    Instant last_release{};
};

TEST_F(CoreRunnerTest, EveryNumberOfFramesHoweverLargeRunsUntilTheStop) {
    verifies("SWR-PRT-043", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::uint64_t kSigned = std::numeric_limits<std::int64_t>::max();
    constexpr std::uint64_t kFrame = 20'000'000U;
    ASSERT_EQ(host_.open(), Status::kOk);
    for (const std::uint64_t frames :
         {kSigned / kFrame - 100U, kSigned / kFrame, kSigned / kFrame + 1U, 2U * (kSigned / kFrame) + 2U,
          kSigned, kSigned + 1U, std::numeric_limits<std::uint64_t>::max()}) {
        CoreRunner sut{executive_, host_, clock_};
        Counter counter;
        counter.runner = &sut;
        counter.stop_at = 2;
        sut.set_observer(&counter);

        sut.run(frames);
        EXPECT_EQ(sut.get_counts().opened, 2U) << frames;
    }
    EXPECT_EQ(host_.close(), Status::kOk);
}

TEST_F(CoreRunnerTest, RunUntilStoppedEndsByASignalHandler) {
    verifies("SWR-PRT-043");
    static CoreRunner* runner = nullptr;
    runner = &sut_;
    struct sigaction action{};
    struct sigaction before{};
    action.sa_handler = [](int) { runner->request_stop(); };
    ASSERT_EQ(sigaction(SIGALRM, &action, &before), 0);
    const itimerval in_50_ms{{0, 0}, {0, 50'000}};
    ASSERT_EQ(host_.open(), Status::kOk);
    ASSERT_EQ(setitimer(ITIMER_REAL, &in_50_ms, nullptr), 0);

    sut_.run_until_stopped();

    ASSERT_EQ(sigaction(SIGALRM, &before, nullptr), 0);
    EXPECT_GE(clock_.get_now(), Instant{0}) << "it began with the first frame";
    EXPECT_EQ(host_.close(), Status::kOk);
}

TEST_F(CoreRunnerTest, RunUntilStoppedEndsByAnotherThread) {
    verifies("SWR-PRT-043");
    ASSERT_EQ(host_.open(), Status::kOk);
    Counter counter;
    sut_.set_observer(&counter);
    std::thread stopper{[this] {
        clock_.wait_until(Instant{0} + 100_ms);
        sut_.request_stop();
    }};

    sut_.run_until_stopped();

    stopper.join();
    EXPECT_GE(counter.count, 1);
    EXPECT_EQ(host_.close(), Status::kOk);
}

/// Stands still but for its sleeps, which end at their instant.
class JumpingClock final : public TimeSource {
  public:
    std::int64_t read_ns() const noexcept override { return now_ns; }
    void wait_until(std::int64_t ns) const noexcept override { now_ns = ns; }
    std::int64_t to_monotonic(std::int64_t ns) const noexcept override { return ns; }

    mutable std::int64_t now_ns{0};
};

/// Runs each step at once.
class InstantHost final : public WindowHost {
  public:
    explicit InstantHost(const FrameClock& clock) noexcept : clock_(clock) {}
    Instant get_now() const noexcept override { return clock_.get_now(); }
    Instant get_step_end() const noexcept override { return clock_.get_now(); }
    std::size_t run_within(const Work& work, Instant) noexcept override {
        work.run(work.argument, work.first, work.first + work.count);
        return work.count;
    }
    bool has_returned(std::size_t) const noexcept override { return true; }

  private:
    const FrameClock& clock_;
};

TEST_F(CoreRunnerTest, TheFirstFrameBeginsAtTheStatedInstantOrLater) {
    verifies("SWR-PRT-005", Technique::kBoundaryValues);
    constexpr std::int64_t kFrame = 20'000'000;
    JumpingClock source;
    const FrameClock clock = FrameClock::starting_in(0_ms, source);
    InstantHost host{clock};
    for (const auto [from, first] : {std::array<std::int64_t, 2U>{-1, 0},
                                     {0, 0},
                                     {1, kFrame},
                                     {2, kFrame},
                                     {kFrame - 1, kFrame},
                                     {kFrame, kFrame},
                                     {kFrame + 1, 2 * kFrame},
                                     {kFrame + 2, 2 * kFrame}}) {
        CoreRunner sut{executive_, host, clock};
        Counter counter;
        sut.set_observer(&counter);
        sut.run(1U, Instant{from});
        EXPECT_EQ(counter.count, 2) << from;
        EXPECT_EQ(counter.last_release, Instant{first} + 10_ms) << from;
    }
}

/// A clock whose sleeps end late, each by another time.
class LateClock final : public TimeSource {
  public:
    std::int64_t read_ns() const noexcept override { return now_ns; }
    void wait_until(std::int64_t ns) const noexcept override {
        constexpr std::array<std::int64_t, 4U> kLate{3, 7, 5, 7};
        now_ns = ns + offset_ns + kLate[sleeps % kLate.size()];
        ++sleeps;
    }
    std::int64_t to_monotonic(std::int64_t ns) const noexcept override { return ns; }

    std::int64_t offset_ns{0};
    mutable std::int64_t now_ns{0};
    mutable std::size_t sleeps{0U};
};

/// Does all steps of a window except the last one.
class FaultyHost final : public WindowHost {
  public:
    explicit FaultyHost(const FrameClock& clock) noexcept : clock_(clock) {}
    Instant get_now() const noexcept override { return clock_.get_now(); }
    Instant get_step_end() const noexcept override { return clock_.get_now(); }
    std::size_t run_within(const Work& work, Instant) noexcept override { return work.count - 1U; }
    bool has_returned(std::size_t) const noexcept override { return true; }

  private:
    const FrameClock& clock_;
};

TEST_F(CoreRunnerTest, OutcomesAndTheWorstLatenessAreCounted) {
    verifies("SWR-PRT-005", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(executive_.initialize(), Status::kOk);
    ASSERT_EQ(executive_.start(), Status::kOk);
    for (const bool is_missed : {false, true}) {
        LateClock source;
        source.offset_ns = is_missed ? 15'000'000 : 0;  // after the budget, and after the next release
        const FrameClock clock = FrameClock::starting_in(Duration{1}, source);
        FaultyHost host{clock};
        CoreRunner sut{executive_, host, clock};
        sut.run(2U);
        EXPECT_EQ(sut.get_counts().opened, 4U);
        EXPECT_EQ(sut.get_counts().overran, is_missed ? 2U : 4U) << "the other windows are less late";
        EXPECT_EQ(sut.get_counts().missed, is_missed ? 2U : 0U);
        EXPECT_EQ(sut.get_counts().worst_lateness, Duration{source.offset_ns + 7});
    }
}

TEST_F(CoreRunnerTest, AtTheEndOfTheTimeLineTheRunEndsOneFrameBeforeIt) {
    verifies("SWR-PRT-043", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
    constexpr std::int64_t kFrame = 20'000'000;
    JumpingClock source;
    const FrameClock clock = FrameClock::starting_in(0_ms, source);
    InstantHost host{clock};
    // Whole frames that are left from the next begin of a frame on, and the frames that a run asks for and
    // gets.
    for (const auto [left, wanted, expected] : {std::array<std::int64_t, 3U>{4, 2, 2},
                                                {4, 3, 3},
                                                {4, 4, 3},
                                                {4, kLast, 3},
                                                {2, 1, 1},
                                                {2, 2, 1},
                                                {1, 1, 0},
                                                {0, 1, 0}}) {
        source.now_ns = (kLast / kFrame - left) * kFrame - 1;
        CoreRunner sut{executive_, host, clock};
        Counter counter;
        sut.set_observer(&counter);

        sut.run(static_cast<std::uint64_t>(wanted));
        EXPECT_EQ(counter.count, 2 * expected) << left << " " << wanted;
    }
    source.now_ns = kLast;
    CoreRunner sut{executive_, host, clock};
    sut.run_until_stopped();
    EXPECT_EQ(sut.get_counts().opened, 0U);
}

}  // namespace
}  // namespace mamori::ports::posix_rt

// SPDX-License-Identifier: Apache-2.0
// Goal: each window opens at its place on the grid, even if another one hangs, and a run ends when it is told
// to. Method: a real executive on the real clock, with components that hang; clocks that are late or stand
// still for what real time does not show.
#include "mamori/ports/posix_rt/core_runner.hpp"

#include <gtest/gtest.h>
#include <sys/time.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/actor.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;

class Reader final : public Component {
  public:
    Reader() noexcept : Component("reader") {}
    InPort<std::int64_t> in{*this, "in"};
    using Ports = mamori::Ports<&Reader::in>;
};

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

/// Advances only in its sleeps, each of which ends at its instant.
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

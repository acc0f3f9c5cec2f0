// SPDX-License-Identifier: Apache-2.0
// Goal: what a tool reads is what happened; looking changes nothing; who asks for what is not there is told.
// Method: two windows with a queue between them, run by hand on a clock that the test sets.
#include "mamori/kernel/run/introspection.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

/// Reads at most one value per cycle; room for two.
class Taker final : public Component {
  public:
    constexpr Taker() noexcept : Component("taker") {}
    QueueInPort<std::int64_t, 2U> in{*this, "in"};
    using Ports = mamori::Ports<&Taker::in>;
    bool is_reading{true};

    Status on_execute(ContextHandle) noexcept override {
        std::int64_t value = 0;
        if (is_reading) {
            static_cast<void>(in.read(value));
        }
        return Status::kOk;
    }
};

/// "first": counter and relay, 0 to 400 ns, budget 300 ns; "second": the taker, 500 to 900 ns.
/// Ports: 0 counter.out, 1 relay.in, 2 relay.out, 3 taker.in.
class IntrospectionTest : public ::testing::Test {
  protected:
    void start() {
        ASSERT_EQ(executive_.initialize(), Status::kOk);
        ASSERT_EQ(executive_.start(), Status::kOk);
    }
    void attach_and_start() {
        executive_.set_introspection(&sut_);
        start();
    }
    WindowOutcome run_first(std::int64_t frame, std::int64_t late = 0) {
        host_.now = Instant{frame * 1000 + late};
        return executive_.run_window(0U, Instant{frame * 1000}, host_);
    }
    WindowOutcome run_second(std::int64_t frame) {
        host_.now = Instant{frame * 1000 + 500};
        return executive_.run_window(1U, host_);
    }
    CoreSnapshot read_core() {
        CoreSnapshot snapshot{};
        EXPECT_EQ(shown_.read_core(0U, snapshot), Status::kOk);
        return snapshot;
    }
    WindowSnapshot read_window(std::size_t index) {
        WindowSnapshot snapshot{};
        EXPECT_EQ(shown_.read_window(index, snapshot), Status::kOk);
        return snapshot;
    }
    ComponentSnapshot read_component(std::size_t index) {
        ComponentSnapshot snapshot{};
        EXPECT_EQ(shown_.read_component(index, snapshot), Status::kOk);
        return snapshot;
    }
    PortSnapshot read_port(std::size_t index) {
        PortSnapshot snapshot{};
        EXPECT_EQ(shown_.read_port(index, snapshot), Status::kOk);
        return snapshot;
    }

    Counter counter_;
    Relay relay_;
    Taker taker_;
    SystemTable<2U, 3U, 4U, 2U> table_ = system(
        frame(1000_ns), trace_hash(), window("first", 0_ns, 400_ns, budget(300_ns), run(counter_, relay_)),
        window("second", 500_ns, 400_ns, budget(400_ns), run(taker_)),
        connect(counter_.out, relay_.in, fresh_within(100_ns)), connect(relay_.out, taker_.in, any_age()));
    FakeHost host_;
    ExecutiveFor<decltype(table_)> executive_{table_};
    IntrospectionFor<decltype(table_)> sut_{table_};
    const Introspection& shown_{sut_};
};

TEST_F(IntrospectionTest, ACoreShowsItsFrameAndItsTraceHash) {
    verifies("SWR-INS-001");
    attach_and_start();
    run_first(3);
    run_second(3);

    EXPECT_EQ(read_core().frame, 3U);
    EXPECT_EQ(read_core().observed_at, Instant{3500});
    EXPECT_EQ(read_core().trace_hash, executive_.get_trace_hash());
    EXPECT_NE(read_core().trace_hash, TraceHash{}.get_value());
}

TEST_F(IntrospectionTest, AWindowShowsWhatItsLastAndItsWorstCycleUsed) {
    verifies("SWR-INS-001", Technique::kBoundaryValues);
    attach_and_start();
    host_.durations[{0U, FakeHost::Pass::kExecute}] = 200_ns;
    host_.durations[{1U, FakeHost::Pass::kExecute}] = 100_ns;
    EXPECT_EQ(run_first(0), WindowOutcome::kCompleted);
    host_.durations[{0U, FakeHost::Pass::kExecute}] = 30_ns;
    EXPECT_EQ(run_first(1, 50), WindowOutcome::kCompleted);

    const WindowSnapshot window = read_window(0U);

    EXPECT_STREQ(window.name, "first");
    EXPECT_EQ(window.core, 0U);
    EXPECT_EQ(window.observed_at, Instant{1000});
    EXPECT_EQ(window.cycles, 2U);
    EXPECT_EQ(window.overruns, 0U);
    EXPECT_EQ(window.budget, 300_ns);
    EXPECT_EQ(window.worst_used, 300_ns);
    EXPECT_EQ(window.last_used, 130_ns) << "counted from the late opening";
    EXPECT_EQ(window.late_releases, 1U);
    EXPECT_EQ(window.worst_lateness, 50_ns);
    EXPECT_EQ(window.last_outcome, WindowOutcome::kCompleted);
    EXPECT_EQ(window.hanging_component, kNoIndex);
    EXPECT_EQ(read_window(1U).cycles, 0U);
    EXPECT_EQ(run_first(2, 1), WindowOutcome::kCompleted);
    EXPECT_EQ(read_window(0U).late_releases, 2U);
}

TEST_F(IntrospectionTest, AWindowShowsItsOverruns) {
    verifies("SWR-INS-001", Technique::kFaultInjection);
    attach_and_start();
    host_.durations[{1U, FakeHost::Pass::kExecute}] = 301_ns;
    EXPECT_EQ(run_first(0), WindowOutcome::kOverrun);

    EXPECT_EQ(read_window(0U).cycles, 1U);
    EXPECT_EQ(read_window(0U).overruns, 1U);
    EXPECT_EQ(read_window(0U).worst_used, 300_ns) << "the guard cuts it off at the budget";
    EXPECT_EQ(read_window(0U).last_outcome, WindowOutcome::kOverrun);
    EXPECT_EQ(read_component(0U).cycles, 1U);
    EXPECT_EQ(read_component(1U).cycles, 0U) << "it did not come through";
}

TEST_F(IntrospectionTest, AWindowShowsTheComponentThatHangs) {
    verifies("SWR-INS-001", Technique::kFaultInjection);
    attach_and_start();
    host_.hangs[{1U, FakeHost::Pass::kExecute}] = true;
    host_.is_work_out = true;
    EXPECT_EQ(run_first(0), WindowOutcome::kOverrun);

    EXPECT_EQ(read_window(0U).hanging_component, 1U);
    EXPECT_EQ(read_window(1U).hanging_component, kNoIndex);
}

TEST_F(IntrospectionTest, AnOutputShowsThatAFullQueueHasRejectedItsValue) {
    verifies("SWR-INS-001", Technique::kBoundaryValues);
    counter_.out.write(1);
    ASSERT_TRUE(counter_.out.publish(Instant{}));
    counter_.out.note_refused(counter_.out.get_revision());

    executive_.set_introspection(&sut_);

    EXPECT_EQ(read_port(0U).status, PortStatus::kBufferFull);
}

TEST_F(IntrospectionTest, AStoppedWindowShowsThatItIsStoppedAndCountsNoCycle) {
    verifies("SWR-INS-001", Technique::kStateTransition);
    attach_and_start();
    ASSERT_EQ(executive_.get_context(0U).stop(Instant{}), Status::kOk);
    EXPECT_EQ(run_first(0, 10), WindowOutcome::kStopped);

    EXPECT_EQ(read_window(0U).last_outcome, WindowOutcome::kStopped);
    EXPECT_EQ(read_window(0U).cycles, 0U);
    EXPECT_EQ(read_window(0U).late_releases, 0U);
    EXPECT_EQ(read_component(0U).state, LifecycleState::kActive) << "stopping changes no state";
}

TEST_F(IntrospectionTest, AComponentShowsItsStateFromBirthToEnd) {
    verifies("SWR-INS-001", Technique::kStateTransition);
    executive_.set_introspection(&sut_);
    EXPECT_EQ(read_component(0U).state, LifecycleState::kCreated);
    ASSERT_EQ(executive_.initialize(), Status::kOk);
    EXPECT_EQ(read_component(0U).state, LifecycleState::kInactive);
    ASSERT_EQ(executive_.start(), Status::kOk);
    EXPECT_EQ(read_component(0U).state, LifecycleState::kActive);
    ASSERT_EQ(executive_.stop(), Status::kOk);
    EXPECT_EQ(read_component(0U).state, LifecycleState::kInactive);
    ASSERT_EQ(executive_.finalize(), Status::kOk);
    EXPECT_EQ(read_component(0U).state, LifecycleState::kCreated);
    EXPECT_STREQ(read_component(2U).name, "taker");
    EXPECT_EQ(read_component(2U).window, 1U);
}

TEST_F(IntrospectionTest, AnAliveComponentWithoutAContextShowsAsInactive) {
    verifies("SWR-INS-001", Technique::kErrorGuessing);
    ASSERT_EQ(counter_.initialize(), Status::kOk);

    executive_.set_introspection(&sut_);

    EXPECT_EQ(read_component(0U).state, LifecycleState::kInactive);
    EXPECT_EQ(read_component(1U).state, LifecycleState::kCreated);
}

TEST_F(IntrospectionTest, AComponentThatHandsNothingOnShowsItsTimeToo) {
    verifies("SWR-INS-001", Technique::kBoundaryValues);
    SpyObserver observer;
    executive_.set_observer(&observer);
    attach_and_start();
    host_.durations[{2U, FakeHost::Pass::kExecute}] = 40_ns;
    run_second(0);
    host_.durations[{2U, FakeHost::Pass::kExecute}] = 30_ns;
    run_second(1);

    EXPECT_EQ(read_component(2U).worst_used, 40_ns);
}

TEST_F(IntrospectionTest, AComponentShowsItsLastFailureAndCountsItsTurnsInError) {
    verifies("SWR-INS-001", Technique::kFaultInjection);
    attach_and_start();
    counter_.answer = Status::kUnsupported;
    run_first(0);
    run_first(1);

    const ComponentSnapshot component = read_component(0U);

    EXPECT_EQ(component.state, LifecycleState::kError);
    EXPECT_EQ(component.last_failure.status, Status::kUnsupported);
    EXPECT_EQ(component.last_failure.action, ComponentAction::kExecute);
    EXPECT_EQ(component.last_failure.at, Instant{0});
    EXPECT_EQ(component.cycles, 2U);
    EXPECT_EQ(component.observed_at, Instant{1000});
    EXPECT_EQ(read_component(1U).last_failure.status, Status::kOk);
}

TEST_F(IntrospectionTest, AnInactiveComponentCountsNoTurn) {
    verifies("SWR-INS-001", Technique::kEquivalenceClasses);
    attach_and_start();
    ASSERT_EQ(executive_.get_context(0U).deactivate_component(counter_, Instant{}), Status::kOk);
    run_first(0);

    EXPECT_EQ(read_component(0U).cycles, 0U);
    EXPECT_EQ(read_component(1U).cycles, 1U);
}

TEST_F(IntrospectionTest, TheLongestTurnOfAComponentIsKeptWhileAnObserverListens) {
    verifies("SWR-INS-001", Technique::kBoundaryValues);
    attach_and_start();
    host_.durations[{0U, FakeHost::Pass::kExecute}] = 40_ns;
    run_first(0);
    EXPECT_EQ(read_component(0U).worst_used, 0_ns) << "nobody measured";
    SpyObserver observer;
    executive_.set_observer(&observer);
    run_first(1);
    EXPECT_EQ(read_component(0U).worst_used, 40_ns);
    host_.durations[{0U, FakeHost::Pass::kExecute}] = 400_ns;
    run_first(2);
    host_.durations[{0U, FakeHost::Pass::kExecute}] = 1_ns;
    run_first(3);

    EXPECT_EQ(read_component(0U).worst_used, 40_ns) << "one that was cut off shows in the row of its window";
    EXPECT_EQ(read_window(0U).worst_used, 300_ns);
    EXPECT_EQ(observer.heard.size(), 1U) << "the observer still hears of overruns";
}

TEST_F(IntrospectionTest, AnOutputShowsItsSequenceAndWhenItWasPublished) {
    verifies("SWR-INS-001");
    attach_and_start();
    EXPECT_FALSE(read_port(0U).has_value);
    run_first(0);
    run_first(1);

    EXPECT_STREQ(read_port(0U).name, "out");
    EXPECT_EQ(read_port(0U).component, 0U);
    EXPECT_FALSE(read_port(0U).is_input);
    EXPECT_TRUE(read_port(0U).has_value);
    EXPECT_EQ(read_port(0U).sequence, 2U);
    EXPECT_EQ(read_port(0U).published_at, Instant{1400});
    EXPECT_EQ(read_port(0U).calc_age(), Duration{-400}) << "published at the close";
    EXPECT_EQ(read_port(0U).counts.capacity, 0U);
}

TEST_F(IntrospectionTest, AnInputShowsItsAgeAndItsStatus) {
    verifies("SWR-INS-001", Technique::kBoundaryValues);
    attach_and_start();
    EXPECT_EQ(read_port(1U).status, PortStatus::kBufferEmpty);
    run_first(0);
    EXPECT_TRUE(read_port(1U).is_input);
    EXPECT_TRUE(read_port(1U).has_value);
    EXPECT_EQ(read_port(1U).status, PortStatus::kOk);
    EXPECT_EQ(read_port(1U).calc_age(), 0_ns) << "handed on within the window";
    counter_.is_writing = false;
    run_first(1);

    EXPECT_EQ(read_port(1U).published_at, Instant{0});
    EXPECT_EQ(read_port(1U).calc_age(), 1000_ns);
    EXPECT_EQ(read_port(1U).status, PortStatus::kBufferTimeout);
}

TEST_F(IntrospectionTest, AQueueShowsItsHighWaterMarkAndWhatItLost) {
    verifies("SWR-INS-001", Technique::kBoundaryValues);
    attach_and_start();
    taker_.is_reading = false;
    for (std::int64_t frame_number = 0; frame_number < 5; ++frame_number) {
        run_first(frame_number);
    }
    run_second(4);

    EXPECT_TRUE(read_port(3U).has_value);
    EXPECT_EQ(read_port(3U).published_at, Instant{3400}) << "the oldest of the two that wait";
    EXPECT_EQ(read_port(3U).status, PortStatus::kOk);
    const PortCounts queue = read_port(3U).counts;

    EXPECT_EQ(queue.capacity, 2U);
    EXPECT_EQ(queue.high_water_mark, 2U);
    EXPECT_EQ(queue.overwritten, 3U);
    EXPECT_EQ(queue.rejected, 0U);
    EXPECT_EQ(queue.empty_reads, 0U);
    taker_.is_reading = true;
    for (std::int64_t frame_number = 5; frame_number < 8; ++frame_number) {
        run_second(frame_number);
    }
    EXPECT_EQ(read_port(3U).counts.empty_reads, 1U);
}

TEST_F(IntrospectionTest, AWalkVisitsEachRowInOrderWithItsName) {
    verifies("SWR-INS-003");
    attach_and_start();
    run_first(0);
    std::vector<std::string> seen;
    const auto note = [&seen](std::size_t index, const auto& row) {
        seen.push_back(std::to_string(index) + row.name);
    };

    EXPECT_EQ(shown_.for_each_window(note), 0U);
    EXPECT_EQ(shown_.for_each_component(note), 0U);
    EXPECT_EQ(shown_.for_each_port(note), 0U);

    EXPECT_EQ(seen, (std::vector<std::string>{"0first", "1second", "0counter", "1relay", "2taker", "0out",
                                              "1in", "2out", "3in"}));
    EXPECT_EQ(shown_.get_window_count(), 2U);
    EXPECT_EQ(shown_.get_component_count(), 3U);
    EXPECT_EQ(shown_.get_port_count(), 4U);
}

TEST_F(IntrospectionTest, ARowThatNobodyHasWrittenIsRefusedAndCountedByTheWalk) {
    verifies("SWR-INS-003", Technique::kErrorGuessing, Polarity::kViolation);
    WindowSnapshot snapshot{};
    snapshot.cycles = 77U;

    EXPECT_EQ(shown_.read_window(0U, snapshot), Status::kPreconditionNotMet);
    EXPECT_EQ(snapshot.cycles, 77U);
    EXPECT_EQ(shown_.for_each_component([](std::size_t, const ComponentSnapshot&) { FAIL(); }), 3U);
}

TEST_F(IntrospectionTest, ARowThatDoesNotExistIsABadParameter) {
    verifies("SWR-INS-003", Technique::kBoundaryValues, Polarity::kViolation);
    attach_and_start();
    CoreSnapshot core_row{};
    WindowSnapshot window_row{};
    ComponentSnapshot component_row{};
    PortSnapshot port_row{};

    EXPECT_EQ(shown_.read_core(1U, core_row), Status::kBadParameter);
    EXPECT_EQ(shown_.read_window(2U, window_row), Status::kBadParameter);
    EXPECT_EQ(shown_.read_component(3U, component_row), Status::kBadParameter);
    EXPECT_EQ(shown_.read_port(4U, port_row), Status::kBadParameter);
    EXPECT_EQ(shown_.read_port(kNoIndex, port_row), Status::kBadParameter);
    EXPECT_EQ(shown_.read_port(3U, port_row), Status::kOk);
}

/// What a run of three frames leaves behind.
struct Course {
    std::uint64_t trace_hash;
    std::vector<Instant> deadlines;
    Instant end;
};

/// @param[in] is_shown attaches an introspection, and reads all of it after each window.
Course run_three_frames(bool is_shown) {
    Counter counter;
    Relay relay;
    Taker taker;
    const auto table = system(
        frame(1000_ns), trace_hash(), window("first", 0_ns, 400_ns, budget(300_ns), run(counter, relay)),
        window("second", 500_ns, 400_ns, budget(400_ns), run(taker)),
        connect(counter.out, relay.in, fresh_within(100_ns)), connect(relay.out, taker.in, any_age()));
    ExecutiveFor executive{table};
    IntrospectionFor introspection{table};
    const auto ignore = [](std::size_t, const auto&) noexcept {};
    executive.set_introspection(is_shown ? &introspection : nullptr);
    EXPECT_EQ(executive.initialize(), Status::kOk);
    EXPECT_EQ(executive.start(), Status::kOk);
    FakeHost host;
    host.durations[{1U, FakeHost::Pass::kExecute}] = 301_ns;  // overruns
    for (std::int64_t opening : {0, 500, 1000, 1500, 2000, 2500}) {
        host.now = Instant{opening};
        static_cast<void>(executive.run_window(opening % 1000 == 0 ? 0U : 1U, host));
        EXPECT_EQ(introspection.for_each_window(ignore), is_shown ? 0U : 2U);
        EXPECT_EQ(introspection.for_each_component(ignore), is_shown ? 0U : 3U);
        EXPECT_EQ(introspection.for_each_port(ignore), is_shown ? 0U : 4U);
        host.durations.clear();
    }
    return {executive.get_trace_hash(), host.deadlines, host.now};
}

TEST(IntrospectionInfluenceTest, ARunThatIsLookedAtIsTheRunThatNobodySees) {
    verifies("SWR-INS-002", Technique::kBackToBack);
    const Course unseen = run_three_frames(false);
    const Course seen = run_three_frames(true);

    EXPECT_EQ(seen.trace_hash, unseen.trace_hash);
    EXPECT_EQ(seen.deadlines, unseen.deadlines);
    EXPECT_EQ(seen.end, unseen.end);
}

TEST_F(IntrospectionTest, DetachedItKeepsWhatItShowedLast) {
    verifies("SWR-INS-002", Technique::kStateTransition);
    attach_and_start();
    run_first(0);
    executive_.set_introspection(nullptr);
    run_first(1);

    EXPECT_EQ(read_window(0U).observed_at, Instant{0});
    EXPECT_EQ(read_window(0U).cycles, 1U);
}

TEST_F(IntrospectionTest, ARefusedTableShowsNothingWhicheverWindowIsAskedToRun) {
    verifies("SWR-INS-003", Technique::kErrorGuessing, Polarity::kViolation);
    auto table = table_;
    table.frame = 0_ns;
    ExecutiveFor executive{table};
    IntrospectionFor introspection{table};
    const Introspection& shown = introspection;
    executive.set_introspection(&introspection);
    ASSERT_EQ(executive.initialize(), Status::kBadParameter);

    EXPECT_EQ(executive.run_window(0U, Instant{0}, host_), WindowOutcome::kStopped);

    WindowSnapshot window{};
    EXPECT_EQ(shown.read_window(0U, window), Status::kPreconditionNotMet);
    CoreSnapshot core{};
    EXPECT_EQ(shown.read_core(0U, core), Status::kPreconditionNotMet);
}

TEST_F(IntrospectionTest, OneThatBelongsToAnotherTableIsRefused) {
    verifies("SWR-INS-002", Technique::kErrorGuessing, Polarity::kViolation);
    const auto other = table_;
    IntrospectionFor<decltype(table_)> stranger{other};

    EXPECT_CHECK_FAILS(executive_.set_introspection(&stranger), "executive_introspection.cpp", 2);
}

/// Attaches an introspection while its executive is at work.
class Meddler final : public Component {
  public:
    constexpr Meddler() noexcept : Component("meddler") {}
    Executive* executive{nullptr};
    Status on_execute(ContextHandle) noexcept override {
        executive->set_introspection(nullptr);
        return Status::kOk;
    }
};

TEST(IntrospectionAttachTest, AttachingFromWithinAnActionIsAnOwnBug) {
    verifies("SWR-INS-002", Technique::kErrorGuessing, Polarity::kViolation);
    Meddler meddler;
    const auto table = system(frame(1000_ns), window("w", 0_ns, 400_ns, budget(300_ns), run(meddler)));
    ExecutiveFor executive{table};
    meddler.executive = &executive;
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);
    FakeHost host;

    EXPECT_CHECK_FAILS(static_cast<void>(executive.run_window(0U, host)), "executive_introspection.cpp", 1);
}

MAMORI_CONSTINIT Counter g_counter;
constexpr auto kSystem = system(frame(1000_ns), window("w", 0_ns, 400_ns, budget(300_ns), run(g_counter)));
MAMORI_CONSTINIT IntrospectionFor<decltype(kSystem)> g_introspection{kSystem};

TEST(IntrospectionStorageTest, ItIsAConstantOfTheProgramWithTheSizesOfItsTable) {
    verifies("SWR-INS-004", Technique::kInterface);
    EXPECT_EQ(g_introspection.get_window_count(), 1U);
    EXPECT_EQ(g_introspection.get_component_count(), 1U);
    EXPECT_EQ(g_introspection.get_port_count(), 1U);
}

}  // namespace
}  // namespace mamori

// SPDX-License-Identifier: Apache-2.0
// Goal: readers in other threads see whole rows of running cores, and a row of a component whose action hangs
//       is not touched. Method: two executives of one table at full speed on two threads, readers on two
//       others; an action that goes on in a thread of its own. Run under the thread sanitizer too.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

constexpr std::int64_t kFrames = 20'000;

class Source final : public Component {
  public:
    constexpr Source() noexcept : Component("source") {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Source::out>;

    Status on_execute(ContextHandle context) noexcept override {
        out.write(context.now.ns);
        return Status::kOk;
    }
};

class Drain final : public Component {
  public:
    constexpr Drain() noexcept : Component("drain") {}
    QueueInPort<std::int64_t, 4U> in{*this, "in"};
    using Ports = mamori::Ports<&Drain::in>;

    Status on_execute(ContextHandle) noexcept override {
        std::int64_t value = 0;
        static_cast<void>(in.read(value));
        return Status::kOk;
    }
};

/// Time stands at the opening; all work is done at once.
class PlannedHost final : public WindowHost {
  public:
    Instant now{};
    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return now; }
    std::size_t run_within(const Work& work, Instant) noexcept override {
        work.run(work.argument, work.first, work.first + work.count);
        return work.count;
    }
    bool has_returned(std::size_t) const noexcept override { return true; }
};

Source g_source;
Drain g_drain;
constexpr auto kSystem = system(frame(1000_ns), window("source", 0_ns, 400_ns, budget(400_ns), run(g_source)),
                                window("drain", 500_ns, 400_ns, core(1), budget(400_ns), run(g_drain)),
                                connect(g_source.out, g_drain.in, any_age()));
ExecutiveFor<decltype(kSystem)> g_source_core{kSystem};
ExecutiveFor<decltype(kSystem)> g_drain_core{kSystem, 1U};
IntrospectionFor<decltype(kSystem)> g_introspection{kSystem};

/// Runs the only window of a core `kFrames` times.
void run_core(Executive& executive, std::size_t window) {
    PlannedHost host;
    for (std::int64_t i = 0; i < kFrames; ++i) {
        host.now = Instant{i * 1000} + kSystem.windows[window].offset;
        static_cast<void>(executive.run_window(window, host));
    }
}

/// Counts rows that cannot be, and rows that are older than one that was seen before.
struct Judge {
    std::array<std::uint64_t, 2U> last_cycles{};
    std::uint64_t wrong{0U};
    std::uint64_t seen{0U};

    void look() {
        g_introspection.for_each_window([this](std::size_t index, const WindowSnapshot& row) {
            // The number of the cycle is also in the instant, at the other end of the row.
            const Instant opening{(static_cast<std::int64_t>(row.cycles) - 1) * 1000};
            wrong += row.cycles != 0U && row.observed_at != opening + kSystem.windows[index].offset ? 1U : 0U;
            wrong += row.cycles < last_cycles[index] ? 1U : 0U;
            last_cycles[index] = row.cycles;
            ++seen;
        });
        PortSnapshot port{};
        if (g_introspection.read_port(0U, port) == Status::kOk && port.has_value) {
            wrong += port.published_at.ns != (std::int64_t{port.sequence} - 1) * 1000 + 400 ? 1U : 0U;
        }
        if (g_introspection.read_port(1U, port) == Status::kOk) {
            wrong += port.counts.high_water_mark > port.counts.capacity ? 1U : 0U;
        }
    }
};

TEST(IntrospectionStressTest, ReadersOfRunningCoresSeeWholeRowsThatNeverGoBack) {
    verifies("SWR-INS-003", Technique::kErrorGuessing);
    std::atomic<bool> is_done{false};
    std::array<Judge, 2U> judges{};
    for (Executive* core :
         {static_cast<Executive*>(&g_source_core), static_cast<Executive*>(&g_drain_core)}) {
        core->set_introspection(&g_introspection);
        ASSERT_EQ(core->initialize(), Status::kOk);
    }
    ASSERT_EQ(g_source_core.start(), Status::kOk);
    ASSERT_EQ(g_drain_core.start(), Status::kOk);

    std::array<std::thread, 2U> readers;
    for (std::size_t i = 0U; i < readers.size(); ++i) {
        readers[i] = std::thread([&is_done, &judge = judges[i]] {
            while (!is_done.load(std::memory_order_acquire)) {
                judge.look();
            }
        });
    }
    std::thread drain([] { run_core(g_drain_core, 1U); });
    run_core(g_source_core, 0U);
    drain.join();
    is_done.store(true, std::memory_order_release);
    for (std::thread& reader : readers) {
        reader.join();
    }

    for (Judge& judge : judges) {
        judge.look();
        EXPECT_EQ(judge.wrong, 0U);
        EXPECT_GE(judge.seen, 2U);
        EXPECT_EQ(judge.last_cycles[0], static_cast<std::uint64_t>(kFrames));
        EXPECT_EQ(judge.last_cycles[1], static_cast<std::uint64_t>(kFrames));
    }
}

/// Goes on reading and writing its ports until it is let go.
class Endless final : public Component {
  public:
    Endless() noexcept : Component("endless") {}
    QueueInPort<std::int64_t, 4U, FullPolicy::kOverwrite, EmptyPolicy::kReadback, Need::kOptional> in{*this,
                                                                                                      "in"};
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Endless::in, &Endless::out>;
    std::atomic<bool> is_let_go{false};
    std::atomic<std::uint32_t> rounds{0U};

    Status on_execute(ContextHandle) noexcept override {
        while (!is_let_go.load(std::memory_order_acquire)) {
            std::int64_t value = 0;
            static_cast<void>(in.read(value));
            out.write(value);
            rounds.fetch_add(1U, std::memory_order_relaxed);
        }
        return Status::kError;
    }
};

/// Abandons all work on a thread, as a port's guard does.
class AbandoningHost final : public WindowHost {
  public:
    Instant now{};
    std::thread abandoned;
    std::atomic<bool> is_done{false};
    bool has_returned(std::size_t) const noexcept override { return is_done.load(std::memory_order_acquire); }
    Endless& endless;
    explicit AbandoningHost(Endless& component) : endless(component) {}
    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return now; }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        abandoned = std::thread([this, work] {
            work.run(work.argument, work.first, work.first + work.count);
            is_done.store(true, std::memory_order_release);
        });
        while (endless.rounds.load(std::memory_order_relaxed) == 0U) {
        }
        now = deadline;
        return 0U;
    }
};

TEST(IntrospectionStressTest, TheRowsOfAHangingComponentStayAndItsWindowNamesIt) {
    verifies("SWR-INS-005", Technique::kFaultInjection, Polarity::kViolation);
    Endless endless;
    const auto table = system(frame(1000_ns), window("w", 0_ns, 400_ns, budget(300_ns), run(endless)));
    ExecutiveFor executive{table};
    IntrospectionFor sut{table};
    executive.set_introspection(&sut);
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);
    AbandoningHost host{endless};
    EXPECT_EQ(executive.run_window(0U, host), WindowOutcome::kOverrun);
    WindowSnapshot window_row{};
    ComponentSnapshot component_row{};
    PortSnapshot port_row{};
    for (std::int64_t i = 1; i < 1000; ++i) {
        host.now = Instant{i * 1000};
        EXPECT_EQ(executive.run_window(0U, host), WindowOutcome::kOverrun);
    }

    ASSERT_EQ(sut.read_window(0U, window_row), Status::kOk);
    EXPECT_EQ(window_row.hanging_component, 0U);
    EXPECT_EQ(window_row.overruns, 1000U);
    EXPECT_EQ(window_row.observed_at, Instant{999'000});
    ASSERT_EQ(sut.read_component(0U, component_row), Status::kOk);
    EXPECT_EQ(component_row.state, LifecycleState::kActive);
    EXPECT_EQ(component_row.observed_at, Instant{0}) << "as start() left it";
    ASSERT_EQ(sut.read_port(0U, port_row), Status::kOk);
    EXPECT_EQ(port_row.counts.empty_reads, 0U);

    endless.is_let_go.store(true, std::memory_order_release);
    host.abandoned.join();
    ASSERT_EQ(executive.stop(), Status::kOk);
    ASSERT_EQ(sut.read_window(0U, window_row), Status::kOk);
    EXPECT_EQ(window_row.hanging_component, kNoIndex);
    ASSERT_EQ(sut.read_component(0U, component_row), Status::kOk);
    EXPECT_EQ(component_row.state, LifecycleState::kError);
    EXPECT_EQ(component_row.last_failure.status, Status::kError);
    ASSERT_EQ(sut.read_port(0U, port_row), Status::kOk);
    EXPECT_EQ(port_row.counts.empty_reads, endless.rounds.load());
}

TEST(IntrospectionStressTest, WhileNothingHangsRowsFollowEachCycle) {
    verifies("SWR-INS-005");
    Source source;
    const auto table = system(frame(1000_ns), window("w", 0_ns, 400_ns, budget(300_ns), run(source)));
    ExecutiveFor executive{table};
    IntrospectionFor sut{table};
    executive.set_introspection(&sut);
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);
    PlannedHost host;
    ComponentSnapshot row{};

    for (const std::int64_t opening : {1000, 2000}) {
        host.now = Instant{opening};
        static_cast<void>(executive.run_window(0U, host));
        ASSERT_EQ(sut.read_component(0U, row), Status::kOk);
        EXPECT_EQ(row.observed_at, Instant{opening});
    }
}

}  // namespace
}  // namespace mamori

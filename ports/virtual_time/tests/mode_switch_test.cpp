// SPDX-License-Identifier: Apache-2.0
// Goal: a system that switches its modes again and again, on two cores, gives one hash. Method: a component
// that asks for the next mode by its own count, 20 runs, one of them with a component that hangs in a switch.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <utility>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::virtual_time {
namespace {

using namespace verification;

enum class Command { kStart, kTeach };

/// Asks for another mode in each tenth cycle.
class Supervisor final : public Component {
  public:
    Supervisor() noexcept : Component("supervisor") {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Supervisor::out>;

    SystemModes* modes{nullptr};
    std::int64_t cycle_count{0};

    Status on_execute(ContextHandle) noexcept override {
        out.write(static_cast<std::int64_t>(modes->get_mode()));
        if (++cycle_count % 10 == 0) {
            const bool is_odd = cycle_count / 10 % 2 == 1;
            static_cast<void>(modes->request(is_odd ? Command::kTeach : Command::kStart));
        }
        return Status::kOk;
    }
};
/// Adds its step to what it had.
class Source final : public Component {
  public:
    Source(const char* name, std::int64_t step) noexcept : Component(name), step_(step) {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Source::out>;

    Status on_execute(ContextHandle) noexcept override {
        value_ += step_;
        out.write(value_);
        return Status::kOk;
    }

  private:
    std::int64_t step_;
    std::int64_t value_{0};
};
/// Passes on what it reads, scaled, and -1 when there is nothing.
class Drive final : public Component {
  public:
    Drive() noexcept : Component("drive") {}
    InPort<std::int64_t> in{*this, "in"};
    OutPort<double> out{*this, "out"};
    using Ports = mamori::Ports<&Drive::in, &Drive::out>;
    Parameter<double> scale{*this, "scale", 1.0, between(above(0.0), at_most(2.0))};
    using Parameters = mamori::Parameters<&Drive::scale>;

    Status on_execute(ContextHandle) noexcept override {
        out.write(in.has_value() ? scale.get() * static_cast<double>(in.read()) : -1.0);
        return Status::kOk;
    }
};

struct MachineParts {
    Supervisor supervisor;
    Source planner{"planner", 1};
    Source hand{"hand", 1000};
    Drive drive;
    Crossing<std::int64_t> from_planner;
    Crossing<std::int64_t> from_hand;
};
auto make_machine_table(MachineParts& p) {
    return system(frame(1000_ns), trace_hash(),
                  window("ask", 0_ns, 400_ns, budget(400_ns), run(p.supervisor, p.planner, p.hand)),
                  window("act", 400_ns, 400_ns, core(1), budget(400_ns), run(p.drive)),
                  connect(p.planner.out, p.drive.in, through(p.from_planner), any_age()),
                  connect(p.hand.out, p.drive.in, through(p.from_hand), any_age()),
                  configuration_set("fast", assign(p.drive.scale, 2.0)),
                  configuration_set("slow", assign(p.drive.scale, 0.5)),
                  system_mode("work", runs(p.supervisor, p.planner, p.drive), parameters("fast")),
                  system_mode("teach", runs(p.supervisor, p.hand, p.drive), parameters("slow")),
                  safe_mode("halt", runs(p.supervisor)), mode_transition("work", Command::kTeach, "teach"),
                  mode_transition("teach", Command::kStart, "work"));
}
struct Machine : MachineParts {
    using Table = decltype(make_machine_table(std::declval<MachineParts&>()));

    Table table{make_machine_table(*this)};
    SystemModes modes{make_view(table)};
    ExecutiveFor<Table> ask{table, modes};
    ExecutiveFor<Table> act{table, modes, 1U};
    VirtualHostFor<Table> ask_host{table};
    VirtualHostFor<Table> act_host{table};
    std::array<SimulatedCore, 2U> cores{{{ask, ask_host}, {act, act_host}}};
    NoDevices devices;
    FrameRunner runner{cores, devices};

    Machine() {
        supervisor.modes = &modes;
        for (Executive* core : {static_cast<Executive*>(&ask), static_cast<Executive*>(&act)}) {
            EXPECT_EQ(core->initialize(), Status::kOk);
        }
        EXPECT_EQ(ask.start(), Status::kOk);
        EXPECT_EQ(act.start(), Status::kOk);
    }
    void run_frames(int count) {
        for (int i = 0; i < count; ++i) {
            runner.run_frame();
        }
    }
    std::pair<std::uint64_t, std::uint64_t> get_hash() const {
        return {ask.get_trace_hash(), act.get_trace_hash()};
    }
};

TEST(ModeSwitchTest, TwentyRunsOfAHundredSwitchesGiveOneHash) {
    verifies("SWR-MOD-006", Technique::kStateTransition);
    std::set<std::pair<std::uint64_t, std::uint64_t>> hashes;
    for (int run = 0; run < 20; ++run) {
        Machine machine;
        machine.run_frames(1000);

        EXPECT_EQ(machine.modes.get_failure().cause, ModeFailureCause::kNone);
        EXPECT_EQ(machine.supervisor.cycle_count, 1000);
        hashes.insert(machine.get_hash());
    }
    EXPECT_EQ(hashes.size(), 1U);
}

TEST(ModeSwitchTest, TwentyRunsWithAComponentThatHangsInASwitchGiveOneHashAndEndSafe) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    std::set<std::pair<std::uint64_t, std::uint64_t>> hashes;
    for (int run = 0; run < 20; ++run) {
        Machine machine;
        machine.run_frames(100);
        ASSERT_EQ(machine.ask_host.set_duration(machine.hand, kNever), Status::kOk);
        machine.run_frames(30);

        EXPECT_EQ(machine.modes.get_mode(), 2U);
        EXPECT_EQ(machine.modes.get_failure().cause, ModeFailureCause::kOverrun);
        EXPECT_EQ(machine.modes.get_failure().component, 2U);
        hashes.insert(machine.get_hash());
    }
    EXPECT_EQ(hashes.size(), 1U);
}

}  // namespace
}  // namespace mamori::ports::virtual_time

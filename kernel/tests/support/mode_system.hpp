// SPDX-License-Identifier: Apache-2.0
/// @file
/// A small robot with modes on two cores, whose components can be told to refuse, to take too long or to hang
/// when a switch of modes calls them, and a host on which an action that hangs really does so.
#ifndef MAMORI_KERNEL_TESTS_MODE_SYSTEM_HPP
#define MAMORI_KERNEL_TESTS_MODE_SYSTEM_HPP

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "support/interleaving.hpp"

namespace mamori::testing_support {

enum class RobotMode { kIdle, kWork, kTeach, kHalt };
enum class Command { kStart, kTeach, kStop, kNobodys };
enum class Trouble { kNone, kRefusal, kDelay, kHang };

/// Where and how one component misbehaves, once.
struct TroublePlan {
    const Component* component{nullptr};
    bool is_entering{false};  ///< in on_activated, else in on_deactivated
    Trouble trouble{Trouble::kNone};
    Duration delay{1'000'000};  ///< of kDelay; far more than any budget here
};

/// Work that may hang has a stack of its own, so that it can stay where it hangs.
class ModeHost final : public WindowHost {
  public:
    enum class Aside { kNothing, kModeSteps, kEverything };

    Aside aside{Aside::kModeSteps};  ///< what has a stack of its own; with threads of one's own: nothing
    Instant now{};
    Duration extra{};  ///< what the work that runs now takes
    std::vector<std::unique_ptr<Side>> hanging;
    std::set<std::size_t> windows_out;  ///< whose work hangs

    bool has_returned(std::size_t window) const noexcept override { return windows_out.count(window) == 0U; }
    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return now + extra; }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        for (std::size_t i = 0U; i < work.count; ++i) {
            bool has_returned = true;
            if (aside == Aside::kEverything || (aside == Aside::kModeSteps && work.pass == Pass::kModeStep)) {
                auto side = std::make_unique<Side>();
                side->begin([&work, i] { work.run(work.argument, work.first + i, work.first + i + 1U); });
                has_returned = side->is_done();
                if (!has_returned) {
                    hanging.push_back(std::move(side));
                    windows_out.insert(work.window);
                }
            } else {
                work.run(work.argument, work.first + i, work.first + i + 1U);
            }
            const Instant end = now + extra;
            extra = Duration{0};
            now = has_returned && end <= deadline ? end : (deadline > now ? deadline : now);
            if (!has_returned || end > deadline) {
                return i;
            }
        }
        return work.count;
    }
    /// What hangs goes on to its end.
    void release_hanging() {
        for (const auto& side : hanging) {
            side->resume();
        }
        hanging.clear();
        windows_out.clear();
    }
};

/// A component that writes 1000 * id + its cycle count into its output.
class Part final : public Component {
  public:
    Part(const char* name, std::int64_t id, ModeHost& host, const TroublePlan& plan) noexcept
        : Component(name), id_(id), host_(host), plan_(plan) {}

    InPort<std::int64_t, Need::kOptional> in{*this, "in"};
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Part::in, &Part::out>;
    Parameter<double> speed{*this, "speed", 1.0, between(0.1, 3.0)};
    using Parameters = mamori::Parameters<&Part::speed>;

    std::vector<double> speeds;       ///< in each cycle
    std::vector<std::int64_t> reads;  ///< in each cycle; -1: there was no value
    double speed_at_start{0.0};       ///< in on_activated
    double speed_at_birth{0.0};       ///< in on_initialize
    std::int64_t cycle_count{0};
    Duration cycle_time{};
    bool hangs_in_cycle{false};  ///< for a host with Aside::kEverything

    Status on_initialize() noexcept override {
        speed_at_birth = speed.get();
        return Status::kOk;
    }
    Status on_activated(ContextHandle) noexcept override {
        speed_at_start = speed.get();
        return act(true);
    }
    Status on_deactivated(ContextHandle) noexcept override {
        out.write(-id_);  // must never be seen
        return act(false);
    }
    Status on_execute(ContextHandle) noexcept override {
        speeds.push_back(speed.get());
        reads.push_back(in.has_value() ? in.read() : -1);
        out.write(1000 * id_ + ++cycle_count);
        host_.extra = cycle_time;
        if (hangs_in_cycle) {
            step();
        }
        return Status::kOk;
    }

  private:
    Status act(bool is_entering) noexcept {
        if (plan_.component != this || plan_.is_entering != is_entering) {
            return Status::kOk;
        }
        switch (plan_.trouble) {
            case Trouble::kRefusal:
                return Status::kError;
            case Trouble::kDelay:
                host_.extra = plan_.delay;
                return Status::kOk;
            case Trouble::kHang:
                step();
                return Status::kOk;
            case Trouble::kNone:
                break;
        }
        return Status::kOk;
    }

    std::int64_t id_;
    ModeHost& host_;
    const TroublePlan& plan_;
};

/// A table whose type does not tell that it has modes, as that of a tool may be: only the rows do.
template <typename Table>
struct Untold : Table {
    static constexpr bool kNeedsModes = false;
};

/// Writes down the steps and failures that one core tells of.
class ModeObserver final : public ExecutionObserver {
  public:
    struct Step {
        ModeStep step;
        std::size_t index;
        std::int64_t frame;
        bool operator==(const Step& other) const {
            return step == other.step && index == other.index && frame == other.frame;
        }
    };
    std::vector<Step> steps;
    std::vector<ModeFailure> failures;
    std::vector<ConfigurationFinding> refused_sets;
    std::vector<std::size_t> overruns;

    void on_budget_overrun(std::size_t, std::size_t component, Instant) noexcept override {
        overruns.push_back(component);
    }
    void on_late_release(std::size_t, Duration, Instant) noexcept override {}
    void on_mode_step(ModeStep step, std::size_t index, Instant now) noexcept override {
        steps.push_back({step, index, now.ns / 1000});
    }
    void on_mode_failure(const ModeFailure& failure, Instant) noexcept override {
        failures.push_back(failure);
    }
    void on_configuration_refused(const ConfigurationFinding& finding, Instant) noexcept override {
        refused_sets.push_back(finding);
    }
};

/// Modes of the robot, in the order of its table.
inline constexpr std::size_t kIdle = 0U;
inline constexpr std::size_t kWork = 1U;
inline constexpr std::size_t kTeach = 2U;
inline constexpr std::size_t kHalt = 3U;

/// Core 0 plans and watches from 0 to 400 ns, core 1 acts from 400 to 900 ns of each frame of 1000 ns.
struct RobotParts {
    TroublePlan plan{};
    std::array<ModeHost, 2U> hosts;
    Part monitor{"monitor", 1, hosts[0], plan};
    Part planner{"planner", 2, hosts[0], plan};
    Part viewer{"viewer", 3, hosts[0], plan};
    Part hand{"hand", 4, hosts[1], plan};
    Part drive{"drive", 5, hosts[1], plan};
    Part guard{"guard", 6, hosts[1], plan};
    Crossing<std::int64_t> to_drive;
    Crossing<std::int64_t> to_viewer;
};

inline auto make_robot_table(RobotParts& p) {
    return system(
        frame(1000_ns), window("plan", 0_ns, 400_ns, budget(300_ns), run(p.monitor, p.planner, p.viewer)),
        window("act", 400_ns, 500_ns, core(1), budget(400_ns), run(p.hand, p.drive, p.guard)),
        connect(p.planner.out, p.drive.in, through(p.to_drive), any_age()),
        connect(p.hand.out, p.drive.in, any_age()),
        connect(p.drive.out, p.viewer.in, through(p.to_viewer), only_in("work"), any_age()),
        configuration_set("slow", assign(p.drive.speed, 0.5), assign(p.planner.speed, 0.5)),
        configuration_set("fast", assign(p.drive.speed, 2.0), assign(p.planner.speed, 2.0)),
        system_mode<RobotMode::kIdle>("idle", runs(p.monitor, p.guard)),
        system_mode<RobotMode::kWork>("work", runs(p.monitor, p.guard, p.planner, p.drive, p.viewer),
                                      parameters("fast")),
        system_mode<RobotMode::kTeach>("teach", runs(p.monitor, p.guard, p.hand, p.drive, p.viewer),
                                       parameters("slow")),
        safe_mode<RobotMode::kHalt>("halt", runs(p.monitor, p.guard)),
        mode_transition("idle", Command::kStart, "work"), mode_transition("idle", Command::kTeach, "teach"),
        mode_transition("work", Command::kTeach, "teach"), mode_transition("work", Command::kStop, "idle"),
        mode_transition("teach", Command::kStart, "work"), mode_transition("teach", Command::kStop, "idle"));
}

struct Robot : RobotParts {
    using Table = decltype(make_robot_table(std::declval<RobotParts&>()));

    Table table{make_robot_table(*this)};
    SystemModes modes{make_view(table)};
    ExecutiveFor<Table> core_0{table, modes};
    ExecutiveFor<Table> core_1{table, modes, 1U};
    std::array<Executive*, 2U> cores{{&core_0, &core_1}};
    std::array<ModeObserver, 2U> observers;
    std::array<std::int64_t, 2U> frames{};  ///< next one of each core

    Robot() {
        for (std::size_t core = 0U; core < 2U; ++core) {
            cores[core]->set_observer(&observers[core]);
        }
    }
    bool start() {
        bool is_started = true;
        for (Executive* core : cores) {
            is_started = is_started && core->start() == Status::kOk;
        }
        return is_started;
    }
    bool begin() {
        bool is_ready = true;
        for (Executive* core : cores) {
            is_ready = is_ready && core->initialize() == Status::kOk;
        }
        return is_ready && start();
    }
    WindowOutcome run_core(std::size_t core) {
        const Instant release{frames[core]++ * 1000 + (core == 0U ? 0 : 400)};
        hosts[core].now = release;
        return cores[core]->run_window(core, release, hosts[core]);
    }
    /// The core sleeps through one of its frames.
    void miss_frame(std::size_t core) { ++frames[core]; }
    void run_frames(std::int64_t count) {
        for (std::int64_t i = 0; i < count; ++i) {
            static_cast<void>(run_core(0U));
            static_cast<void>(run_core(1U));
        }
    }
    LifecycleState get_state(const Part& part) {
        for (std::size_t core = 0U; core < 2U; ++core) {
            const auto state = cores[core]->get_context(core).get_component_state(part);
            if (state.has_value()) {
                return state.get_value();
            }
        }
        return LifecycleState::kCreated;
    }
    /// Names of the Active components, in the order of the table.
    std::string get_active() {
        std::string names;
        for (const Part* part : {&monitor, &planner, &viewer, &hand, &drive, &guard}) {
            names += get_state(*part) == LifecycleState::kActive ? std::string(part->get_name()) + " " : "";
        }
        return names;
    }
};

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_MODE_SYSTEM_HPP

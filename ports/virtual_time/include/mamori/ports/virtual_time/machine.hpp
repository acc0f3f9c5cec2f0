// SPDX-License-Identifier: Apache-2.0
/// @file
/// A complete system in virtual time: checks the table and owns executives, modes and simulated cores.
///
///     static mamori::ports::virtual_time::Machine<kSystem> machine;
///     int main() { return machine.run(20U, print) == mamori::Status::kOk ? 0 : 1; }
///
/// The same program runs in real time with mamori::ports::posix_rt::Machine.
///
/// @satisfies SWR-VTM-006, SWR-VTM-015      Design: docs/design/kernel.md#machine
#ifndef MAMORI_PORTS_VIRTUAL_TIME_MACHINE_HPP
#define MAMORI_PORTS_VIRTUAL_TIME_MACHINE_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include "mamori/kernel/run/action_guard.hpp"
#include "mamori/kernel/run/devices.hpp"
#include "mamori/kernel/run/executives.hpp"
#include "mamori/kernel/system/system_rules.hpp"
#include "mamori/kernel/table/action_budget.hpp"
#include "mamori/kernel/table/table_index.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"

namespace mamori::ports::virtual_time {

/// First action outside windows that exceeded its budget.
struct ActionOverrun {
    std::size_t component{kNoIndex};  ///< index in the system table; kNoIndex: none
    ComponentAction action{ComponentAction::kInitialize};
};

/// Guard of one core that keeps the first overrun of all cores.
class MachineGuard final : public ActionGuard {
  public:
    /// @param[in] overrun of all guards of the machine; both references must outlive this object.
    constexpr MachineGuard(VirtualHost& host, Duration budget, ActionOverrun& overrun) noexcept
        : ActionGuard(host, budget), overrun_(overrun) {}

  private:
    void on_action_overrun(std::size_t component, ComponentAction action) noexcept override {
        if (overrun_.component == kNoIndex) {
            overrun_ = {component, action};
        }
    }

    ActionOverrun& overrun_;
};

/// Part of a machine that does not depend on its table. Users construct a Machine.
///
/// Thread safety: request_stop() from any thread or signal handler; all other functions from one thread.
/// Time:          a run calculates its major frames without waiting. Memory: no heap.
class MachineBase {
  public:
    MachineBase(const MachineBase&) = delete;
    MachineBase& operator=(const MachineBase&) = delete;

    /// The current run ends after its current major frame. Between two runs: the next run has no frame. One
    /// store, async-signal-safe.
    void request_stop() noexcept { is_stop_wanted_.store(true, std::memory_order_relaxed); }

    /// Number of the next major frame: frames of all runs so far.
    std::uint64_t get_frame_count() const noexcept { return frame_count_; }
    /// Of the last run: the action that exceeded the action_budget() of the table.
    const ActionOverrun& get_action_overrun() const noexcept { return overrun_; }
    /// Windows of all runs that ended with WindowOutcome::kOverrun.
    std::uint64_t get_overrun_count() const noexcept { return overrun_count_; }

  protected:
    static constexpr std::uint64_t kAllFrames = std::numeric_limits<std::uint64_t>::max();

    constexpr MachineBase() noexcept = default;
    ~MachineBase() = default;

    Status run(ExecutiveGroup& executives, Span<SimulatedCore> cores, Span<ActionGuard* const> guards,
               std::uint64_t frames, Devices& devices) noexcept;
    ActionOverrun& get_overrun() noexcept { return overrun_; }

  private:
    ActionOverrun overrun_{};
    std::uint64_t frame_count_{0U};
    std::uint64_t overrun_count_{0U};
    std::atomic<bool> is_stop_wanted_{false};
};

namespace detail {
template <const auto& kTable, std::size_t kCore>
struct HostSlot {
    VirtualHostFor<mamori::detail::TableType<kTable>> host{kTable};
};
}  // namespace detail

template <const auto& kTable,
          typename Cores = std::make_index_sequence<mamori::detail::count_cores(make_view(kTable))>>
class Machine;

/// @tparam kTable constexpr system table of static storage duration. A violated rule is named by the compiler
///                as MAMORI_CHECK names it.
template <const auto& kTable, std::size_t... kCores>
class Machine<kTable, std::index_sequence<kCores...>> final : public MachineBase,
                                                              private detail::HostSlot<kTable, kCores>... {
    static_assert(mamori::detail::keeps_rules<kTable>(), "the system table violates the rule named above");

  public:
    constexpr Machine() noexcept = default;

    /// Starts the system, runs `frames` major frames, and stops the system. A later call continues with the
    /// next frame. @param[in] frames any; each run ends with the time line after 292 years.
    /// @return kOk; else the first failure of ExecutiveGroup::start(), with which no frame runs, or of
    ///         ExecutiveGroup::stop(); kError as well when an action outside windows exceeds its budget.
    Status run(std::uint64_t frames, Devices& devices) noexcept {
        std::array<SimulatedCore, sizeof...(kCores)> cores{
            SimulatedCore{executives_.get(kCores), get_host_of<kCores>()}...};
        constexpr Duration kBudget = choose_action_budget(kTable.action_budgets);
        std::array<MachineGuard, sizeof...(kCores)> guards{
            MachineGuard{get_host_of<kCores>(), kBudget, get_overrun()}...};
        const std::array<ActionGuard*, sizeof...(kCores)> pointers{&guards[kCores]...};
        return MachineBase::run(executives_, cores, pointers, frames, devices);
    }
    /// Runs until request_stop().
    Status run(Devices& devices) noexcept { return run(kAllFrames, devices); }
    /// The same without devices.
    Status run(std::uint64_t frames = kAllFrames) noexcept {
        NoDevices devices;
        return run(frames, devices);
    }
    /// Calls `after_frame` with the number of each major frame after its last window.
    template <typename Action, typename = std::enable_if_t<std::is_invocable_v<Action&, std::uint64_t>>>
    Status run(std::uint64_t frames, Action after_frame) noexcept {
        AfterFrame<Action> devices{after_frame};
        return run(frames, devices);
    }

    /// Executives and modes of the system.
    constexpr Executives<kTable>& get_executives() noexcept { return executives_; }
    /// Simulated host of a core, to change modelled execution times. @tparam kCore core of the table.
    template <std::size_t kCore = 0U>
    constexpr VirtualHost& get_host_of() noexcept {
        return static_cast<detail::HostSlot<kTable, kCore>&>(*this).host;
    }

  private:
    Executives<kTable> executives_;
};

}  // namespace mamori::ports::virtual_time

#endif  // MAMORI_PORTS_VIRTUAL_TIME_MACHINE_HPP

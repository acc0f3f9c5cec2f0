// SPDX-License-Identifier: Apache-2.0
/// @file
/// Executes the windows of one core. At window start, the executive latches the inputs. It then runs the
/// components in table order within the budget, which the platform port enforces, and forwards written values
/// to later components. At window end, it publishes the outputs.
///
/// @satisfies SWR-KRN-021, SWR-KRN-022, SWR-KRN-024, SWR-KRN-050, SWR-KRN-091, SWR-MOD-008
/// Design:   docs/design/kernel.md#parts-of-the-executive
#ifndef MAMORI_KERNEL_EXECUTIVE_HPP
#define MAMORI_KERNEL_EXECUTIVE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/window_host.hpp"
#include "mamori/kernel/run/detail/core_state.hpp"
#include "mamori/kernel/run/detail/data_flow.hpp"
#include "mamori/kernel/run/detail/mode_follower.hpp"
#include "mamori/kernel/run/detail/system_life.hpp"
#include "mamori/kernel/run/detail/window_runner.hpp"
#include "mamori/kernel/run/execution_observer.hpp"
#include "mamori/kernel/run/system_modes.hpp"
#include "mamori/kernel/run/window_outcome.hpp"
#include "mamori/kernel/table/checked_table.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

class ActionGuard;
class Introspection;

/// Size-free executive of one core; instantiate ExecutiveFor.
///
/// Operations called from within an action of a component or from the observer are rejected; running a window
/// from there is a contract violation.
///
/// Thread safety: none; one executive per core, called from the context that runs its windows.
/// Time:          O(components + connections + ports) per window, and the parameters of a set that becomes
///                active there; initialize() checks the table as check() does. Nothing blocks beyond actions
///                and platform host.
/// Memory:        no heap; refers to the table.
class Executive {
  public:
    Executive(const Executive&) = delete;
    Executive& operator=(const Executive&) = delete;

    /// Initialises every component of its core that is not alive yet and attaches it to the context of its
    /// window, in table order. Before that, every value of every set is checked, and the parameters get the
    /// values of the first mode or initial set. After a failure no context is attached, and a second call
    /// continues where the first ended.
    /// @return kOk; kPreconditionNotMet (done before, called from an action, or the table has modes or sets
    ///         but the executive no SystemModes); kBadParameter (the table violates a rule, see check_all(),
    ///         a parameter of any core is invalid, a value of a set is rejected, with no parameter changed, a
    ///         component participates elsewhere, or the SystemModes is that of another table or cannot serve
    ///         this core); either of them as
    ///         ExecutionContext::attach() specifies for a state machine; else the code of the on_initialize
    ///         that failed.
    Status initialize() noexcept;

    /// Empties every input of its core, with queues and buffers before it: only values that are published
    /// from then on reach the inputs. Then starts every context and activates every component that the
    /// current mode runs, in table order. After a failure everything is stopped again, as by stop().
    /// Initialise the executives of all cores before a start. No other executive of the table may be in
    /// initialize() or finalize() meanwhile.
    /// @return kOk; kPreconditionNotMet (not initialised, a component of any core has no context since its
    ///         core has no initialised executive, see get_failed_component(), a context is running, a
    ///         component is not alive, in Error or Active already, other cores are switching modes, or called
    ///         from an action);
    ///         kBadParameter (a value is rejected of the current set, or of a requested one: that request is
    ///         discarded then); else the code of the on_startup or on_activated that failed.
    Status start() noexcept;

    /// Deactivates every Active component and stops every running context, in reverse order. A context whose
    /// work hangs runs no further cycle: it is stopped at the next start of its window after the work has
    /// returned, or by another call.
    /// @return kOk; kPreconditionNotMet (not initialised, or called from an action); else the first failure:
    ///         the code of an on_deactivated or on_shutdown, which prevents no other stop, or
    ///         kPreconditionNotMet (the work of a context hangs: the others are stopped).
    Status stop() noexcept;

    /// Releases the components of every context and finalizes them, in reverse order; initialize() may
    /// follow.
    /// @return kOk; kPreconditionNotMet (not initialised, a context is running, a component is Active, or
    ///         called from an action); else the code of the first on_finalize that failed: all are finalized
    ///         anyway.
    Status finalize() noexcept;

    /// @name The same, with each action called under the budget of `guard`. An action that exceeds its budget
    /// makes the operation fail with kError, unless it failed before: no further action of the same window is
    /// called in this operation, and the observer receives on_budget_overrun(). While the action hangs,
    /// initialize(), start() and finalize() with and without guard return kPreconditionNotMet.
    /// @{
    Status initialize(ActionGuard& guard) noexcept;
    Status start(ActionGuard& guard) noexcept;
    Status stop(ActionGuard& guard) noexcept;
    Status finalize(ActionGuard& guard) noexcept;
    /// @}

    /// Runs window `index` once. Actions and publications carry the planned instants, not the measured ones,
    /// so a late release changes no data.
    /// @param[in] index   0 .. get_view().windows.size() - 1, a window of this core; else a contract
    ///                    violation.
    /// @param[in] release planned window start, >= 0; after host.get_now() is a contract violation.
    /// @param[in] host    clock and budget guard; work that it aborts may still run after this returns, so it
    ///                    must outlive that. The next window start and stop() query whether it has returned.
    /// @return the end of the window instance; kStopped, kNotDue and kMissed ran no cycle.
    WindowOutcome run_window(std::size_t index, Instant release, WindowHost& host) noexcept;
    /// The same for a host that releases windows exactly: the planned window start is now.
    WindowOutcome run_window(std::size_t index, WindowHost& host) noexcept {
        return run_window(index, host.get_now(), host);
    }

    /// Context of window `index`, to activate, deactivate or reset a single component or to set the rate.
    /// That of a window of another core has no participants.
    /// @param[in] index 0 .. get_view().windows.size() - 1; out of range is a contract violation.
    ExecutionContext& get_context(std::size_t index) noexcept {
        return life_.get_core().windows[index].context;
    }
    /// The table that the executive runs.
    const SystemView& get_view() const noexcept { return life_.get_core().view; }
    /// Core whose windows it runs, as WindowRow::core.
    std::size_t get_core() const noexcept { return life_.get_core().core; }
    /// Component whose failure ended the last initialize() or start(), or which has an invalid parameter; the
    /// first of its window if a context could not take its participants; the first one without a context;
    /// kNoIndex if no component failed.
    std::size_t get_failed_component() const noexcept { return life_.get_failed_component(); }

    /// @param[in] observer observes the execution, or nullptr; must outlive the executive, or be replaced
    ///            before. Its records are read here, once: none, or at least one for each component of the
    ///            table, else a contract violation. Not to be called from within an action or from the
    ///            observer (contract violation).
    void set_observer(ExecutionObserver* observer) noexcept;
    /// Shows the execution to tools from now on: at the end of each window instance, and after initialize(),
    /// start(), stop() and finalize(). A table that violates a rule shows nothing. No hash and no window
    /// depends on it.
    /// @param[in] introspection of the same table, else a contract violation; or nullptr; must outlive the
    ///            executive, or be replaced before. Not to be called from within an action or from the
    ///            observer (contract violation).
    void set_introspection(Introspection* introspection) noexcept;
    /// Hash of every publication so far: port row, sequence, instant and value. A table without trace_hash()
    /// is a contract violation, because every comparison of its hashes would succeed.
    std::uint64_t get_trace_hash() const noexcept {
        MAMORI_REQUIRE(1, get_view().has_trace_hash);
        return life_.get_data_flow().get_trace_hash();
    }

  protected:
    constexpr Executive(const detail::CoreState& core, SystemModes* modes) noexcept : life_(core, modes) {}
    ~Executive() = default;

  private:
    void begin_frame(Instant release) noexcept;
    void begin_operation(ActionGuard& guard) noexcept;
    void end_operation() noexcept;
    void show_windows() noexcept;

    detail::SystemLife life_;  ///< contains the other parts
    bool is_busy_{false};      ///< an operation or a window is in progress: no other one may begin
};

namespace detail {
/// Base so that the states exist before the executive that refers to them.
template <std::size_t kCount>
struct WindowStorage {
    std::array<WindowState, kCount> windows{};
};
}  // namespace detail

/// Executive with the storage that `Table` needs:  inline mamori::ExecutiveFor executive{kSystem};
/// A table with modes or configuration sets also needs a SystemModes. If it is missing, the compiler rejects
/// the executive if the type of the table shows the need, else initialize() does.
template <typename Table>
class ExecutiveFor final : private detail::WindowStorage<Table::kWindowCount>, public Executive {
    using Storage = detail::WindowStorage<Table::kWindowCount>;

  public:
    /// @param[in] table must outlive the executive; check it with MAMORI_CHECK.
    /// @param[in] core  core whose windows it runs, below kModeCoreMax with a SystemModes. Each core of a
    ///                  system has its own executive.
    constexpr explicit ExecutiveFor(const Table& table, std::size_t core = 0U) noexcept
        : Executive({make_view(table), Storage::windows, core, {}}, nullptr) {
        require_no_modes();
    }
    /// @param[in] system_modes one for all cores of the table; must outlive the executive.
    constexpr ExecutiveFor(const Table& table, SystemModes& system_modes, std::size_t core = 0U) noexcept
        : Executive({make_view(table), Storage::windows, core, {}}, &system_modes) {}
    /// The same with a table that the compiler has checked: what the table does not need is not linked.
    template <const auto& kTable>
    constexpr explicit ExecutiveFor(CheckedTable<kTable>, std::size_t core = 0U) noexcept
        : Executive({make_view(kTable), Storage::windows, core, get_parts<kTable>()}, nullptr) {
        require_no_modes();
    }
    template <const auto& kTable>
    constexpr ExecutiveFor(CheckedTable<kTable>, SystemModes& system_modes, std::size_t core = 0U) noexcept
        : Executive({make_view(kTable), Storage::windows, core, get_parts<kTable>()}, &system_modes) {}
    explicit ExecutiveFor(const Table&& table, SystemModes& system_modes, std::size_t core = 0U) = delete;
    explicit ExecutiveFor(const Table&& table, std::size_t core = 0U) = delete;

  private:
    template <const auto& kTable>
    static constexpr detail::ExecutionParts get_parts() noexcept {
        static_assert(std::is_same_v<typename CheckedTable<kTable>::Table, Table>,
                      "the storage of the executive is that of another table");
        constexpr detail::ExecutionParts kParts = detail::choose_parts(make_view(kTable));
        return kParts;
    }

    static constexpr void require_no_modes() noexcept {
        static_assert(!Table::kNeedsModes,
                      "a table with modes or configuration sets needs a SystemModes: write "
                      "SystemModes modes{make_view(kSystem)}; ExecutiveFor executive{kSystem, modes};");
    }
};
template <const auto& kTable>
ExecutiveFor(CheckedTable<kTable>, std::size_t = 0U) -> ExecutiveFor<typename CheckedTable<kTable>::Table>;
template <const auto& kTable>
ExecutiveFor(CheckedTable<kTable>, SystemModes&, std::size_t = 0U)
    -> ExecutiveFor<typename CheckedTable<kTable>::Table>;

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTIVE_HPP

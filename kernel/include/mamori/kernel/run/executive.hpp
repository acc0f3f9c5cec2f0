// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs the windows of a system table: latches inputs when a window opens, runs its components in order under
/// a budget that the port enforces, hands values on within the window, and publishes outputs when it closes.
///
/// @satisfies SWR-KRN-021, SWR-KRN-022, SWR-KRN-023, SWR-KRN-024, SWR-KRN-026, SWR-KRN-032, SWR-KRN-033
/// @satisfies SWR-KRN-034, SWR-KRN-039, SWR-MOD-008, SWR-MOD-009
/// Design:   docs/design/kernel.md#windows, docs/design/modes.md#the-switch
#ifndef MAMORI_KERNEL_EXECUTIVE_HPP
#define MAMORI_KERNEL_EXECUTIVE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/window_host.hpp"
#include "mamori/kernel/payload/trace_hash.hpp"
#include "mamori/kernel/run/execution_observer.hpp"
#include "mamori/kernel/run/system_modes.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

/// How a window ended.
enum class WindowOutcome : std::uint8_t {
    kCompleted,  ///< every component came through both passes; outputs are published
    kOverrun,    ///< the budget ran out, or earlier work still hangs; no output of this window is published
    kMissed,     ///< it opened after its planned close; nothing ran, and no component is to blame
    kStopped,    ///< the context is Stopped; no cycle ran, at most what stop() had to leave for later
    kNotDue,     ///< no cycle in this opening: a slower rate leaves it out, or no tick has come
};

class Executive;
class Introspection;

namespace detail {
/// What the executive keeps for each window while the system runs.
struct WindowState {
    ExecutionContext context{};
    Executive* executive{nullptr};  ///< work reaches its executive through it
    std::size_t window{0U};
    Instant release{};                      ///< planned, of the opening; work that hangs keeps seeing its own
    WindowHost::Work first_pass{};          ///< the same in every cycle, see Executive::prepare_work()
    ExecutionContext::Follower follower{};  ///< of the cycle that runs or ran last
    bool is_followed{false};                ///< in the first pass, step by step
    bool is_stop_due{false};                ///< stop() could not: its work was out
    const WindowHost* cut_by{nullptr};      ///< has cut off work of this window that may not have come back
    Instant crossed_at{std::numeric_limits<std::int64_t>::max()};  ///< frame boundary that it crossed last
    ModeMask held_modes{0U};       ///< connections that hold in all of them are served
    std::size_t set{kNoIndex};     ///< that becomes active at its next boundary
    ModePlan prepared{};           ///< plan whose connections it has
    ModePlan done{};               ///< plan whose components it has activated or deactivated
    std::size_t next_leaving{0U};  ///< position of the component that this plan looks at next
};
}  // namespace detail

/// Size-free executive of one core; instantiate ExecutiveFor.
///
/// Operations called from within an action of a component or from the observer are refused; running a window
/// from there is an own bug.
///
/// Thread safety: none; one executive per core, called from the context that runs its windows.
/// Time:          O(components + connections + ports) per window, and the parameters of a set that is
///                switched there; initialize() judges the table as check() does. Nothing blocks beyond
///                actions and host.
/// Memory:        no heap; refers to the table.
class Executive {
  public:
    Executive(const Executive&) = delete;
    Executive& operator=(const Executive&) = delete;

    /// Initialises every component of its core that is not alive yet and attaches it to the context of its
    /// window, in table order. Parameters have the values of the first mode or initial set before, and every
    /// value of every set has been judged. After a refusal no context is attached, and a second call goes on
    /// where the first ended.
    /// @return kOk; kPreconditionNotMet (done before, called from an action, or the table has modes or sets
    ///         but the executive no SystemModes); kBadParameter (the table breaks a rule, see check_all(), a
    ///         value of a set is refused, with nothing switched, a component participates elsewhere, or the
    ///         SystemModes is that of another table or has no room for this core); either of them as
    ///         ExecutionContext::attach() says of a state machine; else the code of the on_initialize that
    ///         refused.
    Status initialize() noexcept;

    /// Empties every input of its core, with queues and buffers before it: only values that are published
    /// from here on reach them. Then starts every context and activates every component that the current mode
    /// runs, in table order. After a refusal everything is stopped again, as by stop().
    /// @return kOk; kPreconditionNotMet (not initialised, a context is running, a component is not alive, in
    ///         Error or Active already, other cores are switching modes, or called from an action);
    ///         kBadParameter (a value is refused of the set that holds, or of one that was asked for: that
    ///         request is gone then); else the code of the on_startup or on_activated that refused.
    Status start() noexcept;

    /// Deactivates every Active component and stops every running context, in reverse order. A context whose
    /// work hangs runs no cycle any more: it is stopped when its window next opens after the work has come
    /// back, or by another call.
    /// @return kOk; kPreconditionNotMet (not initialised, or called from an action); else the first refusal:
    ///         the code of an on_deactivated or on_shutdown, which keeps nothing from being stopped, or
    ///         kPreconditionNotMet (the work of a context hangs: the others are stopped).
    Status stop() noexcept;

    /// Gives every context's components up and finalizes them, in reverse order; initialize() may follow.
    /// @return kOk; kPreconditionNotMet (not initialised, a context is running, a component is Active, or
    ///         called from an action); else the code of the first on_finalize that failed: all are finalized
    ///         anyway.
    Status finalize() noexcept;

    /// Runs window `index` once. Actions and publications carry the planned instants, not the measured ones,
    /// so a late release changes no data.
    /// @param[in] index   0 .. get_view().windows.size() - 1, a window of this core; any other is an own bug.
    /// @param[in] release planned opening of the window, >= 0, not after host.get_now(); later is an own bug.
    /// @param[in] host    clock and budget guard; work that it abandons may run on after this returns, so it
    ///                    must outlive that. The next opening and stop() ask whether it has come back.
    /// @return what became of the opening; kStopped, kNotDue and kMissed ran no cycle.
    WindowOutcome run_window(std::size_t index, Instant release, WindowHost& host) noexcept;
    /// The same for a host that releases windows exactly: the planned opening is now.
    WindowOutcome run_window(std::size_t index, WindowHost& host) noexcept {
        return run_window(index, host.get_now(), host);
    }

    /// Context of window `index`, to activate, deactivate or reset a single component or to set the rate.
    /// That of a window of another core has no participants.
    /// @param[in] index 0 .. get_view().windows.size() - 1; out of range is an own bug.
    ExecutionContext& get_context(std::size_t index) noexcept { return windows_[index].context; }
    /// The table, as it was given.
    const SystemView& get_view() const noexcept { return view_; }
    /// Core whose windows it runs, as WindowRow::core.
    std::size_t get_core() const noexcept { return core_; }
    /// Component whose refusal ended the last initialize() or start(), for a context that could not take its
    /// participants the first of its window; kNoIndex when none did.
    std::size_t get_failed_component() const noexcept { return failed_component_; }

    /// @param[in] observer listens to the course of execution, or nullptr; must outlive the executive, or be
    ///            replaced before. Its records are asked for here, once: none, or one for each component of
    ///            the table, else an own bug. Not to be called from within an action or from the observer
    ///            (own bug).
    void set_observer(ExecutionObserver* observer) noexcept;
    /// Shows the course of execution to tools from now on: at the end of each opening of a window, and after
    /// initialize(), start(), stop() and finalize(). A table that breaks a rule shows nothing. No hash and no
    /// window depends on it.
    /// @param[in] introspection of the same table, else an own bug; or nullptr; must outlive the executive,
    ///            or be replaced before. Not to be called from within an action or from the observer (own
    ///            bug).
    void set_introspection(Introspection* introspection) noexcept;
    /// Hash of every publication so far: port row, sequence, instant and value.
    std::uint64_t get_trace_hash() const noexcept { return trace_hash_.get_value(); }

  protected:
    constexpr Executive(const SystemView& view, Span<detail::WindowState> windows, std::size_t core,
                        SystemModes* modes) noexcept
        : view_(view), windows_(windows), modes_(modes), core_(core) {}
    ~Executive() = default;

  private:
    bool is_own(std::size_t window) const noexcept { return view_.windows[window].core == core_; }
    bool is_any_running() const noexcept;
    Status initialize_components() noexcept;
    Status attach_contexts() noexcept;
    void attach_inputs() noexcept;
    void clear_ports() noexcept;
    Status start_all() noexcept;
    Status stop_all() noexcept;
    void prepare_work() noexcept;
    void begin_frame(Instant release) noexcept;
    Status prepare_parameters() noexcept;
    bool judge_set(std::size_t set) noexcept;
    Status join_modes() noexcept;
    static bool is_held(const ConnectionRow& connection, ModeMask modes) noexcept {
        return (connection.modes & modes) == modes;
    }
    void begin_modes(std::int64_t frame) noexcept;
    void take_plan(ModePlan plan, bool is_late) noexcept;
    bool take_set(std::size_t set) noexcept;
    void forget_set() noexcept;
    void report_plan() noexcept;
    void fail_step(ModeFailureCause cause, std::size_t component) noexcept;
    void cross_boundary(std::size_t window) noexcept;
    void cross_stopped_windows() noexcept;
    void prepare_window(std::size_t window) noexcept;
    void restart_inputs(std::size_t window) noexcept;
    std::size_t leave_components(std::size_t window, Instant deadline, WindowHost& host) noexcept;
    std::size_t enter_components(std::size_t window, Instant deadline, WindowHost& host) noexcept;
    bool take_step(std::size_t window, std::size_t position, Instant deadline, WindowHost& host) noexcept;
    static void activate_steps(void* argument, std::size_t first, std::size_t end) noexcept;
    static void deactivate_steps(void* argument, std::size_t first, std::size_t end) noexcept;
    WindowOutcome end_overrun(std::size_t window, std::size_t component, WindowHost& host) noexcept;
    bool readmit(detail::WindowState& state) noexcept;
    bool may_open(detail::WindowState& state, Instant opened, WindowHost& host) noexcept;
    void stop_late(detail::WindowState& state, Instant opened, WindowHost& host) noexcept;
    static void stop_steps(void* argument, std::size_t first, std::size_t end) noexcept;
    // Parts of run_window(), which calls each of them in one place: a window costs one call, not three.
    [[gnu::always_inline]] inline std::size_t run_cycle(const WindowRow& row, detail::WindowState& state,
                                                        Instant opened, Instant deadline,
                                                        WindowHost& host) noexcept;
    [[gnu::always_inline]] inline WindowOutcome run_open_window(const WindowRow& row,
                                                                detail::WindowState& state, Instant opened,
                                                                WindowHost& host) noexcept;
    void show_windows() noexcept;
    void show_opening(std::size_t window, Instant release, Instant opened, WindowOutcome outcome,
                      const WindowHost& host) noexcept;
    static void execute_steps(void* argument, std::size_t first, std::size_t end) noexcept;
    static void follow_step(void* argument, std::size_t position, Duration used) noexcept;
    static void update_steps(void* argument, std::size_t first, std::size_t end) noexcept;
    void report_overrun(std::size_t window, std::size_t component, Instant now) noexcept;
    void latch_inputs(const WindowRow& row, ModeMask held) noexcept;
    void hand_on_outputs(std::size_t component, Instant opening, ModeMask held) noexcept;
    void mark_inputs_read(const WindowRow& row, const ExecutionContext& context,
                          std::size_t finished_count) noexcept;
    void publish_outputs(const WindowRow& row, ModeMask held, Instant close) noexcept;
    void deliver(const PortRow& port, ModeMask held) noexcept;
    void discard_outputs(std::size_t window) noexcept;
    void discard_outputs_of(std::size_t component) noexcept;

    SystemView view_;
    Span<detail::WindowState> windows_;
    SystemModes* modes_;
    ExecutionObserver* observer_{nullptr};
    ExecutionRecord* records_{nullptr};  ///< of the observer; of component 0 and on
    Introspection* introspection_{nullptr};
    TraceHash trace_hash_{};
    Instant last_release_{};
    /// Start of the frame that the window of the last run lies in; at first one that no window lies in.
    Instant frame_start_{std::numeric_limits<std::int64_t>::max()};
    Instant last_step_end_{};         ///< of a mode step; the cycle of its window begins there
    ModePlan plan_{};                 ///< taken last
    ModeStep step_{ModeStep::kNone};  ///< of it, as far as this core carries it out
    ModeMask held_modes_{0U};         ///< the mode; two of them between leaving one and entering the other
    bool is_plan_open_{false};        ///< taken and not reported
    bool has_step_failed_{false};
    bool has_joined_{false};  ///< takes part in what the cores agree on: from start() to stop()
    std::size_t core_;
    std::size_t failed_component_{kNoIndex};
    bool is_table_sound_{false};  ///< it was judged, by initialize() or set_introspection()
    bool is_initialized_{false};
    bool is_busy_{false};  ///< an operation or a window is under way: another one must wait
};

namespace detail {
/// Base so that the states exist before the executive that refers to them.
template <std::size_t kCount>
struct WindowStorage {
    std::array<WindowState, kCount> windows{};
};
}  // namespace detail

/// Executive with the storage that `Table` needs:  inline mamori::ExecutiveFor executive{kSystem};
/// A table with modes or configuration sets needs a SystemModes as well; the compiler says so where the type
/// of the table tells, initialize() otherwise.
template <typename Table>
class ExecutiveFor final : private detail::WindowStorage<Table::kWindowCount>, public Executive {
  public:
    /// @param[in] table must outlive the executive; check it with MAMORI_CHECK.
    /// @param[in] core  whose windows it runs, below kModeCoreMax with a SystemModes; each core of a system
    ///            has an executive of its own.
    constexpr explicit ExecutiveFor(const Table& table, std::size_t core = 0U) noexcept
        : Executive(make_view(table), detail::WindowStorage<Table::kWindowCount>::windows, core, nullptr) {
        static_assert(!Table::kNeedsModes,
                      "a table with modes or configuration sets needs a SystemModes: write "
                      "SystemModes modes{make_view(kSystem)}; ExecutiveFor executive{kSystem, modes};");
    }
    /// @param[in] modes one for all cores of the table; must outlive the executive.
    constexpr ExecutiveFor(const Table& table, SystemModes& modes, std::size_t core = 0U) noexcept
        : Executive(make_view(table), detail::WindowStorage<Table::kWindowCount>::windows, core, &modes) {}
    explicit ExecutiveFor(const Table&& table, SystemModes& modes, std::size_t core = 0U) = delete;
    explicit ExecutiveFor(const Table&& table, std::size_t core = 0U) = delete;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTIVE_HPP

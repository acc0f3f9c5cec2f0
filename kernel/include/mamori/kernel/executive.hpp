// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs the windows of a system table: latches inputs when a window opens, runs its components in order under
/// a budget that the port enforces, hands values on within the window, and publishes outputs when it closes.
///
/// @satisfies SWR-KRN-021, SWR-KRN-022, SWR-KRN-023      Design: docs/design/kernel.md#windows
#ifndef MAMORI_KERNEL_EXECUTIVE_HPP
#define MAMORI_KERNEL_EXECUTIVE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/execution_context.hpp"
#include "mamori/kernel/execution_observer.hpp"
#include "mamori/kernel/system_table.hpp"
#include "mamori/kernel/trace_hash.hpp"

namespace mamori {

/// What a port gives to the executive: the time, and a way to run work that does not run for ever.
///
/// Calling context: the context that runs the windows.
class WindowHost {
  public:
    virtual Instant get_now() const noexcept = 0;

    /// A piece of work; call it at most once.
    struct Work {
        void (*function)(void* argument) noexcept;
        void* argument;
    };

    /// Runs `work` of component `component`.
    /// @param[in] deadline instant at which the window's budget is used up.
    /// @return true when it returned before the deadline; false when the budget ran out first, whether the
    /// work
    ///         returned late, was abandoned, or never began because earlier work of its context still hangs.
    virtual bool run_within(std::size_t component, Work work, Instant deadline) noexcept = 0;

  protected:
    ~WindowHost() = default;
};

/// How a window ended.
enum class WindowOutcome : std::uint8_t {
    kCompleted,  ///< every component ran; outputs are published
    kOverrun,    ///< the budget ran out; no output of this window is published
    kStopped,    ///< the context is Stopped; nothing ran
};

/// Size-free executive; instantiate ExecutiveFor.
///
/// Thread safety: none; one executive per core. Time: O(components + connections of the window).
/// Memory: no heap; refers to the table.
class Executive {
  public:
    Executive(const Executive&) = delete;
    Executive& operator=(const Executive&) = delete;

    /// Initialises every component and attaches it to the context of its window, in table order.
    /// @return kOk; kPreconditionNotMet (done before); else the code of the first refusal, after which the
    /// system
    ///         must not be started: get_failed_component() tells whose.
    Status initialize() noexcept;

    /// Starts every context, then activates every component, in table order.
    /// @return kOk; kPreconditionNotMet (not initialised, or running); else the first refusal's code.
    Status start() noexcept;

    /// Deactivates every Active component and stops every running context, in reverse order.
    /// @return kOk; kPreconditionNotMet (not initialised); else the first refusal's code; all are stopped
    /// anyway.
    Status stop() noexcept;

    /// Runs window `index` once. @param[in] index 0 .. get_view().windows.size() - 1.
    WindowOutcome run_window(std::size_t index, WindowHost& host) noexcept;

    /// Context of window `index`, to start, stop or reset a single component.
    ExecutionContext& get_context(std::size_t index) noexcept { return contexts_[index]; }
    const SystemView& get_view() const noexcept { return view_; }
    /// Component whose refusal ended initialize() or start(); kNoIndex when none did.
    std::size_t get_failed_component() const noexcept { return failed_component_; }

    /// @param[in] observer listens to the course of execution, or nullptr; must outlive the executive.
    void set_observer(ExecutionObserver* observer) noexcept { observer_ = observer; }
    /// Hash of every publication so far: port row, sequence, instant and value.
    std::uint64_t get_trace_hash() const noexcept { return trace_hash_.get_value(); }

  protected:
    constexpr Executive(const SystemView& view, Span<ExecutionContext> contexts) noexcept
        : view_(view), contexts_(contexts) {}
    ~Executive() = default;

  private:
    struct ComponentRun;

    void latch_inputs(std::size_t window) noexcept;
    void hand_on_outputs(std::size_t component, Instant now) noexcept;
    void close_window(std::size_t window, bool is_complete, Instant now) noexcept;
    bool run_component(std::size_t window, std::size_t position, Instant deadline, WindowHost& host) noexcept;

    SystemView view_;
    Span<ExecutionContext> contexts_;
    ExecutionObserver* observer_{nullptr};
    TraceHash trace_hash_{};
    std::size_t failed_component_{kNoIndex};
    bool is_initialized_{false};
};

namespace detail {
/// Base so that the contexts exist before the executive that refers to them.
template <std::size_t kCount>
struct ContextStorage {
    std::array<ExecutionContext, kCount> contexts{};
};
}  // namespace detail

/// Executive with the storage that `Table` needs:  inline mamori::ExecutiveFor executive{kSystem};
template <typename Table>
class ExecutiveFor final : private detail::ContextStorage<Table::kWindowCount>, public Executive {
  public:
    /// @param[in] table must have static storage; check it with MAMORI_CHECK.
    constexpr explicit ExecutiveFor(const Table& table) noexcept
        : Executive(make_view(table), detail::ContextStorage<Table::kWindowCount>::contexts) {}
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTIVE_HPP

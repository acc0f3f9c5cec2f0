// SPDX-License-Identifier: Apache-2.0
/// @file
/// Limits the time of actions outside windows: on_initialize, on_startup, on_activated, on_deactivated,
/// on_shutdown and on_finalize that an executive calls.
///
/// @satisfies SWR-KRN-090, SWR-KRN-091      Design: docs/design/kernel.md#actions-outside-windows
#ifndef MAMORI_KERNEL_ACTION_GUARD_HPP
#define MAMORI_KERNEL_ACTION_GUARD_HPP

#include <cstddef>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/action_caller.hpp"
#include "mamori/kernel/component/window_host.hpp"

namespace mamori {

namespace detail {
struct CoreState;
}

/// Calls each action of one executive as work of the window of its component, with a budget of its own.
/// Derive, and construct one per executive: Executive::set_action_guard().
///
/// Thread safety: as Executive. Time: at most the budget per action. Memory: no heap; refers to the host.
class ActionGuard : public ActionCaller {
  public:
    ActionGuard(const ActionGuard&) = delete;
    ActionGuard& operator=(const ActionGuard&) = delete;

    // Inline, so that programs with type information can derive from this class.
    bool call(const WindowHost::Work& work, ComponentAction action) noexcept final {
        return run(work, action);
    }
    /// For the executive: its state.
    void attach(detail::CoreState& core) noexcept { core_ = &core; }

  protected:
    /// @param[in] host   of the core of the executive; must outlive the executive, as work that it aborts may
    ///                   still run.
    /// @param[in] budget of each action, > 0, for example SystemTable::action_budget.
    constexpr ActionGuard(WindowHost& host, Duration budget) noexcept : host_(host), budget_(budget) {}
    ~ActionGuard() = default;

    /// `action` of `component`, an index of the system table, exceeded its budget. Called before any further
    /// action, on the thread of the operation: close the outputs here. Must not block. Operations on the
    /// executive are rejected during the call.
    virtual void on_action_overrun(std::size_t component, ComponentAction action) noexcept = 0;

  private:
    bool run(const WindowHost::Work& work, ComponentAction action) noexcept;

    WindowHost& host_;
    Duration budget_;
    detail::CoreState* core_{nullptr};  ///< of the executive
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_ACTION_GUARD_HPP

// SPDX-License-Identifier: Apache-2.0
/// @file
/// Interface of a platform port to the executive: the time, and a call that runs work up to a deadline. The
/// port enforces the budget; the executive reacts to overruns.
///
/// @satisfies SWR-KRN-022, SWR-KRN-032      Design: docs/design/kernel.md#windows
#ifndef MAMORI_KERNEL_WINDOW_HOST_HPP
#define MAMORI_KERNEL_WINDOW_HOST_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"

namespace mamori {

/// Clock and budget enforcement of the core that runs the windows.
///
/// Calling context: the context that runs the windows; get_step_end() from the context that runs the step.
/// Time: the executive calls get_now() a few times per window and once per mode step, and get_step_end() once
///       per step. Neither may block.
class WindowHost {
  public:
    /// Part of a component's cycle that the work belongs to.
    enum class Pass : std::uint8_t {
        kExecute,      ///< on_execute, or the actions that replace it in an invocation
        kStateUpdate,  ///< on_state_update
        kModeStep,     ///< on_deactivated or on_activated in a mode switch or a late stop, not in a cycle
        kAction,       ///< an action outside windows, as on_startup: see ActionGuard
    };

    /// One pass over components of a window, as a range of steps. A platform host without tasks between two
    /// steps can run the whole range with one call.
    struct Work {
        /// Runs the steps `begin` .. `end` - 1 in order.
        void (*run)(void* argument, std::size_t begin, std::size_t end) noexcept;
        void* argument;         ///< owned by the executive; must outlive aborted work
        std::size_t window;     ///< index in the system table
        std::size_t component;  ///< index in the system table, for the first step; the others follow
        std::size_t first;      ///< number of the first step
        std::size_t count;      ///< number of steps, > 0
        Pass pass;
    };

    /// @return the time on the time line of the port; never decreases.
    virtual Instant get_now() const noexcept = 0;

    /// @return the end of the step that is returning; called from within a step. A platform host that models
    ///         execution times returns the modelled end, which its clock has not yet reached.
    virtual Instant get_step_end() const noexcept = 0;

    /// Runs the steps of `work`, each at most once and in order, together or one by one. Blocks until they
    /// have ended. A platform host that can abort work returns when the deadline has passed.
    /// @param[in] deadline instant at which the budget of the window is exhausted; may have passed already.
    /// @return number of steps that returned by the deadline. It is less than count when the budget was
    ///         exhausted first, whether the step returned late or was aborted. Aborted work may enter one
    ///         more step, which then does nothing.
    virtual std::size_t run_within(const Work& work, Instant deadline) noexcept = 0;

    /// True when the work that run_within() aborted has returned: none of it runs, and none of it will start.
    /// Called only for a window whose last work was aborted. A platform host that runs the work on another
    /// thread returns true only once it sees all effects of the work; until then, the window does not run.
    virtual bool has_returned(std::size_t window) const noexcept = 0;

  protected:
    ~WindowHost() = default;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_HOST_HPP

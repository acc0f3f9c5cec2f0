// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a port gives to the executive: the time, and a way to run work that does not run for ever.
/// The port enforces the budget; the executive draws the consequences.
///
/// @satisfies SWR-KRN-022, SWR-KRN-032      Design: docs/design/kernel.md#windows
#ifndef MAMORI_KERNEL_WINDOW_HOST_HPP
#define MAMORI_KERNEL_WINDOW_HOST_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"

namespace mamori {

/// Clock and budget guard of the core that runs the windows.
///
/// Calling context: the context that runs the windows; get_step_end() the one that runs the step.
/// Time: get_now() is asked a few times per window and once per mode step, get_step_end() once per step, and
/// must not block.
class WindowHost {
  public:
    /// Which part of a component's cycle a piece of work is.
    enum class Pass : std::uint8_t {
        kExecute,      ///< on_execute, or what takes its place in a turn
        kStateUpdate,  ///< on_state_update
        kModeStep,     ///< on_deactivated or on_activated in a switch of modes or a late stop, not in a cycle
    };

    /// One pass over components of a window, as a range of steps, so that a host which has nothing to do
    /// between two of them pays for one call only.
    struct Work {
        /// Runs the steps `begin` .. `end` - 1 in order.
        void (*run)(void* argument, std::size_t begin, std::size_t end) noexcept;
        void* argument;         ///< owned by the executive, which outlives work that is abandoned
        std::size_t window;     ///< of the system table
        std::size_t component;  ///< place of the first step's component in the system table; others follow
        std::size_t first;      ///< number of the first step
        std::size_t count;      ///< of steps, > 0
        Pass pass;
    };

    /// @return the time on the port's line; never goes back.
    virtual Instant get_now() const noexcept = 0;

    /// @return the instant at which the step that is just returning ends; asked from within a step. A host
    ///         that models execution times answers with the modelled end, which its clock has not reached
    ///         yet.
    virtual Instant get_step_end() const noexcept = 0;

    /// Runs the steps of `work`, each at most once and in order, together or one by one. Blocks until they
    /// are done; a host that can abandon work returns when the deadline has passed.
    /// @param[in] deadline instant at which the window's budget is used up; may have passed already.
    /// @return how many of them returned by the deadline; less than count when the budget ran out
    ///         first, whether that step returned late or was abandoned. Abandoned work may enter one more
    ///         step, which then does nothing.
    virtual std::size_t run_within(const Work& work, Instant deadline) noexcept = 0;

    /// Whether work that run_within() has cut off is over: nothing of it runs, and nothing of it will begin.
    /// Asked only of a window whose work was cut off last time. A host that has work on another thread
    /// answers true only once it sees all that the work did; until then the window stays closed.
    virtual bool has_returned(std::size_t window) const noexcept = 0;

  protected:
    ~WindowHost() = default;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_HOST_HPP

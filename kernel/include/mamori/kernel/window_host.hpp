// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a port gives to the executive: the time, and a way to run work that does not run for ever.
/// The port enforces the budget; the executive draws the consequences.
///
/// @satisfies SWR-KRN-022      Design: docs/design/kernel.md#windows
#ifndef MAMORI_KERNEL_WINDOW_HOST_HPP
#define MAMORI_KERNEL_WINDOW_HOST_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/time.hpp"

namespace mamori {

/// Clock and budget guard of the core that runs the windows.
///
/// Calling context: the context that runs the windows.
class WindowHost {
  public:
    /// Which part of a component's cycle a piece of work is.
    enum class Pass : std::uint8_t { kExecute, kStateUpdate };

    /// A piece of work; call it at most once.
    struct Work {
        void (*function)(void* argument) noexcept;
        void* argument;  ///< valid until run_within() returns; work that begins does not need it afterwards
        Pass pass;
    };

    /// @return the time on the port's line; never goes back.
    virtual Instant get_now() const noexcept = 0;

    /// Runs `work` of component `component`.
    /// @param[in] deadline instant at which the window's budget is used up; may have passed already.
    /// @return true when it returned by the deadline; false when the budget ran out first, whether the work
    ///         returned late, was abandoned, or never began because earlier work of its context still hangs.
    virtual bool run_within(std::size_t component, Work work, Instant deadline) noexcept = 0;

  protected:
    ~WindowHost() = default;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_HOST_HPP

// SPDX-License-Identifier: Apache-2.0
/// @file
/// State of one core that the parts of its executive share. Not for users.
/// @satisfies SWR-KRN-021, SWR-KRN-032
/// Design:   docs/design/kernel.md#parts-of-the-executive
#ifndef MAMORI_KERNEL_CORE_STATE_HPP
#define MAMORI_KERNEL_CORE_STATE_HPP

#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/window_host.hpp"
#include "mamori/kernel/run/detail/execution_display.hpp"
#include "mamori/kernel/run/detail/execution_parts.hpp"
#include "mamori/kernel/run/detail/mode_plan.hpp"
#include "mamori/kernel/run/execution_observer.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

namespace detail {

/// An instant in no major frame.
inline constexpr Instant kNoFrame{std::numeric_limits<std::int64_t>::max()};

struct CoreState;

/// State of one window while the system runs.
struct WindowState {
    ExecutionContext context{};
    Instant release{};  ///< planned start of the current window instance, or of the one whose work hangs
    WindowHost::Work first_pass{};  ///< equal in each cycle, see WindowRunner::prepare_work()
    ExecutionContext::StepObserver step_observer{};  ///< observes the first pass if `is_observed`
    bool is_observed{false};                         ///< the first pass has a step observer
    bool is_stop_due{false};            ///< stop() could not stop the context, because its work hangs
    std::uint8_t life_result{0U};       ///< Status of the last on_initialize or on_finalize under a guard
    const WindowHost* cut_by{nullptr};  ///< aborted work of this window that may still run
    Instant crossed_at{kNoFrame};       ///< major frame whose boundary the window crossed last
    ModeMask held_modes{0U};            ///< serves the connections active in all of these modes
    std::size_t set{kNoIndex};          ///< configuration set that becomes active at the next boundary
    ModePlan prepared{};                ///< plan whose connections the window has
    ModePlan done{};                    ///< plan whose components the window has activated or deactivated
    std::size_t next_leaving{0U};       ///< position of the next component that may leave by this plan
    CoreState* core{nullptr};           ///< work of the window reaches its core through this pointer

    /// Index of the window in the system table.
    std::size_t get_window() const noexcept { return first_pass.window; }
};

/// Owned by the lowest part. Thread safety: as Executive. Memory: one per executive.
struct CoreState {
    SystemView view;
    Span<WindowState> windows;
    std::size_t core;
    ExecutionParts parts;
    ExecutionObserver* observer{nullptr};
    ExecutionRecord* records{nullptr};  ///< records of the observer, one per component of the table
    ExecutionDisplay* introspection{nullptr};
    Instant release{};              ///< planned start of the last window instance
    Instant frame_start{kNoFrame};  ///< start of the major frame of the last window instance

    bool is_own(std::size_t window) const noexcept { return view.windows[window].core == core; }
};

}  // namespace detail
}  // namespace mamori

#endif  // MAMORI_KERNEL_CORE_STATE_HPP

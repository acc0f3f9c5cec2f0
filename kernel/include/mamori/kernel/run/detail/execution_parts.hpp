// SPDX-License-Identifier: Apache-2.0
/// @file
/// Functions that an executive calls for some tables only. The executive refers to those that its table
/// needs, so that the others are not linked. Not for users.
///
/// @satisfies SWR-KRN-070, SWR-KRN-071      Design: docs/design/kernel.md#parts-that-a-table-does-not-use
#ifndef MAMORI_KERNEL_EXECUTION_PARTS_HPP
#define MAMORI_KERNEL_EXECUTION_PARTS_HPP

#include <cstddef>

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/table/initial_check.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::detail {

struct CoreState;
struct WindowState;

/// Makes the first pass of a window tell of its steps.
using ObservePass = void (*)(const CoreState& core, WindowState& state) noexcept;
void observe_pass(const CoreState& core, WindowState& state) noexcept;

/// Without initialisers given: everything, for a table that the compiler has not checked.
struct ExecutionParts {
    InitialCheck check{&check_everything};  ///< never nullptr
    /// nullptr: no component overrides on_state_update.
    ExecutionContext::Pass second_pass{&ExecutionContext::run_second_pass};
    /// nullptr: no connection is forward in a window, and the executive has no observer yet.
    ObservePass observe{&observe_pass};
};

/// The parts that a table without a finding of check() needs, if the compiler found none.
constexpr ExecutionParts choose_parts(const SystemView& view) noexcept {
    bool has_second_pass = false;
    bool has_hand_on = false;
    for (std::size_t w = 0U; w < view.windows.size(); ++w) {
        has_second_pass = has_second_pass || view.windows[w].has_second_pass;
        has_hand_on = has_hand_on || view.windows[w].has_hand_on;
    }
    return {choose_check(view), has_second_pass ? &ExecutionContext::run_second_pass : nullptr,
            has_hand_on ? &observe_pass : nullptr};
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_EXECUTION_PARTS_HPP

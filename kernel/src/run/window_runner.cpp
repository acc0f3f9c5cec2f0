// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/run/detail/window_runner.hpp"

namespace mamori::detail {

using Pass = WindowHost::Pass;

void WindowRunner::prepare_work() noexcept {
    CoreState& core = get_core();
    const Span<const WindowRow> rows = core.view.windows;
    for (std::size_t w = 0U; w < rows.size(); ++w) {
        const WindowRow& row = rows[w];
        WindowState& state = core.windows[w];
        state.core = &core;
        state.is_observed = false;
        state.first_pass = {ExecutionContext::get_first_pass(),
                            &state.context,
                            w,
                            row.first_component,
                            0U,
                            row.component_count,
                            Pass::kExecute};
        if (core.parts.observe != nullptr) {
            core.parts.observe(core, state);
        }
    }
}

void WindowRunner::show_steps(const WindowState& state, std::size_t executed_count) noexcept {
    get_core().introspection->note_turns(state.get_window(), executed_count, state.context);
}

void WindowRunner::end_overrun(WindowState& state, std::size_t component, WindowHost& host) noexcept {
    report_overrun(state.get_window(), component, host.get_now());
    state.context.abandon(component - get_core().view.windows[state.get_window()].first_component);
    state.cut_by = &host;
    static_cast<void>(readmit(state));
}

void WindowRunner::report_overrun(std::size_t window, std::size_t component, Instant now) noexcept {
    const CoreState& core = get_core();
    if (core.observer != nullptr) {
        core.observer->on_budget_overrun(window, component, now);
    }
}

bool WindowRunner::readmit(WindowState& state) noexcept {
    if (state.cut_by != nullptr && state.cut_by->has_returned(state.get_window())) {
        state.cut_by = nullptr;
        state.context.readmit();
        get_data_flow().discard_outputs(state.get_window());
    }
    return !state.context.is_busy();
}

/// For a window whose work was aborted, or that stop() could not stop. @return whether it starts normally.
bool WindowRunner::may_open(WindowState& state, Instant start, WindowHost& host) noexcept {
    const CoreState& core = get_core();
    if (!readmit(state)) {
        const std::size_t position = state.context.get_acting_position().get_value();
        report_overrun(state.get_window(), core.view.windows[state.get_window()].first_component + position,
                       start);
        return false;
    }
    if (state.is_stop_due) {
        stop_late(state, start, host);
    }
    return state.context.is_running() && !state.is_stop_due;
}

/// Executes what stop() could not, under the budget of the window. Continues in the next window instance if
/// the budget is exhausted.
void WindowRunner::stop_late(WindowState& state, Instant start, WindowHost& host) noexcept {
    const WindowRow& row = get_core().view.windows[state.get_window()];
    const std::size_t stopped = host.run_within({&stop_steps, &state, state.get_window(), row.first_component,
                                                 0U, row.component_count, Pass::kModeStep},
                                                start + row.budget);
    if (stopped < row.component_count) {
        end_overrun(state, row.first_component + stopped, host);
        return;
    }
    get_data_flow().discard_outputs(state.get_window());
    static_cast<void>(state.context.stop(state.release));
    state.is_stop_due = state.context.is_running();
}

void WindowRunner::stop_steps(void* argument, std::size_t first, std::size_t end) noexcept {
    WindowState& state = *static_cast<WindowState*>(argument);
    const SystemView& view = state.core->view;
    for (std::size_t i = first; i < end; ++i) {
        if (state.context.get_state_at(i) == LifecycleState::kActive) {
            const Component& component =
                *view.components[view.windows[state.get_window()].first_component + i];
            static_cast<void>(state.context.deactivate_component(component, state.release));
        }
    }
}

}  // namespace mamori::detail

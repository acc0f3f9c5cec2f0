// SPDX-License-Identifier: Apache-2.0
// Alone in its file: an executive without observer, whose windows forward no value, does not link it.
// @satisfies SWR-KRN-031, SWR-KRN-071
#include "mamori/kernel/run/detail/core_state.hpp"
#include "mamori/kernel/run/detail/data_flow.hpp"

namespace mamori::detail {
namespace {

void end_step(void* argument, std::size_t position, Duration used) noexcept {
    const WindowState& state = *static_cast<const WindowState*>(argument);
    const CoreState& core = *state.core;
    const WindowRow& row = core.view.windows[state.get_window()];
    const std::size_t component = row.first_component + position;
    if (core.introspection != nullptr && used >= Duration{0}) {
        core.introspection->note_used(component, used);
    }
    if (row.has_hand_on) {
        DataFlow::forward_outputs(core.view, component, state.release, state.held_modes);
    }
}

}  // namespace

void observe_pass(const CoreState& core, WindowState& state) noexcept {
    using Observation = ExecutionContext::StepObservation;
    const WindowRow& row = core.view.windows[state.get_window()];
    state.is_observed = core.records != nullptr || row.has_hand_on;
    if (!state.is_observed) {
        return;
    }
    const bool needs_step_end = row.has_hand_on || core.introspection != nullptr;
    ExecutionContext::StepObserver& observer = state.step_observer;
    observer.context = &state.context;
    observer.records = core.records == nullptr ? nullptr : core.records + row.first_component;
    observer.after_step = needs_step_end ? &end_step : nullptr;
    observer.argument = &state;
    state.first_pass.run =
        ExecutionContext::get_observed_pass(needs_step_end ? Observation::kAfterStep : Observation::kRecords);
    state.first_pass.argument = &observer;
}

}  // namespace mamori::detail

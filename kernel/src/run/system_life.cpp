// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/run/detail/system_life.hpp"

namespace mamori::detail {
namespace {

/// Component of a rule that only objects can violate, since no compiler message names it; otherwise kNoIndex.
std::size_t find_faulty_component(const SystemView& view, const Finding& finding) noexcept {
    const Component* owner = nullptr;
    if (finding.rule == Rule::kComponentNamedTwice || finding.rule == Rule::kPortNotListed ||
        finding.rule == Rule::kParameterNotListed) {
        return finding.element;
    }
    if (finding.rule == Rule::kPortNotOwned || finding.rule == Rule::kPortNamedTwice) {
        owner = view.ports[finding.element].owner;
    } else if (finding.rule == Rule::kParameterNotOwned || finding.rule == Rule::kParameterNamedTwice) {
        owner = view.configuration.parameters[finding.element].owner;
    }
    if (owner == nullptr) {
        return kNoIndex;
    }
    std::size_t component = kNoIndex;
    for (std::size_t i = 0U; i < view.components.size(); ++i) {
        component = view.components[i] == owner ? i : component;
    }
    return component;
}

}  // namespace

void SystemLife::check_table() noexcept {
    const SystemView& view = get_core().view;
    const Finding finding = get_core().parts.check(view);
    is_table_valid_ = finding.rule == Rule::kNone;
    failed_component_ = find_faulty_component(view, finding);
}

bool SystemLife::is_any_running() const noexcept {
    for (const WindowState& state : get_core().windows) {
        if (state.context.is_running()) {
            return true;
        }
    }
    return false;
}

bool SystemLife::is_any_active() const noexcept {
    for (const WindowState& state : get_core().windows) {
        for (std::size_t i = 0U; i < state.context.get_participant_count(); ++i) {
            if (state.context.get_state_at(i) == LifecycleState::kActive) {
                return true;
            }
        }
    }
    return false;
}

/// First component with an invalid parameter, on any core; kNoIndex: none. Precondition: the table is valid.
std::size_t SystemLife::find_invalid_parameter() const noexcept {
    const SystemView& view = get_core().view;
    for (const ParameterRow& row : view.configuration.parameters) {
        for (std::size_t i = 0U; i < view.components.size(); ++i) {
            if (view.components[i] == row.owner && !row.parameter->is_valid()) {
                return i;
            }
        }
    }
    return kNoIndex;
}

Status SystemLife::initialize_components() noexcept {
    const CoreState& core = get_core();
    for (std::size_t i = 0U; i < core.view.components.size(); ++i) {
        Component& component = *core.view.components[i];
        if (!core.is_own(core.view.component_rows[i].window) || component.is_alive()) {
            continue;
        }
        const Status result = component.initialize();
        if (result != Status::kOk) {
            failed_component_ = i;
            return result;
        }
    }
    return Status::kOk;
}

Status SystemLife::attach_contexts() noexcept {
    CoreState& core = get_core();
    for (std::size_t w = 0U; w < core.view.windows.size(); ++w) {
        const WindowRow& row = core.view.windows[w];
        if (!core.is_own(w)) {
            continue;
        }
        const Span<Component* const> participants =
            core.view.components.subspan(row.first_component, row.component_count);
        ContextPlan plan{};
        plan.period = row.period;
        plan.alternative_periods = {row.alternative_periods.data(), row.alternative_count};
        plan.kind = row.kind;
        plan.abort_policy = core.view.abort_policy;
        plan.trigger = row.trigger;
        plan.events_per_cycle = row.events_per_cycle;
        const Status result =
            core.windows[w].context.attach(static_cast<std::int32_t>(w), participants, plan);
        if (result != Status::kOk) {
            failed_component_ = row.first_component;
            for (std::size_t attached = 0U; attached < w; ++attached) {
                // Not rejected where it is attached: nothing has been started yet.
                static_cast<void>(core.windows[attached].context.detach());
            }
            return result;
        }
    }
    return Status::kOk;
}

/// Whether the table can run without SystemModes.
Status ModeFollower::judge_absence() const noexcept {
    const SystemView& view = data_flow_.get_core().view;
    const bool is_needed = !view.modes.modes.empty() || !view.configuration.sets.empty();
    return is_needed ? Status::kPreconditionNotMet : Status::kOk;
}

Status SystemLife::initialize() noexcept {
    check_table();
    if (!is_table_valid_) {
        return Status::kBadParameter;
    }
    failed_component_ = find_invalid_parameter();
    if (failed_component_ != kNoIndex) {
        return Status::kBadParameter;
    }
    Status result = runner_.get_modes().initialize();
    if (result == Status::kOk) {
        result = initialize_components();
    }
    if (result == Status::kOk) {
        result = attach_contexts();
    }
    if (result == Status::kOk) {
        runner_.prepare_work();
        runner_.get_data_flow().attach_inputs();
    }
    is_initialized_ = result == Status::kOk;
    return result;
}

/// First component of the table that no executive has attached; kNoIndex: none.
std::size_t SystemLife::find_component_without_context() const noexcept {
    const Span<Component* const> components = get_core().view.components;
    for (std::size_t i = 0U; i < components.size(); ++i) {
        if (components[i]->get_participating_contexts().empty()) {
            return i;
        }
    }
    return kNoIndex;
}

Status SystemLife::start_contexts() noexcept {
    CoreState& core = get_core();
    for (std::size_t w = 0U; w < core.view.windows.size(); ++w) {
        ExecutionContext& context = core.windows[w].context;
        if (!core.is_own(w)) {
            continue;
        }
        const Status result = context.start(core.release);
        if (result != Status::kOk) {
            failed_component_ =
                core.view.windows[w].first_component + context.get_refusing_position().get_value();
            return result;
        }
    }
    return Status::kOk;
}

Status SystemLife::activate_components() noexcept {
    CoreState& core = get_core();
    const ModeMask held = runner_.get_modes().get_held_modes();
    for (std::size_t i = 0U; i < core.view.components.size(); ++i) {
        const ComponentRow& row = core.view.component_rows[i];
        if (!core.is_own(row.window) || (row.modes & held) != held) {
            continue;
        }
        const Status result =
            core.windows[row.window].context.activate_component(*core.view.components[i], core.release);
        if (result != Status::kOk) {
            failed_component_ = i;
            return result;
        }
    }
    return Status::kOk;
}

Status SystemLife::start() noexcept {
    failed_component_ = find_component_without_context();
    if (failed_component_ != kNoIndex) {
        return Status::kPreconditionNotMet;
    }
    Status result = runner_.get_modes().join();
    if (result != Status::kOk) {
        return result;
    }
    runner_.get_data_flow().clear_ports();
    result = start_contexts();
    if (result == Status::kOk) {
        result = activate_components();
    }
    if (result != Status::kOk) {
        // The caller must receive the first failure, so a failure of stop() is ignored.
        static_cast<void>(stop());
    }
    return result;
}

Status SystemLife::stop() noexcept {
    CoreState& core = get_core();
    Status first_failure = Status::kOk;
    const auto keep_first = [&first_failure](Status result) noexcept {
        if (first_failure == Status::kOk) {
            first_failure = result;
        }
    };
    for (std::size_t w = core.view.windows.size(); w-- > 0U;) {
        const WindowRow& row = core.view.windows[w];
        WindowState& state = core.windows[w];
        static_cast<void>(runner_.readmit(state));
        for (std::size_t i = state.context.get_participant_count(); i-- > 0U;) {
            if (state.context.get_state_at(i) == LifecycleState::kActive) {
                const Component& component = *core.view.components[row.first_component + i];
                keep_first(state.context.deactivate_component(component, core.release));
            }
        }
        if (state.context.is_running()) {
            keep_first(state.context.stop(core.release));
        }
        state.is_stop_due = state.context.is_running();
    }
    runner_.get_modes().leave();
    return first_failure;
}

Status SystemLife::finalize() noexcept {
    CoreState& core = get_core();
    is_initialized_ = false;
    runner_.get_data_flow().detach_inputs();
    for (WindowState& state : core.windows) {
        // Not rejected where it is attached: nothing runs and no component is Active.
        static_cast<void>(state.context.detach());
    }
    Status first_failure = Status::kOk;
    for (std::size_t i = core.view.components.size(); i-- > 0U;) {
        Component& component = *core.view.components[i];
        // A component that exit() ended has nothing left to finalize.
        if (!core.is_own(core.view.component_rows[i].window) || !component.is_alive()) {
            continue;
        }
        const Status result = component.finalize();
        if (first_failure == Status::kOk) {
            first_failure = result;
        }
    }
    return first_failure;
}

}  // namespace mamori::detail

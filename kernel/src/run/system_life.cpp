// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/run/detail/system_life.hpp"

#include "system_start.hpp"

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

/// Whether a context runs, or aborted work of it has not returned. Readmits the others.
bool SystemLife::is_any_in_use() noexcept {
    bool is_in_use = false;
    for (WindowState& state : get_core().windows) {
        const bool is_idle = runner_.readmit(state);
        is_in_use = is_in_use || !is_idle || state.context.is_running();
    }
    return is_in_use;
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

Status SystemLife::prepare_initialization() noexcept {
    check_table();
    if (!is_table_valid_) {
        return Status::kBadParameter;
    }
    failed_component_ = find_invalid_parameter();
    if (failed_component_ != kNoIndex) {
        return Status::kBadParameter;
    }
    runner_.prepare_work();
    return runner_.get_modes().initialize();
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

template Status SystemLife::initialize() noexcept;
template Status SystemLife::start() noexcept;
template Status SystemLife::stop() noexcept;
template Status SystemLife::finalize() noexcept;

}  // namespace mamori::detail

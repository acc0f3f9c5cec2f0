// SPDX-License-Identifier: Apache-2.0
// How the life of a system begins and ends: initialize, start, stop, finalize. What happens in between:
// executive.cpp.
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/table/system_check.hpp"

namespace mamori {

bool Executive::is_any_running() const noexcept {
    for (const detail::WindowState& state : windows_) {
        if (state.context.is_running()) {
            return true;
        }
    }
    return false;
}

Status Executive::initialize_components() noexcept {
    for (std::size_t i = 0U; i < view_.components.size(); ++i) {
        Component& component = *view_.components[i];
        if (!is_own(view_.component_rows[i].window) || component.is_alive()) {
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

Status Executive::attach_contexts() noexcept {
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        const WindowRow& row = view_.windows[w];
        if (!is_own(w)) {
            continue;
        }
        const Span<Component* const> participants =
            view_.components.subspan(row.first_component, row.component_count);
        ContextPlan plan{};
        plan.period = row.period;
        plan.alternative_periods = {row.alternative_periods.data(), row.alternative_count};
        plan.kind = row.kind;
        plan.abort_policy = view_.abort_policy;
        plan.trigger = row.trigger;
        plan.events_per_cycle = row.events_per_cycle;
        const Status result = windows_[w].context.attach(static_cast<std::int32_t>(w), participants, plan);
        if (result != Status::kOk) {
            failed_component_ = row.first_component;
            for (std::size_t attached = 0U; attached < w; ++attached) {
                // Cannot be refused where it is attached: nothing has been started yet.
                static_cast<void>(windows_[attached].context.detach());
            }
            return result;
        }
    }
    return Status::kOk;
}

void Executive::attach_inputs() noexcept {
    for (const ConnectionRow& connection : view_.connections) {
        if (is_own(connection.sink_window)) {
            connection.sink->set_age_limits(connection.age_max, connection.lead_max);
        }
    }
}

/// Every value that a port holds, or that waits for an input, is of an earlier run.
void Executive::clear_ports() noexcept {
    for (const PortRow& port : view_.ports) {
        if (port.output != nullptr && is_own(port.window)) {
            port.output->begin_run();
        }
    }
    for (const ConnectionRow& connection : view_.connections) {
        if (is_own(connection.sink_window)) {
            connection.operations.clear(*connection.source, *connection.sink, connection.crossing);
        }
    }
}

Status Executive::initialize() noexcept {
    if (is_initialized_ || is_busy_) {
        return Status::kPreconditionNotMet;
    }
    failed_component_ = kNoIndex;
    is_table_sound_ = check(view_).rule == Rule::kNone;
    if (!is_table_sound_) {
        return Status::kBadParameter;
    }
    is_busy_ = true;
    Status result = prepare_parameters();
    if (result == Status::kOk) {
        result = initialize_components();
    }
    if (result == Status::kOk) {
        result = attach_contexts();
    }
    if (result == Status::kOk) {
        prepare_work();
        attach_inputs();
    }
    is_initialized_ = result == Status::kOk;
    is_busy_ = false;
    show_windows();
    return result;
}

Status Executive::start_all() noexcept {
    clear_ports();
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        ExecutionContext& context = windows_[w].context;
        if (!is_own(w)) {
            continue;
        }
        const Status result = context.start(last_release_);
        if (result != Status::kOk) {
            failed_component_ =
                view_.windows[w].first_component + context.get_refusing_position().get_value();
            return result;
        }
    }
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        const WindowRow& row = view_.windows[w];
        ExecutionContext& context = windows_[w].context;
        for (std::size_t i = row.first_component; is_own(w) && i < row.first_component + row.component_count;
             ++i) {
            if ((view_.component_rows[i].modes & held_modes_) != held_modes_) {
                continue;
            }
            const Status result = context.activate_component(*view_.components[i], last_release_);
            if (result != Status::kOk) {
                failed_component_ = i;
                return result;
            }
        }
    }
    return Status::kOk;
}

Status Executive::start() noexcept {
    if (!is_initialized_ || is_busy_ || is_any_running()) {
        return Status::kPreconditionNotMet;
    }
    is_busy_ = true;
    failed_component_ = kNoIndex;
    Status result = join_modes();
    if (result != Status::kOk) {
        is_busy_ = false;
        return result;
    }
    result = start_all();
    if (result != Status::kOk) {
        // The refusal is what the caller must hear; a second failure would only hide it.
        static_cast<void>(stop_all());
    }
    is_busy_ = false;
    show_windows();
    return result;
}

Status Executive::stop_all() noexcept {
    Status first_failure = Status::kOk;
    const auto note = [&first_failure](Status result) noexcept {
        if (first_failure == Status::kOk) {
            first_failure = result;
        }
    };
    for (std::size_t w = view_.windows.size(); w-- > 0U;) {
        const WindowRow& row = view_.windows[w];
        ExecutionContext& context = windows_[w].context;
        static_cast<void>(readmit(windows_[w]));
        for (std::size_t i = context.get_participant_count(); i-- > 0U;) {
            if (context.get_state_at(i) == LifecycleState::kActive) {
                note(context.deactivate_component(*view_.components[row.first_component + i], last_release_));
            }
        }
        if (context.is_running()) {
            note(context.stop(last_release_));
        }
        windows_[w].is_stop_due = context.is_running();
    }
    if (has_joined_) {
        has_joined_ = false;
        modes_->leave(core_);
    }
    return first_failure;
}

Status Executive::stop() noexcept {
    if (!is_initialized_ || is_busy_) {
        return Status::kPreconditionNotMet;
    }
    is_busy_ = true;
    const Status result = stop_all();
    is_busy_ = false;
    show_windows();
    return result;
}

Status Executive::finalize() noexcept {
    if (!is_initialized_ || is_busy_ || is_any_running()) {
        return Status::kPreconditionNotMet;
    }
    for (const detail::WindowState& state : windows_) {
        for (std::size_t i = 0U; i < state.context.get_participant_count(); ++i) {
            if (state.context.get_state_at(i) == LifecycleState::kActive) {
                return Status::kPreconditionNotMet;
            }
        }
    }
    is_busy_ = true;
    is_initialized_ = false;
    for (detail::WindowState& state : windows_) {
        // Cannot be refused where it is attached: nothing runs and nothing is Active.
        static_cast<void>(state.context.detach());
    }
    Status first_failure = Status::kOk;
    for (std::size_t i = view_.components.size(); i-- > 0U;) {
        if (!is_own(view_.component_rows[i].window)) {
            continue;
        }
        // One whose life was ended by exit() has nothing left to finalize.
        const Status result = view_.components[i]->is_alive() ? view_.components[i]->finalize() : Status::kOk;
        if (first_failure == Status::kOk) {
            first_failure = result;
        }
    }
    is_busy_ = false;
    show_windows();
    return first_failure;
}

/// Carries out what stop() could not, under the budget of the window; goes on in the next opening when that
/// is used up.
void Executive::stop_late(detail::WindowState& state, Instant opened, WindowHost& host) noexcept {
    const WindowRow& row = view_.windows[state.window];
    const std::size_t stopped = host.run_within({&stop_steps, &state, state.window, row.first_component, 0U,
                                                 row.component_count, WindowHost::Pass::kModeStep},
                                                opened + row.budget);
    if (stopped < row.component_count) {
        static_cast<void>(end_overrun(state.window, row.first_component + stopped, host));
        return;
    }
    discard_outputs(state.window);
    static_cast<void>(state.context.stop(state.release));
    state.is_stop_due = state.context.is_running();
}

void Executive::stop_steps(void* argument, std::size_t first, std::size_t end) noexcept {
    detail::WindowState& state = *static_cast<detail::WindowState*>(argument);
    const SystemView& view = state.executive->view_;
    for (std::size_t i = first; i < end; ++i) {
        if (state.context.get_state_at(i) == LifecycleState::kActive) {
            const Component& component = *view.components[view.windows[state.window].first_component + i];
            static_cast<void>(state.context.deactivate_component(component, state.release));
        }
    }
}

}  // namespace mamori

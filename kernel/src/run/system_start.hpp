// SPDX-License-Identifier: Apache-2.0
/// @file
/// Operations of SystemLife, for direct calls of the actions and for calls under a guard.
#ifndef MAMORI_KERNEL_SRC_SYSTEM_START_HPP
#define MAMORI_KERNEL_SRC_SYSTEM_START_HPP

#include "mamori/kernel/run/action_guard.hpp"
#include "mamori/kernel/run/detail/system_life.hpp"

namespace mamori::detail {

inline Status initialize_component(const CoreState& core, std::size_t component) noexcept {
    return core.view.components[component]->initialize();
}
inline Status finalize_component(const CoreState& core, std::size_t component) noexcept {
    return core.view.components[component]->finalize();
}
/// The same under a guard. @return also kError (it has not returned in time), and kPreconditionNotMet (an
/// earlier action of the window has not).
Status initialize_component(const CoreState& core, std::size_t component, ActionGuard& guard) noexcept;
Status finalize_component(const CoreState& core, std::size_t component, ActionGuard& guard) noexcept;

template <typename... Guard>
Status SystemLife::initialize_components(Guard&... guard) noexcept {
    const CoreState& core = get_core();
    for (std::size_t i = 0U; i < core.view.components.size(); ++i) {
        if (!core.is_own(core.view.component_rows[i].window) || core.view.components[i]->is_alive()) {
            continue;
        }
        const Status result = initialize_component(core, i, guard...);
        if (result != Status::kOk) {
            failed_component_ = i;
            return result;
        }
    }
    return Status::kOk;
}

template <typename... Guard>
Status SystemLife::initialize(Guard&... guard) noexcept {
    Status result = prepare_initialization();
    if (result == Status::kOk) {
        result = initialize_components(guard...);
    }
    if (result == Status::kOk) {
        result = attach_contexts();
    }
    if (result == Status::kOk) {
        runner_.get_data_flow().attach_inputs();
    }
    is_initialized_ = result == Status::kOk;
    return result;
}

template <typename... Guard>
Status SystemLife::start_contexts(Guard&... guard) noexcept {
    CoreState& core = get_core();
    for (std::size_t w = 0U; w < core.view.windows.size(); ++w) {
        ExecutionContext& context = core.windows[w].context;
        if (!core.is_own(w)) {
            continue;
        }
        const Status result = context.start(core.release, guard...);
        if (result != Status::kOk) {
            failed_component_ =
                core.view.windows[w].first_component + context.get_refusing_position().get_value();
            return result;
        }
    }
    return Status::kOk;
}

template <typename... Guard>
Status SystemLife::activate_components(Guard&... guard) noexcept {
    CoreState& core = get_core();
    const ModeMask held = runner_.get_modes().get_held_modes();
    for (std::size_t i = 0U; i < core.view.components.size(); ++i) {
        const ComponentRow& row = core.view.component_rows[i];
        if (!core.is_own(row.window) || (row.modes & held) != held) {
            continue;
        }
        ExecutionContext& context = core.windows[row.window].context;
        const Status result = context.activate_component(*core.view.components[i], core.release, guard...);
        if (result != Status::kOk) {
            failed_component_ = i;
            return result;
        }
    }
    return Status::kOk;
}

template <typename... Guard>
Status SystemLife::start(Guard&... guard) noexcept {
    failed_component_ = find_component_without_context();
    if (failed_component_ != kNoIndex) {
        return Status::kPreconditionNotMet;
    }
    Status result = runner_.get_modes().join();
    if (result != Status::kOk) {
        return result;
    }
    runner_.get_data_flow().clear_ports();
    result = start_contexts(guard...);
    if (result == Status::kOk) {
        result = activate_components(guard...);
    }
    if (result != Status::kOk) {
        // The caller must receive the first failure, so a failure of the stop is ignored.
        static_cast<void>(stop_windows(guard...));
    }
    return result;
}

template <typename... Guard>
Status SystemLife::stop(Guard&... guard) noexcept {
    static_cast<void>(is_any_in_use());  // for its readmissions
    return stop_windows(guard...);
}

template <typename... Guard>
Status SystemLife::stop_windows(Guard&... guard) noexcept {
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
        for (std::size_t i = state.context.get_participant_count(); i-- > 0U;) {
            if (state.context.get_state_at(i) == LifecycleState::kActive) {
                const Component& component = *core.view.components[row.first_component + i];
                keep_first(state.context.deactivate_component(component, core.release, guard...));
            }
        }
        if (state.context.is_running()) {
            keep_first(state.context.stop(core.release, guard...));
        }
        state.is_stop_due = state.context.is_running();
    }
    runner_.get_modes().leave();
    return first_failure;
}

template <typename... Guard>
Status SystemLife::finalize(Guard&... guard) noexcept {
    CoreState& core = get_core();
    is_initialized_ = false;
    runner_.get_data_flow().detach_inputs();
    for (WindowState& state : core.windows) {
        // Not rejected where it is attached: nothing runs and no component is Active.
        static_cast<void>(state.context.detach());
    }
    Status first_failure = Status::kOk;
    for (std::size_t i = core.view.components.size(); i-- > 0U;) {
        // A component that exit() ended has nothing left to finalize.
        if (!core.is_own(core.view.component_rows[i].window) || !core.view.components[i]->is_alive()) {
            continue;
        }
        const Status result = finalize_component(core, i, guard...);
        if (first_failure == Status::kOk) {
            first_failure = result;
        }
    }
    return first_failure;
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_SRC_SYSTEM_START_HPP

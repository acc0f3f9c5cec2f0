// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/executive.hpp"

namespace mamori {

/// One component's place in a cycle, carried through the host as the argument of its work. It is read before
/// the action is called, so work that is abandoned later does not refer to it any more.
struct Executive::ComponentRun {
    ExecutionContext& context;
    std::size_t position;

    static void execute(void* argument) noexcept {
        const ComponentRun& run = *static_cast<const ComponentRun*>(argument);
        run.context.execute(run.position);
    }
    static void update_state(void* argument) noexcept {
        const ComponentRun& run = *static_cast<const ComponentRun*>(argument);
        run.context.update_state(run.position);
    }
};

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
        const Status result = component.is_alive() ? Status::kOk : component.initialize();
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
        const Span<Component* const> participants =
            view_.components.subspan(row.first_component, row.component_count);
        const Status result =
            windows_[w].context.attach(static_cast<std::int32_t>(w), participants, ContextPlan{view_.frame});
        if (result != Status::kOk) {
            failed_component_ = row.first_component;
            for (std::size_t attached = 0U; attached < w; ++attached) {
                // Cannot be refused: nothing has been started yet.
                static_cast<void>(windows_[attached].context.detach());
            }
            return result;
        }
    }
    return Status::kOk;
}

Status Executive::initialize() noexcept {
    if (is_initialized_ || is_busy_) {
        return Status::kPreconditionNotMet;
    }
    is_busy_ = true;
    failed_component_ = kNoIndex;
    Status result = initialize_components();
    if (result == Status::kOk) {
        result = attach_contexts();
    }
    is_initialized_ = result == Status::kOk;
    is_busy_ = false;
    return result;
}

Status Executive::start_all() noexcept {
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        ExecutionContext& context = windows_[w].context;
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
        for (std::size_t i = row.first_component; i < row.first_component + row.component_count; ++i) {
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
    const Status result = start_all();
    if (result != Status::kOk) {
        // The refusal is what the caller must hear; a second failure would only hide it.
        static_cast<void>(stop_all());
    }
    is_busy_ = false;
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
        for (std::size_t i = row.component_count; i-- > 0U;) {
            const Component& component = *view_.components[row.first_component + i];
            if (context.get_component_state(component).get_value() == LifecycleState::kActive) {
                note(context.deactivate_component(component, last_release_));
            }
        }
        if (context.is_running()) {
            note(context.stop(last_release_));
        }
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
    return result;
}

Status Executive::finalize() noexcept {
    if (!is_initialized_ || is_busy_ || is_any_running()) {
        return Status::kPreconditionNotMet;
    }
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        const WindowRow& row = view_.windows[w];
        for (std::size_t i = row.first_component; i < row.first_component + row.component_count; ++i) {
            const auto state = windows_[w].context.get_component_state(*view_.components[i]);
            if (state.get_value() == LifecycleState::kActive) {
                return Status::kPreconditionNotMet;
            }
        }
    }
    is_busy_ = true;
    is_initialized_ = false;
    for (detail::WindowState& state : windows_) {
        // Cannot be refused: nothing runs and nothing is Active.
        static_cast<void>(state.context.detach());
    }
    Status first_failure = Status::kOk;
    for (std::size_t i = view_.components.size(); i-- > 0U;) {
        const Status result = view_.components[i]->finalize();
        if (first_failure == Status::kOk) {
            first_failure = result;
        }
    }
    is_busy_ = false;
    return first_failure;
}

void Executive::latch_inputs(std::size_t window) noexcept {
    for (const ConnectionRow& connection : view_.connections) {
        if (connection.sink_window == window) {
            connection.latch(*connection.source, *connection.sink);
        }
    }
}

void Executive::hand_on_outputs(std::size_t component, Instant now) noexcept {
    for (const ConnectionRow& connection : view_.connections) {
        if (connection.is_forward_in_window && connection.source_component == component) {
            connection.hand_on(*connection.source, *connection.sink, now);
        }
    }
}

void Executive::mark_inputs_read(std::size_t window, std::size_t finished_count) noexcept {
    const std::size_t end = view_.windows[window].first_component + finished_count;
    for (const PortRow& port : view_.ports) {
        if (port.window != window || port.input == nullptr || port.component >= end) {
            continue;
        }
        const LifecycleState state = windows_[window].context.get_component_state(*port.owner).get_value();
        if (state == LifecycleState::kActive || state == LifecycleState::kError) {
            port.input->mark_read();
        }
    }
}

void Executive::publish_outputs(std::size_t window, Instant now) noexcept {
    for (std::size_t i = 0U; i < view_.ports.size(); ++i) {
        const PortRow& port = view_.ports[i];
        if (port.window == window && port.output != nullptr && port.output->publish(now)) {
            trace_hash_(static_cast<std::uint64_t>(i));
            port.output->hash_into(trace_hash_);
        }
    }
}

void Executive::discard_outputs(std::size_t window) noexcept {
    for (const PortRow& port : view_.ports) {
        if (port.window == window && port.output != nullptr) {
            port.output->discard();
        }
    }
}

void Executive::report_overrun(std::size_t window, std::size_t component, Instant now) noexcept {
    if (observer_ != nullptr) {
        observer_->on_budget_overrun(window, component, now);
    }
}

bool Executive::run_first_pass(std::size_t window, std::size_t position, Instant deadline,
                               WindowHost& host) noexcept {
    const std::size_t component = view_.windows[window].first_component + position;
    // Only on_execute is a sign of life: one in Error, or Inactive, gets its turn and does nothing for
    // anybody.
    const ExecutionContext& context = windows_[window].context;
    const bool is_executing =
        context.get_component_state(*view_.components[component]).get_value() == LifecycleState::kActive;
    ExecutionObserver* const listener = is_executing ? observer_ : nullptr;
    if (listener != nullptr) {
        listener->on_component_started(component, host.get_now());
    }
    ComponentRun run{windows_[window].context, position};
    if (!host.run_within(component, {&ComponentRun::execute, &run, WindowHost::Pass::kExecute}, deadline)) {
        report_overrun(window, component, host.get_now());
        return false;
    }
    if (listener != nullptr) {
        listener->on_component_finished(component, host.get_now());
    }
    return true;
}

bool Executive::run_second_pass(std::size_t window, std::size_t position, Instant deadline,
                                WindowHost& host) noexcept {
    const std::size_t component = view_.windows[window].first_component + position;
    ComponentRun run{windows_[window].context, position};
    if (!host.run_within(component, {&ComponentRun::update_state, &run, WindowHost::Pass::kStateUpdate},
                         deadline)) {
        report_overrun(window, component, host.get_now());
        return false;
    }
    return true;
}

WindowOutcome Executive::run_open_window(std::size_t window, Instant release, WindowHost& host) noexcept {
    const WindowRow& row = view_.windows[window];
    detail::WindowState& state = windows_[window];
    const Instant opened = host.get_now();
    if (observer_ != nullptr && opened > release) {
        observer_->on_late_release(window, opened - release, opened);
    }
    const Result<std::size_t> hanging = state.context.get_acting_position();
    if (hanging.has_value()) {
        report_overrun(window, row.first_component + hanging.get_value(), opened);
        return WindowOutcome::kOverrun;
    }
    const Status begun = state.context.begin_cycle(release);
    MAMORI_INVARIANT(1, begun == Status::kOk);
    if (state.has_abandoned_outputs) {
        discard_outputs(window);
        state.has_abandoned_outputs = false;
    }
    latch_inputs(window);
    // A window that opens late keeps its budget, but not beyond its planned close.
    const Instant close = release + row.length;
    const Instant deadline = opened + row.budget < close ? opened + row.budget : close;
    std::size_t finished_count = 0U;
    while (finished_count < row.component_count && run_first_pass(window, finished_count, deadline, host)) {
        hand_on_outputs(row.first_component + finished_count, release);
        ++finished_count;
    }
    bool is_complete = finished_count == row.component_count;
    for (std::size_t i = 0U; i < row.component_count && is_complete; ++i) {
        is_complete = run_second_pass(window, i, deadline, host);
    }
    state.context.end_cycle();
    mark_inputs_read(window, finished_count);
    if (is_complete) {
        publish_outputs(window, close);
        return WindowOutcome::kCompleted;
    }
    state.has_abandoned_outputs = state.context.get_acting_position().has_value();
    if (!state.has_abandoned_outputs) {
        discard_outputs(window);
    }
    return WindowOutcome::kOverrun;
}

WindowOutcome Executive::run_window(std::size_t index, Instant release, WindowHost& host) noexcept {
    MAMORI_REQUIRE(2, !is_busy_);
    MAMORI_REQUIRE(3, release <= host.get_now());
    if (!windows_[index].context.is_running()) {
        return WindowOutcome::kStopped;
    }
    is_busy_ = true;
    last_release_ = release;
    const WindowOutcome outcome = run_open_window(index, release, host);
    is_busy_ = false;
    return outcome;
}

}  // namespace mamori

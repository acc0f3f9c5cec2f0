// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/executive.hpp"

namespace mamori {

/// One component's place in a cycle, carried through the host as the argument of its work.
struct Executive::ComponentRun {
    ExecutionContext& context;
    std::size_t position;

    static void execute(void* argument) noexcept {
        const ComponentRun& run = *static_cast<const ComponentRun*>(argument);
        run.context.execute(run.position);
    }
};

Status Executive::initialize() noexcept {
    if (is_initialized_) {
        return Status::kPreconditionNotMet;
    }
    for (std::size_t i = 0U; i < view_.components.size(); ++i) {
        const Status result = view_.components[i]->initialize();
        if (result != Status::kOk) {
            failed_component_ = i;
            return result;
        }
    }
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        const WindowRow& row = view_.windows[w];
        const Span<Component* const> participants{view_.components.data() + row.first_component,
                                                  row.component_count};
        const Status result = contexts_[w].attach(static_cast<std::int32_t>(w), participants, view_.frame);
        if (result != Status::kOk) {
            failed_component_ = row.first_component;
            return result;
        }
    }
    is_initialized_ = true;
    return Status::kOk;
}

Status Executive::start() noexcept {
    if (!is_initialized_) {
        return Status::kPreconditionNotMet;
    }
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        const WindowRow& row = view_.windows[w];
        Status result = contexts_[w].start(Instant{});
        for (std::size_t i = 0U; i < row.component_count && result == Status::kOk; ++i) {
            failed_component_ = row.first_component + i;
            result = contexts_[w].activate_component(*view_.components[failed_component_], Instant{});
        }
        if (result != Status::kOk) {
            return result;
        }
    }
    failed_component_ = kNoIndex;
    return Status::kOk;
}

Status Executive::stop() noexcept {
    if (!is_initialized_) {
        return Status::kPreconditionNotMet;
    }
    Status first_failure = Status::kOk;
    const auto note = [&first_failure](Status result) noexcept {
        if (first_failure == Status::kOk) {
            first_failure = result;
        }
    };
    for (std::size_t w = view_.windows.size(); w-- > 0U;) {
        const WindowRow& row = view_.windows[w];
        for (std::size_t i = row.component_count; i-- > 0U;) {
            const Component& component = *view_.components[row.first_component + i];
            if (contexts_[w].get_component_state(component).get_value() == LifecycleState::kActive) {
                note(contexts_[w].deactivate_component(component, Instant{}));
            }
        }
        if (contexts_[w].is_running()) {
            note(contexts_[w].stop(Instant{}));
        }
    }
    return first_failure;
}

void Executive::latch_inputs(std::size_t window) noexcept {
    for (const ConnectionRow& connection : view_.connections) {
        // A value that is handed on within the window was never older than this one's publication.
        if (connection.sink_window == window && !connection.is_forward_in_window) {
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

void Executive::close_window(std::size_t window, bool is_complete, Instant now) noexcept {
    for (std::size_t i = 0U; i < view_.ports.size(); ++i) {
        const PortRow& port = view_.ports[i];
        if (port.window != window) {
            continue;
        }
        if (port.input != nullptr) {
            port.input->mark_read();
        } else if (!is_complete) {
            port.output->discard();
        } else if (port.output->publish(now)) {
            trace_hash_(static_cast<std::uint64_t>(i));
            port.output->hash_into(trace_hash_);
        }
    }
}

bool Executive::run_component(std::size_t window, std::size_t position, Instant deadline,
                              WindowHost& host) noexcept {
    const std::size_t component = view_.windows[window].first_component + position;
    if (observer_ != nullptr) {
        observer_->on_component_started(component, host.get_now());
    }
    ComponentRun run{contexts_[window], position};
    const bool is_in_time = host.run_within(component, {&ComponentRun::execute, &run}, deadline);
    if (observer_ != nullptr) {
        if (is_in_time) {
            observer_->on_component_finished(component, host.get_now());
        } else {
            observer_->on_budget_overrun(window, component, host.get_now());
        }
    }
    return is_in_time;
}

WindowOutcome Executive::run_window(std::size_t index, WindowHost& host) noexcept {
    const WindowRow& row = view_.windows[index];
    ExecutionContext& context = contexts_[index];
    const Instant opened = host.get_now();
    if (context.begin_cycle(opened) != Status::kOk) {
        return WindowOutcome::kStopped;
    }
    latch_inputs(index);
    bool is_complete = true;
    for (std::size_t i = 0U; i < row.component_count && is_complete; ++i) {
        is_complete = run_component(index, i, opened + row.budget, host);
        if (is_complete) {
            hand_on_outputs(row.first_component + i, opened);
        }
    }
    for (std::size_t i = 0U; i < row.component_count && is_complete; ++i) {
        context.update_state(i);
    }
    context.end_cycle();
    // Logical execution time: the instant of publication is the close of the window, however long the code
    // took.
    close_window(index, is_complete, opened + row.length);
    return is_complete ? WindowOutcome::kCompleted : WindowOutcome::kOverrun;
}

}  // namespace mamori

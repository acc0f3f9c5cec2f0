// SPDX-License-Identifier: Apache-2.0
// How a window is run. How the system gets there: executive_life.cpp; its modes: executive_modes.cpp.
#include "mamori/kernel/run/executive.hpp"

#include "mamori/kernel/run/introspection.hpp"

namespace mamori {

using Pass = WindowHost::Pass;

namespace {

/// The first pass of a window that nobody follows.
void execute_unfollowed(void* argument, std::size_t first, std::size_t end) noexcept {
    static_cast<detail::WindowState*>(argument)->context.execute_range(first, end - first);
}

}  // namespace

/// What the first pass of each window is for as long as the same listeners follow it.
void Executive::prepare_work() noexcept {
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        const WindowRow& row = view_.windows[w];
        detail::WindowState& state = windows_[w];
        state.executive = this;
        state.window = w;
        state.is_followed = records_ != nullptr || row.has_hand_on;
        state.first_pass = {state.is_followed ? &execute_steps : &execute_unfollowed,
                            &state,
                            w,
                            row.first_component,
                            0U,
                            row.component_count,
                            Pass::kExecute};
    }
}

void Executive::set_observer(ExecutionObserver* observer) noexcept {
    MAMORI_REQUIRE(5, !is_busy_);
    observer_ = observer;
    const Span<ExecutionRecord> records =
        observer == nullptr ? Span<ExecutionRecord>{} : observer->get_records();
    MAMORI_REQUIRE(4, records.empty() || records.size() >= view_.components.size());
    records_ = records.data();
    prepare_work();
}

void Executive::latch_inputs(const WindowRow& row, ModeMask held) noexcept {
    for (const std::size_t i : view_.latch_order.subspan(row.first_latch, row.latch_count)) {
        const ConnectionRow& connection = view_.connections[i];
        if (is_held(connection, held)) {
            connection.operations.latch(*connection.source, *connection.sink, connection.crossing,
                                        last_release_);
        }
    }
}

void Executive::hand_on_outputs(std::size_t component, Instant opening, ModeMask held) noexcept {
    const ComponentRow& row = view_.component_rows[component];
    for (const std::size_t i : view_.outgoing_order.subspan(row.first_outgoing, row.outgoing_count)) {
        const ConnectionRow& connection = view_.connections[i];
        if (connection.is_forward_in_window && connection.operations.hand_on != nullptr &&
            is_held(connection, held)) {
            connection.operations.hand_on(*connection.source, *connection.sink, opening);
        }
    }
}

void Executive::mark_inputs_read(const WindowRow& row, const ExecutionContext& context,
                                 std::size_t finished_count) noexcept {
    for (const PortRow& port : view_.ports.subspan(row.first_port, row.port_count)) {
        const std::size_t position = port.component - row.first_component;
        if (port.input == nullptr || position >= finished_count) {
            continue;
        }
        const LifecycleState state = context.get_state_at(position);
        if (state == LifecycleState::kActive || state == LifecycleState::kError) {
            port.input->mark_read();
        }
    }
}

void Executive::publish_outputs(const WindowRow& row, ModeMask held, Instant close) noexcept {
    for (std::size_t p = row.first_port; p < row.first_port + row.port_count; ++p) {
        const PortRow& port = view_.ports[p];
        if (port.output == nullptr || !port.output->publish(close)) {
            continue;
        }
        trace_hash_(static_cast<std::uint64_t>(p));
        port.output->hash_into(trace_hash_);
        deliver(port, held);
    }
}

void Executive::deliver(const PortRow& port, ModeMask held) noexcept {
    const ComponentRow& owner = view_.component_rows[port.component];
    for (const std::size_t i : view_.outgoing_order.subspan(owner.first_outgoing, owner.outgoing_count)) {
        const ConnectionRow& connection = view_.connections[i];
        if (connection.source == port.output && connection.operations.deliver != nullptr &&
            is_held(connection, held)) {
            connection.operations.deliver(*port.output, *connection.sink, connection.crossing);
        }
    }
}

void Executive::discard_outputs(std::size_t window) noexcept {
    const WindowRow& row = view_.windows[window];
    for (const PortRow& port : view_.ports.subspan(row.first_port, row.port_count)) {
        if (port.output != nullptr) {
            port.output->discard();
        }
    }
}

void Executive::discard_outputs_of(std::size_t component) noexcept {
    const ComponentRow& row = view_.component_rows[component];
    for (const PortRow& port : view_.ports.subspan(row.first_port, row.port_count)) {
        if (port.output != nullptr) {
            port.output->discard();
        }
    }
}

void Executive::report_overrun(std::size_t window, std::size_t component, Instant now) noexcept {
    if (observer_ != nullptr) {
        observer_->on_budget_overrun(window, component, now);
    }
}

void Executive::execute_steps(void* argument, std::size_t first, std::size_t end) noexcept {
    detail::WindowState& state = *static_cast<detail::WindowState*>(argument);
    state.context.execute_range(first, end - first, &state.follower);
}

void Executive::follow_step(void* argument, std::size_t position, Duration used) noexcept {
    const detail::WindowState& state = *static_cast<const detail::WindowState*>(argument);
    Executive& self = *state.executive;
    const WindowRow& row = self.view_.windows[state.window];
    const std::size_t component = row.first_component + position;
    if (self.introspection_ != nullptr && used >= Duration{0}) {
        self.introspection_->note_used(component, used);
    }
    if (row.has_hand_on) {
        self.hand_on_outputs(component, state.release, state.held_modes);
    }
}

void Executive::update_steps(void* argument, std::size_t first, std::size_t end) noexcept {
    static_cast<detail::WindowState*>(argument)->context.update_range(first, end - first);
}

/// The part of an opening that its budget covers. `deadline` is where that ends, `opened` where it began.
/// @return the component that used the budget up; kNoIndex when everything came through.
std::size_t Executive::run_cycle(const WindowRow& row, detail::WindowState& state, Instant opened,
                                 Instant deadline, WindowHost& host) noexcept {
    const Status begun = state.context.begin_cycle(last_release_);
    MAMORI_INVARIANT(1, begun == Status::kOk);
    if (row.latch_count != 0U) {
        latch_inputs(row, state.held_modes);
    }
    if (state.is_followed) {
        state.follower = {records_ == nullptr ? nullptr : records_ + row.first_component,
                          &host,
                          deadline,
                          last_step_end_ > opened ? last_step_end_ : opened,
                          row.has_hand_on || introspection_ != nullptr ? &follow_step : nullptr,
                          &state};
    }
    const std::size_t executed_count = host.run_within(state.first_pass, deadline);
    std::size_t finished_count = executed_count;
    if (row.has_second_pass && executed_count == row.component_count) {
        finished_count = host.run_within({&update_steps, &state, state.window, row.first_component, 0U,
                                          row.component_count, Pass::kStateUpdate},
                                         deadline);
    }
    const bool is_through = finished_count == row.component_count;
    if (is_through) {
        state.context.end_cycle();
    } else {
        state.context.abandon(finished_count);
    }
    if (row.port_count != 0U) {
        mark_inputs_read(row, state.context, executed_count);
    }
    if (introspection_ != nullptr) {
        introspection_->note_turns(state.window, executed_count, state.context);
    }
    return is_through ? kNoIndex : row.first_component + finished_count;
}

WindowOutcome Executive::run_open_window(const WindowRow& row, detail::WindowState& state, Instant opened,
                                         WindowHost& host) noexcept {
    const Instant release = last_release_;
    if (observer_ != nullptr && opened > release) {
        observer_->on_late_release(state.window, opened - release, opened);
    }
    state.release = release;
    if ((state.context.is_busy() || state.is_stop_due) && !may_open(state, opened, host)) {
        return state.context.is_running() ? WindowOutcome::kOverrun : WindowOutcome::kStopped;
    }
    // A window that opens late keeps its budget, but not beyond its planned close.
    const Instant close = release + row.length;
    if (opened > close) {
        return WindowOutcome::kMissed;
    }
    const Instant deadline = opened + row.budget < close ? opened + row.budget : close;
    std::size_t guilty = kNoIndex;
    if (modes_ != nullptr) {
        cross_boundary(state.window);
        guilty = leave_components(state.window, deadline, host);
    }
    const bool is_due = guilty == kNoIndex && state.context.take_turn();
    if (is_due) {
        guilty = run_cycle(row, state, opened, deadline, host);
    }
    if (modes_ != nullptr && guilty == kNoIndex) {
        guilty = enter_components(state.window, deadline, host);
    }
    if (guilty != kNoIndex) {
        return end_overrun(state.window, guilty, host);
    }
    if (!is_due) {
        return WindowOutcome::kNotDue;
    }
    if (row.port_count != 0U) {
        publish_outputs(row, state.held_modes, close);
    }
    return WindowOutcome::kCompleted;
}

WindowOutcome Executive::end_overrun(std::size_t window, std::size_t component, WindowHost& host) noexcept {
    detail::WindowState& state = windows_[window];
    report_overrun(window, component, host.get_now());
    state.context.abandon(component - view_.windows[window].first_component);
    state.cut_by = &host;
    static_cast<void>(readmit(state));
    return WindowOutcome::kOverrun;
}

/// Takes a window that was cut off back once its work has returned; what that wrote is thrown away.
/// @return whether nobody is within its context any more.
bool Executive::readmit(detail::WindowState& state) noexcept {
    if (state.cut_by != nullptr && state.cut_by->has_returned(state.window)) {
        state.cut_by = nullptr;
        state.context.readmit();
        discard_outputs(state.window);
    }
    return !state.context.is_busy();
}

/// A window whose work was out, or that should have been stopped then. @return whether it opens as usual.
bool Executive::may_open(detail::WindowState& state, Instant opened, WindowHost& host) noexcept {
    if (!readmit(state)) {
        const std::size_t position = state.context.get_acting_position().get_value();
        report_overrun(state.window, view_.windows[state.window].first_component + position, opened);
        return false;
    }
    if (state.is_stop_due) {
        stop_late(state, opened, host);
    }
    return state.context.is_running() && !state.is_stop_due;
}

/// What changes for all windows of the core at once changes here, before the first window of a frame.
void Executive::begin_frame(Instant release) noexcept {
    frame_start_ = Instant{release.ns / view_.frame.ns * view_.frame.ns};
    for (detail::WindowState& state : windows_) {
        static_cast<void>(state.context.apply_pending_rate());
    }
    if (has_joined_) {
        begin_modes(frame_start_.ns / view_.frame.ns);
    }
}

WindowOutcome Executive::run_window(std::size_t index, Instant release, WindowHost& host) noexcept {
    MAMORI_REQUIRE(2, !is_busy_);
    const Instant opened = host.get_now();
    MAMORI_REQUIRE(3, release <= opened);
    const WindowRow& row = view_.windows[index];
    MAMORI_REQUIRE(6, row.core == core_);
    detail::WindowState& state = windows_[index];
    WindowOutcome outcome = WindowOutcome::kStopped;
    const bool is_running = state.context.is_running();
    if (is_running || has_joined_) {
        is_busy_ = true;
        last_release_ = release;
        if (release < frame_start_ || release - frame_start_ >= view_.frame) {
            begin_frame(release);
        }
        if (is_running) {
            outcome = run_open_window(row, state, opened, host);
        }
        is_busy_ = false;
    }
    if (introspection_ != nullptr && is_table_sound_) {
        show_opening(index, release, opened, outcome, host);
    }
    return outcome;
}

}  // namespace mamori

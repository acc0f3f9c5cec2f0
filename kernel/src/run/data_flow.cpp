// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/run/detail/data_flow.hpp"

namespace mamori::detail {

void DataFlow::attach_inputs() noexcept {
    for (const ConnectionRow& connection : core_.view.connections) {
        if (core_.is_own(connection.sink_window)) {
            connection.sink->set_age_limits(connection);
        }
    }
}

void DataFlow::detach_inputs() noexcept {
    for (const ConnectionRow& connection : core_.view.connections) {
        if (core_.is_own(connection.sink_window)) {
            connection.sink->reset_age_limits();
        }
    }
}

void DataFlow::clear_ports() noexcept {
    for (const PortRow& port : core_.view.ports) {
        if (port.output != nullptr && core_.is_own(port.window)) {
            note_discarded(port);
            port.output->begin_run();
        }
    }
    for (const ConnectionRow& connection : core_.view.connections) {
        if (core_.is_own(connection.sink_window)) {
            connection.operations.restart(connection, kBeforeAll);
        }
    }
}

void DataFlow::latch_inputs(const WindowRow& row, ModeMask held) noexcept {
    for (const std::size_t i : core_.view.latch_order.subspan(row.first_latch, row.latch_count)) {
        const ConnectionRow& connection = core_.view.connections[i];
        if (is_held(connection, held)) {
            connection.operations.latch(connection, core_.release);
        }
    }
}

void DataFlow::forward_outputs(const SystemView& view, std::size_t component, Instant release,
                               ModeMask held) noexcept {
    const ComponentRow& row = view.component_rows[component];
    for (const std::size_t i : view.outgoing_order.subspan(row.first_outgoing, row.outgoing_count)) {
        const ConnectionRow& connection = view.connections[i];
        if (connection.is_forward_in_window && connection.operations.hand_on != nullptr &&
            is_held(connection, held)) {
            connection.operations.hand_on(connection, release);
        }
    }
}

void DataFlow::mark_inputs_read(const WindowRow& row, const ExecutionContext& context,
                                std::size_t finished_count) noexcept {
    for (std::size_t position = 0U; position < finished_count; ++position) {
        const LifecycleState state = context.get_state_at(position);
        if (state == LifecycleState::kActive || state == LifecycleState::kError) {
            core_.view.components[row.first_component + position]->end_read_pass();
        }
    }
}

void DataFlow::publish_outputs(const WindowRow& row, ModeMask held, Instant end) noexcept {
    for (const PortRow& port : core_.view.ports.subspan(row.first_port, row.port_count)) {
        if (port.output != nullptr) {
            static_cast<void>(port.output->publish(end));
        }
    }
    if (core_.view.has_trace_hash) {
        hash_outputs(row, end);
    }
    if (row.has_deliveries) {
        for (const ComponentRow& owner :
             core_.view.component_rows.subspan(row.first_component, row.component_count)) {
            deliver_outputs(owner, held, end);
        }
    }
}

void DataFlow::hash_outputs(const WindowRow& row, Instant end) noexcept {
    std::size_t p = row.first_port;
    for (const PortRow& port : core_.view.ports.subspan(p, row.port_count)) {
        if (port.output != nullptr && port.output->was_published_at(end) && port.hash_published != nullptr) {
            trace_hash_(static_cast<std::uint64_t>(p));
            port.hash_published(*port.output, trace_hash_);
        }
        ++p;
    }
}

void DataFlow::deliver_outputs(const ComponentRow& owner, ModeMask held, Instant end) noexcept {
    for (const std::size_t i :
         core_.view.outgoing_order.subspan(owner.first_outgoing, owner.outgoing_count)) {
        const ConnectionRow& connection = core_.view.connections[i];
        if (connection.operations.deliver != nullptr && connection.source->was_published_at(end) &&
            is_held(connection, held)) {
            connection.operations.deliver(connection);
        }
    }
    report_losses(owner.first_port, owner.port_count);
}

void DataFlow::report_losses(std::size_t first, std::size_t count) noexcept {
    if (core_.observer == nullptr) {
        return;
    }
    std::size_t p = first;
    for (const PortRow& port : core_.view.ports.subspan(first, count)) {
        if (port.output != nullptr && port.output->take_loss(core_.frame_start)) {
            core_.observer->on_values_lost(p, core_.release);
        }
        ++p;
    }
}

void DataFlow::discard_outputs(std::size_t window) noexcept {
    const WindowRow& row = core_.view.windows[window];
    discard_ports(row.first_port, row.port_count);
}

void DataFlow::discard_outputs_of(std::size_t component) noexcept {
    const ComponentRow& row = core_.view.component_rows[component];
    discard_ports(row.first_port, row.port_count);
}

void DataFlow::discard_ports(std::size_t first, std::size_t count) noexcept {
    for (const PortRow& port : core_.view.ports.subspan(first, count)) {
        if (port.output != nullptr) {
            note_discarded(port);
            port.output->discard();
        }
    }
    report_losses(first, count);
}

void DataFlow::note_discarded(const PortRow& port) noexcept {
    const ComponentRow& owner = core_.view.component_rows[port.component];
    const ModeMask held = core_.windows[port.window].held_modes;
    for (const std::size_t i :
         core_.view.outgoing_order.subspan(owner.first_outgoing, owner.outgoing_count)) {
        const ConnectionRow& connection = core_.view.connections[i];
        if (connection.source == port.output && connection.operations.note_discarded != nullptr &&
            is_held(connection, held)) {
            connection.operations.note_discarded(connection);
        }
    }
}

void DataFlow::restart_inputs(WindowState& state, ModeMask modes) noexcept {
    const WindowRow& row = core_.view.windows[state.get_window()];
    const ModeMask before = state.held_modes;
    state.held_modes = modes;
    const Span<const std::size_t> latched = core_.view.latch_order.subspan(row.first_latch, row.latch_count);
    // Connections that end come first: in a switch to the safe mode, an input may change its source.
    for (const bool begins : {false, true}) {
        for (const std::size_t i : latched) {
            const ConnectionRow& connection = core_.view.connections[i];
            const bool was_held = is_held(connection, before);
            if (was_held != is_held(connection, modes) && was_held != begins) {
                connection.operations.restart(connection, core_.frame_start);
            }
        }
    }
}

}  // namespace mamori::detail

// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/run/introspection.hpp"

#include "mamori/kernel/run/detail/core_state.hpp"

namespace mamori {
namespace {

constexpr Duration calc_max(Duration a, Duration b) noexcept {
    return a < b ? b : a;
}

/// State of the component at `position` of a window, attached to its context or not.
LifecycleState get_state(const Component& component, const ExecutionContext& context,
                         std::size_t position) noexcept {
    if (position < context.get_participant_count()) {
        return context.get_state_at(position);
    }
    return component.is_alive() ? LifecycleState::kInactive : LifecycleState::kCreated;
}

}  // namespace

std::size_t Introspection::find_core_row(std::size_t core) const noexcept {
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        if (view_.windows[w].core == core) {
            return w;
        }
    }
    return kNoIndex;
}

void Introspection::publish_windows(const detail::CoreState& core, std::uint64_t trace_hash) noexcept {
    for (std::size_t w = 0U; w < core.view.windows.size(); ++w) {
        if (core.is_own(w)) {
            publish_window(w, core.windows[w].context, core.release, trace_hash);
        }
    }
}

/// Records the end of an instance of `window`. @param[in] lateness, used [ns] >= 0.
void Introspection::note_opening(std::size_t window, Duration lateness, Duration used,
                                 WindowOutcome outcome) noexcept {
    WindowSnapshot& row = windows_[window].kept;
    row.last_outcome = outcome;
    if (outcome != WindowOutcome::kStopped && lateness > Duration{0}) {
        ++row.late_releases;
        row.worst_lateness = calc_max(row.worst_lateness, lateness);
    }
    if (outcome == WindowOutcome::kCompleted || outcome == WindowOutcome::kOverrun) {
        ++row.cycles;
        row.overruns += outcome == WindowOutcome::kOverrun ? 1U : 0U;
        row.last_used = used;
        row.worst_used = calc_max(row.worst_used, used);
    }
}

void Introspection::count_turns(std::size_t window, std::size_t finished_count,
                                const ExecutionContext& context) noexcept {
    const std::size_t first = view_.windows[window].first_component;
    for (std::size_t i = 0U; i < finished_count; ++i) {
        const LifecycleState state = context.get_state_at(i);
        if (state == LifecycleState::kActive || state == LifecycleState::kError) {
            ++components_[first + i].kept.cycles;
        }
    }
}

void Introspection::raise_used(std::size_t component, Duration used) noexcept {
    ComponentSnapshot& row = components_[component].kept;
    row.worst_used = calc_max(row.worst_used, used);
}

void Introspection::publish_port(std::size_t index, Instant opening) noexcept {
    const PortRow& port = view_.ports[index];
    PortSnapshot row{};
    row.component = port.component;
    row.observed_at = opening;
    if (port.output != nullptr) {
        row.name = port.output->get_name();
        row.sequence = port.output->get_sequence();
        row.has_value = row.sequence != 0U;
        row.published_at = port.output->get_published_at();
        row.status = port.output->get_status();
        row.counts = port.output->get_counts();
    } else {
        row.name = port.input->get_name();
        row.is_input = true;
        row.has_value = port.input->has_value();
        row.published_at = port.input->get_published_at();
        row.status = port.input->calc_status(opening);
        row.counts = port.count(*port.input);
    }
    ports_[index].cell.write(row);
}

void Introspection::publish_component(std::size_t index, LifecycleState state, Instant opening) noexcept {
    const Component& component = *view_.components[index];
    const ComponentRow& table_row = view_.component_rows[index];
    ComponentSnapshot& row = components_[index].kept;
    row.name = component.get_name();
    row.window = table_row.window;
    row.observed_at = opening;
    row.state = state;
    row.last_failure = component.get_last_failure();
    components_[index].cell.write(row);
    for (std::size_t p = 0U; p < table_row.port_count; ++p) {
        publish_port(table_row.first_port + p, opening);
    }
}

/// Publishes the rows of `window`. @param[in] opening planned start of the last window instance.
/// @param[in] trace_hash of its core, after that instance.
void Introspection::publish_window(std::size_t window, const ExecutionContext& context, Instant opening,
                                   std::uint64_t trace_hash) noexcept {
    const WindowRow& table_row = view_.windows[window];
    const Result<std::size_t> hanging = context.get_acting_position();
    if (!hanging.has_value()) {
        for (std::size_t i = 0U; i < table_row.component_count; ++i) {
            const std::size_t index = table_row.first_component + i;
            publish_component(index, get_state(*view_.components[index], context, i), opening);
        }
    }
    WindowSnapshot& row = windows_[window].kept;
    row.name = table_row.name;
    row.core = table_row.core;
    row.observed_at = opening;
    row.budget = get_declared_budget(table_row);
    row.hanging_component = hanging.has_value() ? table_row.first_component + hanging.get_value() : kNoIndex;
    windows_[window].cell.write(row);
    const auto frame = static_cast<std::uint64_t>(opening.ns / view_.frame.ns);
    cores_[find_core_row(table_row.core)].cell.write({opening, frame, trace_hash});
}

}  // namespace mamori

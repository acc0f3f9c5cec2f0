// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of a safety table for the sources of the confirmations of its stops. Not for users.
///
/// @satisfies SWR-CYC-012      Design: docs/design/safety_cycle.md#the-table
#ifndef MAMORI_SAFETY_STOP_SOURCE_RULES_HPP
#define MAMORI_SAFETY_STOP_SOURCE_RULES_HPP

#include <cstddef>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/table/connection_row.hpp"
#include "mamori/kernel/table/window_row.hpp"
#include "mamori/safety/cycle/safety_finding.hpp"
#include "mamori/safety/cycle/safety_part.hpp"
#include "mamori/safety/reaction/reaction.hpp"

namespace mamori::safety::detail {

/// Whether a stop of the table needs the confirmation. Each stop can end in STO.
template <typename Table>
constexpr bool is_needed(const Table& table, StopConfirmation confirmation) noexcept {
    if (confirmation == StopConfirmation::kClosedBrakes && !table.cycle.brakes.has_contacts) {
        return false;
    }
    const bool is_standstill = confirmation == StopConfirmation::kStandstill;
    for (std::size_t i = 0U; i < table.reactions.size(); ++i) {
        const auto reaction = static_cast<Reaction>(table.reactions[i].reaction);
        const bool is_without_it = is_standstill && reaction == Reaction::kSto;
        if (reaction >= Reaction::kSs2 && !is_without_it) {
            return true;
        }
    }
    return false;
}

/// Index of the component that has the output; kNoIndex: none of the table.
template <typename Table>
constexpr std::size_t find_owner(const Table& table, const OutPortBase* output) noexcept {
    for (std::size_t i = 0U; i < table.ports.size(); ++i) {
        if (table.ports[i].output == output) {
            return table.ports[i].component;
        }
    }
    return kNoIndex;
}

template <typename Table>
constexpr bool is_supervised(const Table& table, const Component* component) noexcept {
    for (std::size_t i = 0U; i < table.supervised.size(); ++i) {
        if (table.supervised[i].watch.component == component) {
            return true;
        }
    }
    return false;
}

template <typename Table>
constexpr SafetyFinding check_stop_sources(const Table& table) noexcept {
    for (std::size_t c = 0U; c < kStopConfirmationCount; ++c) {
        std::size_t count = 0U;
        for (std::size_t i = 0U; i < table.stop_sources.size(); ++i) {
            count += table.stop_sources[i].confirms[c] ? 1U : 0U;
            if (count > 1U) {
                return {SafetyRule::kConfirmedByOnce, i};
            }
        }
        if (count == 0U && is_needed(table, static_cast<StopConfirmation>(c))) {
            return {SafetyRule::kStopConfirmed, c};
        }
    }
    for (std::size_t i = 0U; i < table.stop_sources.size(); ++i) {
        const std::size_t source = find_owner(table, table.stop_sources[i].port);
        if (source == kNoIndex) {
            return {SafetyRule::kSourceInTable, i};
        }
        if (!is_supervised(table, table.components[source])) {
            return {SafetyRule::kSourceSupervised, i};
        }
    }
    return {};
}

/// Whether each cycle finds a value of its own major frame. Both windows are on one core.
constexpr bool is_before(const WindowRow& source, const WindowRow& cycle) noexcept {
    return source.offset < cycle.offset && cycle.period.ns % source.period.ns == 0;
}

/// Rules of the sources that the cycle reads. @param[in] cycle index of its component.
template <typename Table>
constexpr SafetyFinding check_sources_of_cycle(const Table& table, std::size_t cycle) noexcept {
    for (std::size_t i = 0U; i < table.stop_sources.size(); ++i) {
        ModeMask modes = 0U;
        for (std::size_t c = 0U; c < table.connections.size(); ++c) {
            const ConnectionRow& row = table.connections[c];
            if (row.source != table.stop_sources[i].port || row.sink_component != cycle) {
                continue;
            }
            if (!row.is_forward_in_window &&
                !is_before(table.windows[row.source_window], table.windows[row.sink_window])) {
                return {SafetyRule::kSourceBeforeCycle, i};
            }
            modes |= row.get_modes();
        }
        if ((table.component_rows[cycle].modes & ~modes) != 0U) {
            return {SafetyRule::kSourceConnected, i};
        }
    }
    return {};
}

}  // namespace mamori::safety::detail

#endif  // MAMORI_SAFETY_STOP_SOURCE_RULES_HPP

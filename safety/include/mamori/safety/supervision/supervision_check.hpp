// SPDX-License-Identifier: Apache-2.0
/// @file
/// Proves a table of checkpoints while it is compiled: static_assert(is_sound<kTable>()). A table that has no
/// meaning, that no correct run can satisfy, or that leaves an entity unsupervised does not compile.
///
/// @satisfies SWR-SUP-033, SWR-SUP-034      Design: docs/design/supervision.md#checkpoint-table
#ifndef MAMORI_SAFETY_SUPERVISION_SUPERVISION_CHECK_HPP
#define MAMORI_SAFETY_SUPERVISION_SUPERVISION_CHECK_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/table/mode_mask.hpp"
#include "mamori/safety/supervision/checkpoint_log.hpp"
#include "mamori/safety/supervision/graph_check.hpp"
#include "mamori/safety/supervision/supervision_fault.hpp"
#include "mamori/safety/supervision/supervision_table.hpp"

namespace mamori::safety {

namespace detail {

constexpr SupervisionFinding find_entity_fault(const SupervisionTable& table) noexcept {
    if (table.entities.empty()) {
        return {SupervisionFault::kTableEmpty};
    }
    if (table.mode_count < 1U || table.mode_count > kSystemModeMax) {
        return {SupervisionFault::kModeCount};
    }
    ModeMask modes = 0U;
    for (std::size_t m = 0U; m < table.mode_count; ++m) {
        modes |= to_mask(m);
    }
    for (std::size_t i = 0U; i < table.entities.size(); ++i) {
        const EntityRow& row = table.entities[i];
        for (std::size_t j = 0U; j < i; ++j) {
            if (table.entities[j].entity == row.entity) {
                return {SupervisionFault::kEntityTwice, i, j};
            }
        }
        if (row.entity != i) {
            return {SupervisionFault::kEntityOutOfOrder, i};
        }
        if ((row.modes & modes) == 0U) {
            return {SupervisionFault::kEntityInNoMode, i};
        }
    }
    return {};
}

constexpr SupervisionFinding find_checkpoint_fault(const SupervisionTable& table) noexcept {
    for (std::size_t i = 0U; i < table.checkpoints.size(); ++i) {
        const CheckpointRow& row = table.checkpoints[i];
        for (std::size_t j = 0U; j < i; ++j) {
            if (table.checkpoints[j].checkpoint == row.checkpoint) {
                return {SupervisionFault::kCheckpointTwice, i, j};
            }
        }
        if (row.checkpoint != i) {
            return {SupervisionFault::kCheckpointOutOfOrder, i};
        }
        if (row.entity >= table.entities.size()) {
            return {SupervisionFault::kCheckpointOfUnknownEntity, i};
        }
    }
    return {};
}

constexpr SupervisionFault judge_count(const AliveCount& count) noexcept {
    if (count.expected == 0U || count.reference_cycles == 0U) {
        return SupervisionFault::kAliveNothingExpected;
    }
    if (count.min_margin >= count.expected) {
        return SupervisionFault::kAliveMargin;
    }
    if (count.get_most() > kPendingCheckpointsMax * count.reference_cycles) {
        return SupervisionFault::kAliveBeyondQueue;
    }
    return SupervisionFault::kNone;
}

constexpr SupervisionFinding find_alive_fault(const SupervisionTable& table) noexcept {
    for (std::size_t i = 0U; i < table.alives.size(); ++i) {
        const AliveRow& row = table.alives[i];
        if (row.checkpoint >= table.checkpoints.size()) {
            return {SupervisionFault::kAliveOfUnknownCheckpoint, i};
        }
        for (std::size_t j = 0U; j < i; ++j) {
            if (table.alives[j].checkpoint == row.checkpoint) {
                return {SupervisionFault::kAliveTwice, i, j};
            }
        }
        const SupervisionFault fault = judge_count(row.count);
        if (fault != SupervisionFault::kNone) {
            return {fault, i};
        }
    }
    return {};
}

constexpr SupervisionFault judge_deadline(const SupervisionTable& table, const DeadlineRow& row) noexcept {
    const std::size_t count = table.checkpoints.size();
    if (row.start >= count || row.finish >= count) {
        return SupervisionFault::kDeadlineOfUnknownCheckpoint;
    }
    if (row.start == row.finish) {
        return SupervisionFault::kDeadlineToItself;
    }
    if (table.checkpoints[row.start].entity != table.checkpoints[row.finish].entity) {
        return SupervisionFault::kDeadlineBetweenEntities;
    }
    return is_valid(row.limits) ? SupervisionFault::kNone : SupervisionFault::kDeadlineLimits;
}

constexpr SupervisionFinding find_deadline_fault(const SupervisionTable& table) noexcept {
    for (std::size_t i = 0U; i < table.deadlines.size(); ++i) {
        const DeadlineRow& row = table.deadlines[i];
        const SupervisionFault fault = judge_deadline(table, row);
        if (fault != SupervisionFault::kNone) {
            return {fault, i};
        }
        for (std::size_t j = 0U; j < i; ++j) {
            if (table.deadlines[j].start == row.start && table.deadlines[j].finish == row.finish) {
                return {SupervisionFault::kDeadlineTwice, i, j};
            }
        }
    }
    return {};
}

/// True when something is demanded of the checkpoint.
constexpr bool is_used(const SupervisionTable& table, const CheckpointRow& row) noexcept {
    bool is_demanded = row.role != CheckpointRole::kUnordered;
    for (const AliveRow& alive : table.alives) {
        is_demanded = is_demanded || alive.checkpoint == row.checkpoint;
    }
    for (const DeadlineRow& deadline : table.deadlines) {
        is_demanded = is_demanded || deadline.start == row.checkpoint || deadline.finish == row.checkpoint;
    }
    return is_demanded;
}

/// Where something is missing from the whole. For a table whose rows are valid in themselves.
constexpr SupervisionFinding find_gap(const SupervisionTable& table) noexcept {
    for (std::size_t i = 0U; i < table.checkpoints.size(); ++i) {
        if (!is_used(table, table.checkpoints[i])) {
            return {SupervisionFault::kCheckpointUnused, i};
        }
    }
    for (std::size_t e = 0U; e < table.entities.size(); ++e) {
        bool is_supervised = false;
        for (const CheckpointRow& row : table.checkpoints) {
            is_supervised = is_supervised || row.entity == e;
        }
        if (!is_supervised) {
            return {SupervisionFault::kEntityUnsupervised, e};
        }
    }
    for (std::size_t m = 0U; m < table.mode_count; ++m) {
        ModeMask modes = 0U;
        for (const EntityRow& row : table.entities) {
            modes |= row.modes;
        }
        if ((modes & to_mask(m)) == 0U) {
            return {SupervisionFault::kModeUnsupervised, m};
        }
    }
    return {};
}

}  // namespace detail

/// The first fault of a table; rows before what follows from them, so that each finding can be believed.
/// @tparam kCheckpointMax at least the number of checkpoints.
template <std::size_t kCheckpointMax>
constexpr SupervisionFinding find_fault(const SupervisionTable& table) noexcept {
    MAMORI_REQUIRE(1, table.checkpoints.size() <= kCheckpointMax);
    using Check = SupervisionFinding (*)(const SupervisionTable&) noexcept;
    constexpr Check kChecks[]{
        detail::find_entity_fault,
        detail::find_checkpoint_fault,
        detail::find_alive_fault,
        detail::find_deadline_fault,
        detail::find_edge_fault,
        detail::find_gap,
        detail::find_graph_fault<kCheckpointMax>,
    };
    SupervisionFinding finding{};
    for (const Check check : kChecks) {
        if (finding.fault == SupervisionFault::kNone) {
            finding = check(table);
        }
    }
    return finding;
}

/// Proves a table: static_assert(is_sound<kTable>()).
/// @tparam kTable constexpr SupervisionTable of static storage duration, as the arrays that it refers to.
/// @return true; every other outcome does not compile.
template <const auto& kTable>
constexpr bool is_sound() noexcept {
    constexpr SupervisionFinding kFinding = find_fault<kTable.checkpoints.size()>(kTable);
    return SupervisionIsSound<kFinding.fault, kFinding.row, kFinding.other>::value;
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_SUPERVISION_CHECK_HPP

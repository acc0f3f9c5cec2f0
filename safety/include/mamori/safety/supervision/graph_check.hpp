// SPDX-License-Identifier: Apache-2.0
/// @file
/// Proves the graphs of checkpoints: each one has a begin, each checkpoint can be reached and left, and no
/// legal sequence breaks a deadline. Not for users.
///
/// @satisfies SWR-SUP-035      Design: docs/design/supervision.md#checkpoint-table
#ifndef MAMORI_SAFETY_SUPERVISION_GRAPH_CHECK_HPP
#define MAMORI_SAFETY_SUPERVISION_GRAPH_CHECK_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/safety/supervision/supervision_fault.hpp"
#include "mamori/safety/supervision/supervision_table.hpp"

namespace mamori::safety::detail {

constexpr SupervisionFault judge_edge(const SupervisionTable& table, const EdgeRow& row) noexcept {
    const std::size_t count = table.checkpoints.size();
    if (row.from >= count || row.to >= count) {
        return SupervisionFault::kEdgeOfUnknownCheckpoint;
    }
    const CheckpointRow& from = table.checkpoints[row.from];
    const CheckpointRow& to = table.checkpoints[row.to];
    if (from.role == CheckpointRole::kUnordered || to.role == CheckpointRole::kUnordered) {
        return SupervisionFault::kEdgeOfUnorderedCheckpoint;
    }
    if (from.entity != to.entity) {
        return SupervisionFault::kEdgeBetweenEntities;
    }
    return is_final(from.role) ? SupervisionFault::kEdgeLeavesFinal : SupervisionFault::kNone;
}

constexpr SupervisionFinding find_edge_fault(const SupervisionTable& table) noexcept {
    for (std::size_t i = 0U; i < table.edges.size(); ++i) {
        const SupervisionFault fault = judge_edge(table, table.edges[i]);
        if (fault != SupervisionFault::kNone) {
            return {fault, i};
        }
        for (std::size_t j = 0U; j < i; ++j) {
            if (table.edges[j].from == table.edges[i].from && table.edges[j].to == table.edges[i].to) {
                return {SupervisionFault::kEdgeTwice, i, j};
            }
        }
    }
    return {};
}

/// The checkpoints that legal sequences lead to, without a step onto a barred one.
/// For a table whose rows are valid in themselves.
template <std::size_t kCheckpointMax>
class CheckpointReach final {
  public:
    /// @param[in] barred kNoCheckpoint: none.
    constexpr CheckpointReach(const SupervisionTable& table, CheckpointIndex barred) noexcept
        : table_(table), barred_(barred) {}

    /// Adds the checkpoints that a run may begin with, of every entity: no edge leads from one to another.
    constexpr void add_initials() noexcept {
        for (const CheckpointRow& row : table_.checkpoints) {
            if (is_initial(row.role)) {
                add(row.checkpoint);
            }
        }
    }
    /// Adds the checkpoints that may follow this one; behind a final one the next run begins.
    constexpr void add_successors(CheckpointIndex checkpoint) noexcept {
        for (const EdgeRow& row : table_.edges) {
            if (row.from == checkpoint) {
                add(row.to);
            }
        }
        if (is_final(table_.checkpoints[checkpoint].role)) {
            add_initials();
        }
    }
    /// Adds all that follows from what was added. A step of the longest way in each round.
    constexpr void spread() noexcept {
        for (std::size_t round = 0U; round < table_.checkpoints.size(); ++round) {
            for (const CheckpointRow& row : table_.checkpoints) {
                if (reached_[row.checkpoint]) {
                    add_successors(row.checkpoint);
                }
            }
        }
    }
    constexpr bool has(CheckpointIndex checkpoint) const noexcept { return reached_[checkpoint]; }

  private:
    constexpr void add(CheckpointIndex checkpoint) noexcept {
        reached_[checkpoint] = reached_[checkpoint] || checkpoint != barred_;
    }

    const SupervisionTable& table_;
    CheckpointIndex barred_;
    std::array<bool, kCheckpointMax> reached_{};
};

constexpr SupervisionFinding find_missing_initial(const SupervisionTable& table) noexcept {
    for (std::size_t e = 0U; e < table.entities.size(); ++e) {
        bool has_graph = false;
        bool has_initial = false;
        for (const CheckpointRow& row : table.checkpoints) {
            if (row.entity == e) {
                has_graph = has_graph || row.role != CheckpointRole::kUnordered;
                has_initial = has_initial || is_initial(row.role);
            }
        }
        if (has_graph && !has_initial) {
            return {SupervisionFault::kGraphWithoutInitial, e};
        }
    }
    return {};
}

constexpr bool is_left(const SupervisionTable& table, const CheckpointRow& row) noexcept {
    bool has_way_on = is_final(row.role);
    for (const EdgeRow& edge : table.edges) {
        has_way_on = has_way_on || edge.from == row.checkpoint;
    }
    return has_way_on;
}

/// True when no legal sequence has the finish without the start, or the start again before the finish.
template <std::size_t kCheckpointMax>
constexpr bool is_kept_by_graph(const SupervisionTable& table, const DeadlineRow& row) noexcept {
    CheckpointReach<kCheckpointMax> without_start{table, row.start};
    without_start.add_initials();
    without_start.add_successors(row.finish);
    without_start.spread();
    CheckpointReach<kCheckpointMax> without_finish{table, row.finish};
    without_finish.add_successors(row.start);
    without_finish.spread();
    return !without_start.has(row.finish) && !without_finish.has(row.start);
}

template <std::size_t kCheckpointMax>
constexpr SupervisionFinding find_bypass(const SupervisionTable& table) noexcept {
    for (std::size_t i = 0U; i < table.deadlines.size(); ++i) {
        const DeadlineRow& row = table.deadlines[i];
        const bool is_in_graph = table.checkpoints[row.start].role != CheckpointRole::kUnordered &&
                                 table.checkpoints[row.finish].role != CheckpointRole::kUnordered;
        if (is_in_graph && !is_kept_by_graph<kCheckpointMax>(table, row)) {
            return {SupervisionFault::kDeadlineBypassed, i};
        }
    }
    return {};
}

/// For a table whose rows are valid in themselves.
template <std::size_t kCheckpointMax>
constexpr SupervisionFinding find_graph_fault(const SupervisionTable& table) noexcept {
    const SupervisionFinding missing = find_missing_initial(table);
    if (missing.fault != SupervisionFault::kNone) {
        return missing;
    }
    CheckpointReach<kCheckpointMax> reach{table, kNoCheckpoint};
    reach.add_initials();
    reach.spread();
    for (std::size_t i = 0U; i < table.checkpoints.size(); ++i) {
        const CheckpointRow& row = table.checkpoints[i];
        if (row.role != CheckpointRole::kUnordered) {
            if (!reach.has(row.checkpoint)) {
                return {SupervisionFault::kCheckpointUnreachable, i};
            }
            if (!is_left(table, row)) {
                return {SupervisionFault::kCheckpointIsDeadEnd, i};
            }
        }
    }
    return find_bypass<kCheckpointMax>(table);
}

}  // namespace mamori::safety::detail

#endif  // MAMORI_SAFETY_SUPERVISION_GRAPH_CHECK_HPP

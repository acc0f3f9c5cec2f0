// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of a safety table for the checkpoints of its components. Not for users.
///
/// @satisfies SWR-CYC-015      Design: docs/design/safety_cycle.md#the-table
#ifndef MAMORI_SAFETY_CHECKPOINT_RULES_HPP
#define MAMORI_SAFETY_CHECKPOINT_RULES_HPP

#include <cstddef>

#include "mamori/safety/cycle/safety_finding.hpp"
#include "mamori/safety/cycle/safety_part.hpp"

namespace mamori::safety::detail {

/// The checkpoints of all components are the entities of one table.
template <typename Table>
constexpr SafetyFinding check_checkpoints(const Table& table) noexcept {
    Checkpoints all{};
    for (std::size_t i = 0U; i < table.supervised.size(); ++i) {
        const Checkpoints& points = table.supervised[i].checkpoints;
        if (points.supervisor == nullptr) {
            continue;
        }
        if (all.supervisor != nullptr && (all.supervisor != points.supervisor || all.table != points.table)) {
            return {SafetyRule::kCheckpointsOfOneTable, i};
        }
        all = points;
        if (points.entity >= points.table->entities.size()) {
            return {SafetyRule::kEntityKnown, i};
        }
        for (std::size_t earlier = 0U; earlier < i; ++earlier) {
            if (table.supervised[earlier].checkpoints.entity == points.entity) {
                return {SafetyRule::kEntityOfOneComponent, i};
            }
        }
    }
    for (std::size_t e = 0U; all.table != nullptr && e < all.table->entities.size(); ++e) {
        bool is_named = false;
        for (std::size_t i = 0U; i < table.supervised.size(); ++i) {
            is_named = is_named || table.supervised[i].checkpoints.entity == e;
        }
        if (!is_named) {
            return {SafetyRule::kEntityOfAComponent, e};
        }
    }
    return {};
}

}  // namespace mamori::safety::detail

#endif  // MAMORI_SAFETY_CHECKPOINT_RULES_HPP

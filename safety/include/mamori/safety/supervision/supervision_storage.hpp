// SPDX-License-Identifier: Apache-2.0
/// @file
/// Memory of a CheckpointSupervisor, as much as its table needs.
///
/// @satisfies SWR-SUP-029, SWR-SUP-032      Design: docs/design/supervision.md#reports
#ifndef MAMORI_SAFETY_SUPERVISION_SUPERVISION_STORAGE_HPP
#define MAMORI_SAFETY_SUPERVISION_SUPERVISION_STORAGE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/mode_mask.hpp"
#include "mamori/safety/supervision/checkpoint_log.hpp"
#include "mamori/safety/supervision/supervision_check.hpp"
#include "mamori/safety/supervision/supervision_status.hpp"
#include "mamori/safety/supervision/supervision_table.hpp"

namespace mamori::safety {

/// One entity. All but the log is written by CheckpointSupervisor only.
struct EntityState {
    CheckpointLog log{};                  ///< written by the entity
    std::uint32_t lost_count{0U};         ///< of the log, as of the last cycle; runs round at 2^32
    Instant reported_at{};                ///< time of the last report
    CheckpointIndex last{kNoCheckpoint};  ///< last ordered checkpoint
    bool is_run_begun{false};             ///< the graph is between an initial and a final checkpoint
    bool has_reported{false};             ///< since it was activated
    bool is_report_early{false};          ///< the next report had a time to come, in the last cycle
    bool is_active{false};                ///< wanted by the mode
    CheckpointViolation violation{CheckpointViolation::kNone};  ///< first one, latched
    EntityStatus status{EntityStatus::kDeactivated};            ///< as of the last cycle
};

/// One alive supervision. A count stays below 2^21: a queue of reports in each of 2^16 cycles at most.
struct AliveState {
    std::uint32_t count{0U};          ///< reports in this reference cycle
    std::uint32_t silent_cycles{0U};  ///< without a report, in a row, over reference cycles
    std::uint32_t failed_cycles{0U};  ///< wrong reference cycles, less the right ones since
    std::uint32_t cycle{0U};          ///< supervision cycles of this reference cycle that are over
    bool has_reported{false};         ///< in this supervision cycle
    bool is_wrong{false};             ///< this reference cycle was found wrong before its end
};

/// One deadline.
struct DeadlineState {
    Instant started_at{};
    bool is_running{false};  ///< a flag of its own: every instant is legal, tick 0 too
};

/// Storage for the rows of a proven table, in mode 0.
/// @tparam kTable as in is_sound().
template <const auto& kTable>
struct SupervisionStorage {
    static_assert(is_sound<kTable>());

    constexpr SupervisionStorage() noexcept {
        for (std::size_t e = 0U; e < entities.size(); ++e) {
            entities[e].is_active = (kTable.entities[e].modes & to_mask(0U)) != 0U;
            entities[e].status = entities[e].is_active ? EntityStatus::kOk : EntityStatus::kDeactivated;
        }
    }

    /// Where an entity reports. @param[in] entity enumerator of the table.
    template <typename Entity>
    constexpr CheckpointLog& get_log(Entity entity) noexcept {
        return Span<EntityState>{entities}[detail::to_row_number(entity)].log;
    }

    std::array<EntityState, kTable.entities.size()> entities{};
    std::array<AliveState, kTable.alives.size()> alives{};
    std::array<DeadlineState, kTable.deadlines.size()> deadlines{};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_SUPERVISION_STORAGE_HPP

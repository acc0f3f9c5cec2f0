// SPDX-License-Identifier: Apache-2.0
/// @file
/// Supervises entities by the checkpoints that they report: that each comes often enough and not too often,
/// in time, and in order; and sums up to the status of the whole. A violation is latched when it is found.
///
/// @satisfies SWR-SUP-003, SWR-SUP-004, SWR-SUP-005, SWR-SUP-006, SWR-SUP-020, SWR-SUP-021, SWR-SUP-024
/// @satisfies SWR-SUP-026
/// @satisfies SWR-SUP-027, SWR-SUP-028, SWR-SUP-029, SWR-SUP-030, SWR-SUP-031, SWR-SUP-036, SWR-SUP-039
/// @satisfies SWR-SUP-042
/// Design:   docs/design/supervision.md#checkpoint-supervision
/// Source:   AUTOSAR Watchdog Manager, with the departures that the design note lists;
///           IEC 61508-2:2010 Table A.10 (combined temporal and logical monitoring of program sequence)
#ifndef MAMORI_SAFETY_SUPERVISION_CHECKPOINT_SUPERVISOR_HPP
#define MAMORI_SAFETY_SUPERVISION_CHECKPOINT_SUPERVISOR_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/supervision/expiry_memory.hpp"
#include "mamori/safety/supervision/proof_chain.hpp"
#include "mamori/safety/supervision/supervision_status.hpp"
#include "mamori/safety/supervision/supervision_storage.hpp"
#include "mamori/safety/supervision/supervision_table.hpp"

namespace mamori::safety {

/// Supervises the entities of one table. Begins in mode 0, with every entity of it kOk and nothing proven.
///
/// Thread safety: each entity reports to its log from one context of its own or from this one; every member
///                here from one and the same context.
/// Time:          step() is O(reports * (edges + deadlines + alives)), with at most kPendingCheckpointsMax
///                reports of each entity; set_mode() as step(); the others are O(rows). Nothing blocks.
/// Memory:        no heap; all state is in the storage, which must outlive this object.
class CheckpointSupervisor final {
  public:
    /// @param[in] storage of a proven table. @param[in] memory for the first entity that expires.
    template <const auto& kTable>
    constexpr CheckpointSupervisor(SupervisionStorage<kTable>& storage, ExpiryMemory& memory) noexcept
        : table_(kTable),
          entities_(storage.entities),
          alives_(storage.alives),
          deadlines_(storage.deadlines),
          memory_(memory) {}
    CheckpointSupervisor(const CheckpointSupervisor&) = delete;
    CheckpointSupervisor& operator=(const CheckpointSupervisor&) = delete;

    /// Ends one supervision cycle: judges the reports up to `now` and what did not come, worst first.
    /// @param[in] now by the clock of the reports. One before an earlier call's expires every active entity.
    /// @param[in,out] chain gets a link of each part that has done its work.
    /// @return kStopped: an entity was expired for more cycles than tolerated, now or ever. kExpired: one is,
    ///         in whatever mode. kFailed: one has had wrong reference cycles, within its tolerance. kOk.
    [[nodiscard]] SupervisionStatus step(Instant now, ProofChain& chain) noexcept;
    /// The same where no watchdog asks for an answer.
    [[nodiscard]] SupervisionStatus step(Instant now) noexcept;

    /// Switches to another mode. First evaluates the reports up to `now`, the elapsed deadlines and, in
    /// proportion, the reference cycles that the switch ends, by the old mode. An inactive entity keeps its
    /// silent cycles and wrong reference cycles. An expired entity stays expired. An entity that becomes
    /// active starts with an initial checkpoint and a complete reference cycle.
    /// @return kOk; kBadParameter (no such mode).
    Status set_mode(std::size_t mode, Instant now) noexcept;

    /// Takes an expired entity back to kOk, or to kDeactivated when the mode does not want it. Only for a
    /// deliberate reset, with the entity at rest: its next ordered checkpoint must be an initial one.
    /// @return kOk; kBadParameter (no such entity); kPreconditionNotMet (not expired, or all is stopped).
    Status acknowledge(EntityIndex entity) noexcept;

    /// The table of the storage.
    const SupervisionTable& get_table() const noexcept { return table_; }
    /// @return result of the last step(); kFailed before the first.
    SupervisionStatus get_status() const noexcept { return status_; }
    std::size_t get_mode() const noexcept { return mode_; }

    /// @param[in] entity 0 .. count - 1. @return its status as of the last step(), set_mode() or
    ///            acknowledge().
    EntityStatus get_entity_status(EntityIndex entity) const noexcept { return entities_[entity].status; }
    /// @param[in] entity 0 .. count - 1. @return why it expired; kNone unless it did.
    CheckpointViolation get_violation(EntityIndex entity) const noexcept {
        return entities_[entity].violation;
    }
    /// @return entity that expired first since none was expired, the lowest of one step; kNoEntity.
    EntityIndex get_first_expired() const noexcept { return first_expired_; }

  private:
    void advance(Instant now) noexcept;
    bool take_reports(EntityIndex entity, Instant now) noexcept;
    void judge_report(EntityIndex entity, const CheckpointEvent& event) noexcept;
    bool is_next(const EntityState& state, const CheckpointRow& row) const noexcept;
    void judge_deadlines_at(EntityIndex entity, const CheckpointEvent& event) noexcept;
    void count_report(CheckpointIndex checkpoint) noexcept;
    void judge_early_report(EntityIndex entity) noexcept;
    void record_wrong_cycle(std::size_t row) noexcept;
    void end_alive_early(std::size_t row) noexcept;
    bool end_alive_cycle(std::size_t row) noexcept;
    bool judge_running(std::size_t row, Instant now) noexcept;
    void form_status(EntityIndex entity, Instant now) noexcept;
    SupervisionStatus form_whole() noexcept;
    void rest(EntityIndex entity) noexcept;
    bool is_judged(EntityIndex entity) const noexcept {
        return entities_[entity].is_active && entities_[entity].violation == CheckpointViolation::kNone;
    }
    bool is_wanted(EntityIndex entity, std::size_t mode) const noexcept {
        return (table_.entities[entity].modes & to_mask(mode)) != 0U;
    }
    EntityIndex get_owner(CheckpointIndex checkpoint) const noexcept {
        return table_.checkpoints[checkpoint].entity;
    }
    EntityIndex get_entity_count() const noexcept { return static_cast<EntityIndex>(entities_.size()); }

    const SupervisionTable& table_;
    Span<EntityState> entities_;
    Span<AliveState> alives_;
    Span<DeadlineState> deadlines_;
    ExpiryMemory& memory_;
    std::size_t mode_{0U};
    Instant now_{};
    std::uint32_t expired_cycles_{0U};  ///< in a row
    EntityIndex first_expired_{kNoEntity};
    bool has_time_{false};  ///< now_ was set
    SupervisionStatus status_{SupervisionStatus::kFailed};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_CHECKPOINT_SUPERVISOR_HPP

// SPDX-License-Identifier: Apache-2.0
/// @file
/// What is demanded of supervised entities, as a constant table: their checkpoints, how often each comes, how
/// long it takes from one to another, and in which order they come.
///
///     constexpr std::array kEntities{supervise(Entity::kControl)};
///     constexpr std::array kCheckpoints{
///         checkpoint(Point::kRead, Entity::kControl, CheckpointRole::kInitial),
///         checkpoint(Point::kWrite, Entity::kControl, CheckpointRole::kFinal)};
///     constexpr std::array kAlives{alive(Point::kRead, {1U, 0U, 0U, 1U})};
///     constexpr std::array kDeadlines{deadline(Point::kRead, Point::kWrite, {50_us, 400_us})};
///     constexpr std::array kEdges{edge(Point::kRead, Point::kWrite)};
///     constexpr SupervisionTable kTable{kEntities, kCheckpoints, kAlives, kDeadlines, kEdges};
///     static_assert(is_sound<kTable>());
///
/// @satisfies SWR-SUP-020, SWR-SUP-021, SWR-SUP-029      Design: docs/design/supervision.md#checkpoint-table
/// Source:   AUTOSAR Watchdog Manager (alive, deadline and logical supervision of supervised entities)
#ifndef MAMORI_SAFETY_SUPERVISION_SUPERVISION_TABLE_HPP
#define MAMORI_SAFETY_SUPERVISION_SUPERVISION_TABLE_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/table/mode_mask.hpp"
#include "mamori/safety/supervision/deadline_limits.hpp"

namespace mamori::safety {

/// Number of a supervised entity, 0 .. count - 1 of the application's enumeration.
using EntityIndex = std::uint16_t;
/// "No entity".
inline constexpr EntityIndex kNoEntity = 0xFFFFU;
/// Number of a checkpoint, 0 .. count - 1 of the application's enumeration, over all entities.
using CheckpointIndex = std::uint16_t;
/// "No checkpoint".
inline constexpr CheckpointIndex kNoCheckpoint = 0xFFFFU;

/// A supervised entity: code that runs in one execution context.
struct EntityRow {
    EntityIndex entity{kNoEntity};
    ModeMask modes{kEveryMode};                 ///< in which it is active
    std::uint16_t failed_reference_cycles{0U};  ///< wrong reference cycles that are tolerated, less the right
                                                ///< ones since
};

/// Place of a checkpoint in the graph of its entity.
enum class CheckpointRole : std::uint8_t {
    kUnordered,        ///< in no graph: it may come at any time
    kInner,            ///< behind another one, and before another one
    kInitial,          ///< a run may begin with it
    kFinal,            ///< a run ends with it
    kInitialAndFinal,  ///< both
};
constexpr bool is_initial(CheckpointRole role) noexcept {
    return role == CheckpointRole::kInitial || role == CheckpointRole::kInitialAndFinal;
}
constexpr bool is_final(CheckpointRole role) noexcept {
    return role == CheckpointRole::kFinal || role == CheckpointRole::kInitialAndFinal;
}

/// A place in the code of an entity that reports that it was passed.
struct CheckpointRow {
    CheckpointIndex checkpoint{kNoCheckpoint};
    EntityIndex entity{kNoEntity};
    CheckpointRole role{CheckpointRole::kUnordered};
};

/// Reports of one checkpoint in one reference cycle: expected - min_margin .. expected + max_margin.
/// Range: min_margin < expected, reference_cycles >= 1.
struct AliveCount {
    std::uint16_t expected{0U};
    std::uint16_t min_margin{0U};
    std::uint16_t max_margin{0U};
    std::uint16_t reference_cycles{0U};  ///< length of a reference cycle [supervision cycles]

    constexpr std::uint32_t get_least() const noexcept { return std::uint32_t{expected} - min_margin; }
    constexpr std::uint32_t get_most() const noexcept { return std::uint32_t{expected} + max_margin; }
    /// Supervision cycles in a row that may pass without a report. As if each of the least reports had a
    /// part of the reference cycle for itself: one at the begin of its part, the next at the end of the part
    /// behind. So a burst cannot pay for a stall, however long the reference cycle is.
    constexpr std::uint32_t calc_silence_max() const noexcept {
        return 2U * ((reference_cycles - 1U) / get_least());
    }
};
/// Demands an alive count of a checkpoint.
struct AliveRow {
    CheckpointIndex checkpoint{kNoCheckpoint};
    AliveCount count{};
};

/// Demands a time between two checkpoints of an entity.
struct DeadlineRow {
    CheckpointIndex start{kNoCheckpoint};
    CheckpointIndex finish{kNoCheckpoint};
    DeadlineLimits limits{};
};

/// Allows `to` to be the next ordered checkpoint after `from`.
struct EdgeRow {
    CheckpointIndex from{kNoCheckpoint};
    CheckpointIndex to{kNoCheckpoint};
};

/// The whole table: it refers to arrays of static storage. Rows of entities and checkpoints stand in the
/// order of their numbers.
struct SupervisionTable {
    Span<const EntityRow> entities{};
    Span<const CheckpointRow> checkpoints{};
    Span<const AliveRow> alives{};
    Span<const DeadlineRow> deadlines{};
    Span<const EdgeRow> edges{};
    std::size_t mode_count{1U};                  ///< modes 0 .. mode_count - 1, as in the system table
    std::uint32_t expired_cycles_tolerated{0U};  ///< supervision cycles from kExpired to kStopped
};

namespace detail {

/// Number of an enumerator; one that has no place becomes the number that no row has, which is refused.
template <typename Enumerator>
constexpr std::uint16_t to_row_number(Enumerator enumerator) noexcept {
    static_assert(std::is_enum_v<Enumerator>, "entities, checkpoints and modes are enumerators");
    const auto number = static_cast<std::size_t>(enumerator);
    return number < kNoCheckpoint ? static_cast<std::uint16_t>(number) : kNoCheckpoint;
}

}  // namespace detail

/// The modes that are named: enumerators whose numbers are the places of the modes, 0 .. 31.
template <typename... Modes>
constexpr ModeMask in_modes(Modes... modes) noexcept {
    return (to_mask(detail::to_row_number(modes)) | ... | ModeMask{0U});
}

/// @param[in] failed_reference_cycles see EntityRow.
template <typename Entity>
constexpr EntityRow supervise(Entity entity, ModeMask modes = kEveryMode,
                              std::uint16_t failed_reference_cycles = 0U) noexcept {
    return {detail::to_row_number(entity), modes, failed_reference_cycles};
}
template <typename Checkpoint, typename Entity>
constexpr CheckpointRow checkpoint(Checkpoint checkpoint, Entity entity,
                                   CheckpointRole role = CheckpointRole::kUnordered) noexcept {
    return {detail::to_row_number(checkpoint), detail::to_row_number(entity), role};
}
template <typename Checkpoint>
constexpr AliveRow alive(Checkpoint checkpoint, AliveCount count) noexcept {
    return {detail::to_row_number(checkpoint), count};
}
template <typename Checkpoint>
constexpr DeadlineRow deadline(Checkpoint start, Checkpoint finish, DeadlineLimits limits) noexcept {
    return {detail::to_row_number(start), detail::to_row_number(finish), limits};
}
template <typename Checkpoint>
constexpr EdgeRow edge(Checkpoint from, Checkpoint to) noexcept {
    return {detail::to_row_number(from), detail::to_row_number(to)};
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_SUPERVISION_TABLE_HPP

// SPDX-License-Identifier: Apache-2.0
/// @file
/// The table from fault and mode to reaction. A declared fault without a reaction in one of the modes does
/// not compile, and the worst of all latched faults decides.
///
/// @satisfies SWR-FLT-004, SWR-FLT-005, SWR-FLT-006, SWR-FLT-010, SWR-FLT-011, SWR-FLT-012
/// Design: docs/design/supervision.md#reactions
#ifndef MAMORI_SAFETY_REACTION_TABLE_HPP
#define MAMORI_SAFETY_REACTION_TABLE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/mode_mask.hpp"
#include "mamori/safety/reaction/fault_register.hpp"
#include "mamori/safety/reaction/reaction.hpp"

namespace mamori::safety {

/// One row: the fault, its reaction, the time from the confirmed fault to the start of the reaction, and the
/// modes of the system in which it is the answer.
struct ReactionRow {
    FaultIndex fault{kNoFault};
    Reaction reaction{Reaction::kSto};
    Duration within{0};
    ModeMask modes{kEveryMode};
};

/// Writes a row as one reads it: react(Fault::kOverspeed, Reaction::kSs1, 20_ms).
/// @param[in] fault  enumerator of the application's faults, 0 .. count - 1.
/// @param[in] within > 0.
template <typename Fault>
constexpr ReactionRow react(Fault fault, Reaction reaction, Duration within) noexcept {
    static_assert(std::is_enum_v<Fault>, "faults are the enumerators of one enumeration");
    return {static_cast<FaultIndex>(fault), reaction, within};
}

/// The same for some modes: react_in(to_modes(Mode::kAutomatic, Mode::kManual), Fault::kOverspeed, ...).
/// @param[in] modes of to_modes(); none is refused by covers_all().
template <typename Fault>
constexpr ReactionRow react_in(ModeMask modes, Fault fault, Reaction reaction, Duration within) noexcept {
    static_assert(std::is_enum_v<Fault>, "faults are the enumerators of one enumeration");
    return {static_cast<FaultIndex>(fault), reaction, within, modes};
}

/// @param[in] modes enumerators of the application's modes, each below kSystemModeMax. @return their set.
template <typename... Mode>
constexpr ModeMask to_modes(Mode... modes) noexcept {
    static_assert((std::is_enum_v<Mode> && ...), "modes are the enumerators of one enumeration");
    return (ModeMask{0U} | ... | to_mask(static_cast<std::size_t>(modes)));
}

/// Finds the demand of all latched faults. Call it in each cycle: the register keeps the worst demand of each
/// latched fault until it is acknowledged, so no mode switch lowers it.
/// @param[in,out] faults keep their demands.
/// @param[in]     mode   in which the system is; 0 for one without modes.
/// @return the severest reaction over all latched faults and the modes since each was latched, among equals
///         the shortest time, then the lowest fault number; Reaction::kSto at once for a latched fault that
///         has no row for the mode, and for every latched fault in an invalid mode, from kSystemModeMax on.
/// Time: O(faults * rows).
ReactionDemand calc_reaction(Span<const ReactionRow> table, FaultRegister& faults,
                             std::size_t mode = 0U) noexcept;

/// True when `row` is the answer to `fault` in `mode`.
constexpr bool answers(const ReactionRow& row, FaultIndex fault, std::size_t mode) noexcept {
    return row.fault == fault && mode < kSystemModeMax && (row.modes & to_mask(mode)) != 0U;
}

/// @return number of rows of `table` for `fault` in `mode`.
template <std::size_t kRowCount>
constexpr std::size_t count_rows(const std::array<ReactionRow, kRowCount>& table, FaultIndex fault,
                                 std::size_t mode = 0U) noexcept {
    std::size_t count = 0U;
    for (const ReactionRow& row : table) {
        count += answers(row, fault, mode) ? 1U : 0U;
    }
    return count;
}

/// True when every row names one of the faults 0 .. fault_count - 1, a time that can be kept, and a mode of
/// the modes 0 .. mode_count - 1. A row for every mode may name more.
template <std::size_t kRowCount>
constexpr bool are_rows_valid(const std::array<ReactionRow, kRowCount>& table, std::size_t fault_count,
                              std::size_t mode_count = 1U) noexcept {
    const ModeMask known = mode_count >= kSystemModeMax ? kEveryMode : to_mask(mode_count) - 1U;
    for (const ReactionRow& row : table) {
        const bool is_of_known_modes = row.modes == kEveryMode || (row.modes & ~known) == 0U;
        if (row.fault >= fault_count || row.within <= Duration{0} || row.modes == 0U || !is_of_known_modes) {
            return false;
        }
    }
    return true;
}

/// Fails to compile for a fault that has not exactly one row in a mode; the compiler prints both.
template <auto kFault, std::size_t kRows, auto kMode>
struct FaultHasReaction : std::true_type {
    static_assert(kRows != 0U, "declared fault without a reaction; add react(<fault>, ...) to the table");
    static_assert(kRows <= 1U, "declared fault with more than one reaction; keep one row");
};

namespace detail {

template <const auto& kTable, auto kMode, typename Fault, std::size_t... kFaults>
constexpr bool covers(std::index_sequence<kFaults...>) noexcept {
    constexpr auto kModeIndex = static_cast<std::size_t>(kMode);
    return (
        FaultHasReaction<static_cast<Fault>(kFaults),
                         count_rows(kTable, static_cast<FaultIndex>(kFaults), kModeIndex), kMode>::value &&
        ...);
}

template <const auto& kTable, typename Mode, typename Fault, std::size_t kFaultCount, std::size_t... kModes>
constexpr bool covers_modes(std::index_sequence<kModes...>) noexcept {
    return (covers<kTable, static_cast<Mode>(kModes), Fault>(std::make_index_sequence<kFaultCount>{}) && ...);
}

}  // namespace detail

/// Modes of a system that has none.
enum class OnlyMode : std::uint8_t { kAny, kCount };

/// Proves a reaction table: static_assert(covers_all<kReactions, Fault::kCount, Mode::kCount>());
/// @tparam kTable     constexpr std::array<ReactionRow, n> of static storage duration.
/// @tparam kCount     enumerator behind the last fault, its value is the number of faults.
/// @tparam kModeCount enumerator behind the last mode, 1 .. kSystemModeMax; left out for a system without
///                    modes.
/// @return true; every other outcome does not compile.
template <const auto& kTable, auto kCount, auto kModeCount = OnlyMode::kCount>
constexpr bool covers_all() noexcept {
    using Fault = decltype(kCount);
    using Mode = decltype(kModeCount);
    static_assert(std::is_enum_v<Fault>, "faults are the enumerators of one enumeration");
    static_assert(std::is_enum_v<Mode>, "modes are the enumerators of one enumeration");
    constexpr auto kFaultCount = static_cast<std::size_t>(kCount);
    constexpr auto kModes = static_cast<std::size_t>(kModeCount);
    static_assert(kFaultCount >= 1U && kFaultCount <= kNoFault, "number of faults is out of range");
    static_assert(kModes >= 1U && kModes <= kSystemModeMax, "number of modes is out of range");
    static_assert(are_rows_valid(kTable, kFaultCount, kModes),
                  "row with an unknown fault, with no time to react, or with no mode or an unknown one");
    return detail::covers_modes<kTable, Mode, Fault, kFaultCount>(std::make_index_sequence<kModes>{});
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_REACTION_TABLE_HPP

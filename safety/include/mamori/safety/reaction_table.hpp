// SPDX-License-Identifier: Apache-2.0
/// @file
/// The table from fault to reaction. A declared fault without a reaction does not compile, and the worst of
/// all latched faults decides.
///
/// @satisfies SWR-FLT-004, SWR-FLT-005, SWR-FLT-006      Design: docs/design/faults.md#reactions
#ifndef MAMORI_SAFETY_REACTION_TABLE_HPP
#define MAMORI_SAFETY_REACTION_TABLE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/span.hpp"
#include "mamori/kernel/time.hpp"
#include "mamori/safety/fault_register.hpp"

namespace mamori::safety {

/// What a fault leads to; ordered, the severest is the largest. Stops are named as in IEC 61800-5-2.
enum class Reaction : std::uint8_t {
    kNone,     ///< recorded only
    kDegrade,  ///< go on with reduced limits
    kSs2,      ///< controlled stop, then hold the position under torque (stop category 2)
    kSs1,      ///< controlled stop, then torque off and brakes closed (stop category 1)
    kSto,      ///< torque off and brakes closed at once (stop category 0)
};

/// Spelling for logs and reports; "Invalid" for a corrupted value, never nullptr.
constexpr const char* get_name(Reaction reaction) noexcept {
    switch (reaction) {
        case Reaction::kNone:
            return "None";
        case Reaction::kDegrade:
            return "Degrade";
        case Reaction::kSs2:
            return "Ss2";
        case Reaction::kSs1:
            return "Ss1";
        case Reaction::kSto:
            return "Sto";
    }
    return "Invalid";
}

/// One row: the fault, its reaction, and the time from the confirmed fault to the start of the reaction.
struct ReactionRow {
    FaultIndex fault{kNoFault};
    Reaction reaction{Reaction::kSto};
    Duration within{0};
};

/// Writes a row as one reads it: react(Fault::kOverspeed, Reaction::kSs1, 20_ms).
/// @param[in] fault  enumerator of the application's faults, 0 .. count - 1.
/// @param[in] within > 0.
template <typename Fault>
constexpr ReactionRow react(Fault fault, Reaction reaction, Duration within) noexcept {
    static_assert(std::is_enum_v<Fault>, "faults are the enumerators of one enumeration");
    return {static_cast<FaultIndex>(fault), reaction, within};
}

/// What is demanded of the state machine.
struct ReactionDemand {
    Reaction reaction{Reaction::kNone};
    FaultIndex fault{kNoFault};  ///< the fault that asks for it; kNoFault when none is latched
    Duration within{0};
};

/// @return the severest reaction over all latched faults, among equals the shortest time, then the lowest
///         fault number; Reaction::kSto at once for a latched fault that has no row.
/// Time: O(faults * rows).
ReactionDemand calc_reaction(Span<const ReactionRow> table, const FaultRegister& faults) noexcept;

/// @return number of rows of `table` for `fault`.
template <std::size_t kRowCount>
constexpr std::size_t count_rows(const std::array<ReactionRow, kRowCount>& table, FaultIndex fault) noexcept {
    std::size_t count = 0U;
    for (const ReactionRow& row : table) {
        count += row.fault == fault ? 1U : 0U;
    }
    return count;
}

/// True when every row names one of the faults 0 .. fault_count - 1 and a time that can be kept.
template <std::size_t kRowCount>
constexpr bool are_rows_valid(const std::array<ReactionRow, kRowCount>& table,
                              std::size_t fault_count) noexcept {
    for (const ReactionRow& row : table) {
        if (row.fault >= fault_count || row.within <= Duration{0}) {
            return false;
        }
    }
    return true;
}

/// Fails to compile for a fault that has not exactly one row; the compiler prints the fault.
template <auto kFault, std::size_t kRows>
struct FaultHasReaction : std::true_type {
    static_assert(kRows != 0U, "declared fault without a reaction; add react(<fault>, ...) to the table");
    static_assert(kRows <= 1U, "declared fault with more than one reaction; keep one row");
};

namespace detail {

template <const auto& kTable, typename Fault, std::size_t... kFaults>
constexpr bool covers(std::index_sequence<kFaults...>) noexcept {
    return (FaultHasReaction<static_cast<Fault>(kFaults),
                             count_rows(kTable, static_cast<FaultIndex>(kFaults))>::value &&
            ...);
}

}  // namespace detail

/// Proves a reaction table: static_assert(covers_all<kReactions, Fault::kCount>());
/// @tparam kTable constexpr std::array<ReactionRow, n> of static storage duration.
/// @tparam kCount enumerator behind the last fault, its value is the number of faults.
/// @return true; every other outcome does not compile.
template <const auto& kTable, auto kCount>
constexpr bool covers_all() noexcept {
    using Fault = decltype(kCount);
    static_assert(std::is_enum_v<Fault>, "faults are the enumerators of one enumeration");
    constexpr auto kFaultCount = static_cast<std::size_t>(kCount);
    static_assert(kFaultCount >= 1U && kFaultCount <= kNoFault, "number of faults is out of range");
    static_assert(are_rows_valid(kTable, kFaultCount), "row with an unknown fault, or with no time to react");
    return detail::covers<kTable, Fault>(std::make_index_sequence<kFaultCount>{});
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_REACTION_TABLE_HPP

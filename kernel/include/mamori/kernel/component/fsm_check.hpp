// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules for the table of a state machine, as constant expressions. The compiler rejects a table that
/// violates a rule and prints the rule and the faulty row.
///
/// @satisfies SWR-RTC-006      Design: docs/design/rtc_semantics.md#state-machines
#ifndef MAMORI_KERNEL_FSM_CHECK_HPP
#define MAMORI_KERNEL_FSM_CHECK_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/component/fsm_table.hpp"

namespace mamori {

/// Maximum number of states of one machine: a set of states is one 64-bit word.
inline constexpr std::size_t kMaxFsmStates = 64U;

/// Violated rule; each comment specifies the meaning of FsmFinding::element.
enum class FsmRule : std::uint8_t {
    kNone,
    kTableNameMissing,    ///< no row: element is 0
    kNoState,             ///< no row: element is 0
    kTooManyStates,       ///< index of the first state beyond the limit, kMaxFsmStates
    kNameMissing,         ///< state, or number of states + message
    kNameTwice,           ///< state, or number of states + message: the second occurrence
    kInitialUnknown,      ///< no row: element is 0
    kTransitionUnknown,   ///< transition whose source, message or target has no row
    kTransitionShadowed,  ///< transition after one without guard for the same source and message
    kStateUnreachable,    ///< state that cannot be reached from the initial state
};
/// A violated rule and the number of the faulty row; FsmRule specifies the table of the row.
struct FsmFinding {
    FsmRule rule{FsmRule::kNone};
    std::size_t element{0U};
};

namespace detail {

/// @param[in] first number of the first row, for the finding.
template <typename Row>
constexpr FsmFinding check_fsm_names(Span<const Row> rows, std::size_t first) noexcept {
    for (std::size_t i = 0U; i < rows.size(); ++i) {
        if (rows[i].name == nullptr || rows[i].name[0] == '\0') {
            return {FsmRule::kNameMissing, first + i};
        }
        for (std::size_t j = 0U; j < i; ++j) {
            if (is_same_text(rows[i].name, rows[j].name)) {
                return {FsmRule::kNameTwice, first + i};
            }
        }
    }
    return {};
}

constexpr FsmFinding check_fsm_transitions(const FsmTable& table) noexcept {
    for (std::size_t i = 0U; i < table.transitions.size(); ++i) {
        const FsmTransition& row = table.transitions[i];
        if (row.source >= table.states.size() || row.target >= table.states.size() ||
            row.message >= table.messages.size()) {
            return {FsmRule::kTransitionUnknown, i};
        }
        for (std::size_t j = 0U; j < i; ++j) {
            const FsmTransition& earlier = table.transitions[j];
            if (earlier.source == row.source && earlier.message == row.message && earlier.guard == nullptr) {
                return {FsmRule::kTransitionShadowed, i};
            }
        }
    }
    return {};
}

constexpr FsmFinding check_fsm_reach(const FsmTable& table) noexcept {
    std::uint64_t reached = std::uint64_t{1} << table.initial;
    // Each pass reaches at least one more state, until all reachable states are reached.
    for (std::size_t pass = 0U; pass < table.states.size(); ++pass) {
        for (const FsmTransition& row : table.transitions) {
            const bool is_source_reached = ((reached >> row.source) & 1U) != 0U;
            reached |= is_source_reached ? std::uint64_t{1} << row.target : 0U;
        }
    }
    for (std::size_t i = 0U; i < table.states.size(); ++i) {
        if (((reached >> i) & 1U) == 0U) {
            return {FsmRule::kStateUnreachable, i};
        }
    }
    return {};
}

/// Instantiated by MAMORI_CHECK_FSM; for a rejected table, its template arguments show rule and element.
template <FsmRule kRule, std::size_t kElement>
struct FsmTableKeeps {
    static_assert(kRule == FsmRule::kNone, "the FSM table breaks the rule named in the template arguments");
    static constexpr bool kValue = kRule == FsmRule::kNone;
};

}  // namespace detail

/// First violated rule, or kNone. Constant expression for a constexpr table; O(rows squared). Precondition,
/// not checked: each span refers to as many rows as its size, and each name ends with NUL.
constexpr FsmFinding check(const FsmTable& table) noexcept {
    if (table.name == nullptr) {
        return {FsmRule::kTableNameMissing, 0U};
    }
    if (table.states.empty()) {
        return {FsmRule::kNoState, 0U};
    }
    if (table.states.size() > kMaxFsmStates) {
        return {FsmRule::kTooManyStates, kMaxFsmStates};
    }
    FsmFinding finding = detail::check_fsm_names(table.states, 0U);
    if (finding.rule == FsmRule::kNone) {
        finding = detail::check_fsm_names(table.messages, table.states.size());
    }
    if (finding.rule != FsmRule::kNone) {
        return finding;
    }
    if (table.initial >= table.states.size()) {
        return {FsmRule::kInitialUnknown, 0U};
    }
    finding = detail::check_fsm_transitions(table);
    return finding.rule == FsmRule::kNone ? detail::check_fsm_reach(table) : finding;
}

}  // namespace mamori

/// Rejects the constexpr FSM table `table` at compile time when it violates a rule.
#define MAMORI_CHECK_FSM(table)                                                \
    static_assert(::mamori::detail::FsmTableKeeps<::mamori::check(table).rule, \
                                                  ::mamori::check(table).element>::kValue)

#endif  // MAMORI_KERNEL_FSM_CHECK_HPP

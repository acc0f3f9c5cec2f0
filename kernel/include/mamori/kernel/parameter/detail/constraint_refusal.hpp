// SPDX-License-Identifier: Apache-2.0
/// @file
/// Makes a compiler's message about a constraint say what is wrong and where. In a failed constant expression
/// g++ shows the template arguments of the calls that led there and clang the values of their arguments, so
/// rule and place are handed on as both. Not for users.
///
/// @satisfies SWR-PAR-004      Design: docs/design/parameters.md#refusal-at-compile-time
#ifndef MAMORI_KERNEL_CONSTRAINT_REFUSAL_HPP
#define MAMORI_KERNEL_CONSTRAINT_REFUSAL_HPP

#include <array>
#include <cstddef>
#include <utility>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/parameter/constraint_finding.hpp"

namespace mamori {
namespace detail {

/// Characters of a constraint that a message names one by one; later ones share the last number.
inline constexpr std::size_t kNamedCharacters = 128U;
inline constexpr std::size_t kConstraintRuleCount =
    static_cast<std::size_t>(ConstraintRule::kTooManyRanges) + 1U;

/// `kCharacter` is the place in the text of the constraint, counted from 0.
template <std::size_t kCharacter>
constexpr void refuse_at_character() noexcept {
    MAMORI_REQUIRE(1, kCharacter > kNamedCharacters);
}
using RefuseAt = void (*)() noexcept;
template <std::size_t... kCharacters>
constexpr std::array<RefuseAt, sizeof...(kCharacters)> list_characters(
    std::index_sequence<kCharacters...>) noexcept {
    return {{&refuse_at_character<kCharacters>...}};
}

template <ConstraintRule kRule>
constexpr void refuse_constraint(const char* text, std::size_t character) noexcept {
    static_cast<void>(text);
    constexpr auto kCharacters = list_characters(std::make_index_sequence<kNamedCharacters>{});
    kCharacters[character < kNamedCharacters ? character : kNamedCharacters - 1U]();
}
template <std::size_t... kRules>
constexpr void refuse_finding(const ConstraintFinding& finding, std::index_sequence<kRules...>) noexcept {
    ((static_cast<std::size_t>(finding.rule) == kRules
          ? refuse_constraint<static_cast<ConstraintRule>(kRules)>(get_text(finding.rule), finding.position)
          : static_cast<void>(0)),
     ...);
}

/// Stops the compiler in a constant expression when there is a finding; while the program runs a finding is
/// an own bug.
constexpr void require_well_formed(const ConstraintFinding& finding) noexcept {
    if (finding.rule != ConstraintRule::kNone) {
        refuse_finding(finding, std::make_index_sequence<kConstraintRuleCount>{});
    }
}

}  // namespace detail
}  // namespace mamori

#endif  // MAMORI_KERNEL_CONSTRAINT_REFUSAL_HPP

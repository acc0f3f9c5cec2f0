// SPDX-License-Identifier: Apache-2.0
/// @file
/// From a broken rule of the modes to the compiler message that names the guilty element. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-MOD-003      Design: docs/design/modes.md#what-the-compiler-refuses
#ifndef MAMORI_KERNEL_MODE_REFUSAL_HPP
#define MAMORI_KERNEL_MODE_REFUSAL_HPP

#include <cstddef>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/system/detail/mode_rules.hpp"
#include "mamori/kernel/system/detail/spelled_name.hpp"
#include "mamori/kernel/system/detail/table_element.hpp"
#include "mamori/kernel/system/detail/table_rule.hpp"
#include "mamori/kernel/table/system_finding.hpp"

namespace mamori::detail {

/// Size of the rule that is broken, with its guilty element as arguments: asking for it ends the compilation.
template <const auto& kTable, Rule kRule, std::size_t kElement, std::size_t kOther>
constexpr std::size_t refuse_modes() noexcept {
    if constexpr (kRule == Rule::kModeNamedTwice) {
        return sizeof(rules::ModeHasANameOfItsOwn<ModeName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kModeOfUnknownComponent) {
        return sizeof(
            rules::ModeRunsComponentsOfTheTable<ModeName<kTable, kTable.modes.members[kElement].mode>,
                                                At<typename TypesOf<kTable>::Members, kElement>>);
    } else if constexpr (kRule == Rule::kModeOfUnknownSet) {
        return sizeof(rules::ModeHasAKnownConfigurationSet<ModeName<kTable, kElement>,
                                                           NameOf<kTable, OfSetOfMode, kElement>>);
    } else if constexpr (kRule == Rule::kComponentInNoMode) {
        return sizeof(
            rules::ComponentRunsInSomeMode<ComponentAt<kTable, kElement>, calc_instance<kTable, kElement>()>);
    } else if constexpr (kRule == Rule::kInputNotFedInMode) {
        return sizeof(
            rules::InputIsFedInEachModeOfItsComponent<ModeName<kTable, kOther>, PortAt<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kConnectionOfUnknownMode) {
        return sizeof(rules::ConnectionHoldsInKnownModes<NameOf<kTable, OfConnectionMode, kElement>>);
    } else if constexpr (kRule == Rule::kTransitionOfUnknownMode) {
        return sizeof(rules::TransitionJoinsKnownModes<NameOf<kTable, OfSource, kElement>,
                                                       NameOf<kTable, OfTarget, kElement>>);
    } else if constexpr (kRule == Rule::kTransitionAmbiguous) {
        return sizeof(rules::EventLeadsToOneMode<NameOf<kTable, OfSource, kElement>,
                                                 kTable.modes.transitions[kElement].event>);
    } else if constexpr (kRule == Rule::kModeUnreachable) {
        return sizeof(rules::ModeIsReachable<ModeName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kNoSafeMode) {
        return sizeof(rules::SystemHasASafeMode<ModeName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kTwoSafeModes) {
        return sizeof(rules::SystemHasOneSafeMode<ModeName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kSafeModeIsLeft) {
        return sizeof(rules::SafeModeIsLeftByResetOnly<NameOf<kTable, OfTarget, kElement>>);
    } else if constexpr (kRule == Rule::kSafeModeActivates) {
        return sizeof(
            rules::SafeModeActivatesNobody<ComponentAt<kTable, kElement>, ModeName<kTable, kOther>>);
    } else {
        return sizeof(rules::RowIsValid<rules::Row<kElement>>);
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_MODE_REFUSAL_HPP

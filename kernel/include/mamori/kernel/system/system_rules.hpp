// SPDX-License-Identifier: Apache-2.0
/// @file
/// MAMORI_CHECK: refuses a constexpr system table that breaks a rule, with a message that names the guilty
/// element by its type, its port or its window, e.g. `InputHasOneWriter<SpeedMonitor, &SpeedMonitor::joints,
/// 0>`.
///
/// @satisfies SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_RULES_HPP
#define MAMORI_KERNEL_SYSTEM_RULES_HPP

#include <cstddef>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/parameter/configuration_check.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"
#include "mamori/kernel/system/detail/connection_rules.hpp"
#include "mamori/kernel/system/detail/mode_refusal.hpp"
#include "mamori/kernel/system/detail/spelled_name.hpp"
#include "mamori/kernel/system/detail/table_element.hpp"
#include "mamori/kernel/system/detail/table_rule.hpp"
#include "mamori/kernel/system/detail/window_rules.hpp"
#include "mamori/kernel/table/system_check.hpp"

namespace mamori::detail {

/// Size of the rule that is broken, with its guilty element as arguments: asking for it ends the compilation.
template <const auto& kTable, Rule kRule, std::size_t kElement, std::size_t kOther>
constexpr std::size_t refuse() noexcept {
    if constexpr (kRule == Rule::kFrameNotPositive) {
        return sizeof(rules::FrameIsPositive<rules::Row<kElement>>);
    } else if constexpr (kRule == Rule::kWindowRowInvalid) {
        return sizeof(rules::WindowRowIsValid<rules::Row<kElement>>);
    } else if constexpr (kRule == Rule::kComponentRowInvalid) {
        return sizeof(
            rules::WorstCaseIsNotNegative<ComponentAt<kTable, kElement>, calc_instance<kTable, kElement>()>);
    } else if constexpr (kRule == Rule::kWindowNamedTwice) {
        return sizeof(rules::WindowHasANameOfItsOwn<WindowName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kTriggerUsedTwice) {
        return sizeof(
            rules::TriggerServesOneWindow<WindowName<kTable, kOther>, WindowName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kPeriodNotInFrame) {
        return sizeof(rules::PeriodDividesFrame<WindowName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kWindowOutsideFrame) {
        return sizeof(rules::WindowIsInsideItsPeriod<WindowName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kWindowsOverlap) {
        return sizeof(rules::WindowsAreDisjoint<WindowName<kTable, kOther>, WindowName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kBudgetExceedsWindow) {
        return sizeof(rules::BudgetIsInsideWindow<WindowName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kWorstCasesExceedBudget) {
        return sizeof(rules::WorstCasesFitBudget<WindowName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kRateNotOccurrences) {
        return sizeof(rules::RateEqualsOccurrences<WindowName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kRateNotReachable) {
        return sizeof(rules::AlternativeRateDividesRate<WindowName<kTable, kElement>>);
    } else if constexpr (kRule == Rule::kComponentInTwoPlaces) {
        return sizeof(rules::ComponentRunsInOneContext<ComponentAt<kTable, kElement>,
                                                       calc_instance<kTable, kElement>()>);
    } else if constexpr (kRule == Rule::kPortOfUnknownComponent) {
        return sizeof(rules::ConnectionJoinsComponentsOfTheTable<rules::Row<kElement>>);
    } else if constexpr (kRule == Rule::kInputNotConnected) {
        return sizeof(OfPort<rules::InputIsConnected, kTable, kElement>);
    } else if constexpr (kRule == Rule::kInputHasTwoWriters) {
        return sizeof(OfPort<rules::InputHasOneWriter, kTable, kElement>);
    } else if constexpr (kRule == Rule::kAgeLimitNotPositive) {
        return sizeof(OfSink<rules::InputCanBeFresh, kTable, kElement>);
    } else if constexpr (kRule == Rule::kCrossingWithoutBuffer) {
        return sizeof(OfSink<rules::InputFromElsewhereHasACrossing, kTable, kElement>);
    } else if constexpr (kRule == Rule::kCrossingUsedTwice) {
        return sizeof(OfSink<rules::InputHasACrossingOfItsOwn, kTable, kElement>);
    } else if constexpr (kRule == Rule::kCrossingNotOrdered) {
        return sizeof(OfSink<rules::ReaderNeverOpensWhileItsWriterIsOpen, kTable, kElement>);
    } else if constexpr (kRule == Rule::kFaultDeclaredTwice) {
        return sizeof(rules::FaultIsDeclaredOnce<At<typename TypesOf<kTable>::Faults, kElement>::kValue>);
    } else if constexpr (kRule == Rule::kFaultWithoutReaction || kRule == Rule::kFaultWithTwoReactions) {
        return sizeof(rules::FaultHasReaction<At<typename TypesOf<kTable>::Faults, kElement>::kValue>);
    } else if constexpr (kRule == Rule::kReactionWithoutTime || kRule == Rule::kReactionToUnknownFault) {
        return sizeof(rules::ReactionAnswersADeclaredFault<rules::Row<kElement>>);
    } else if constexpr (kRule == Rule::kConfigurationRefused) {
        return sizeof(ConfigurationKeeps<check(make_view(kTable.configuration)).rule, kElement, kOther>);
    } else {
        return refuse_modes<kTable, kRule, kElement, kOther>();
    }
}

template <const auto& kTable>
constexpr bool keeps_rules() noexcept {
    constexpr Finding kFinding = check(make_view(kTable));
    if constexpr (kFinding.rule != Rule::kNone) {
        return refuse<kTable, kFinding.rule, kFinding.element, kFinding.other>() == 0U;
    }
    return true;
}

}  // namespace mamori::detail

/// Refuses the constexpr system table `table`, which mamori::system() made, when it breaks a rule.
#define MAMORI_CHECK(table) \
    static_assert(::mamori::detail::keeps_rules<table>(), "the system table breaks the rule named above")

#endif  // MAMORI_KERNEL_SYSTEM_RULES_HPP

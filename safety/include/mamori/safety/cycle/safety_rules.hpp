// SPDX-License-Identifier: Apache-2.0
/// @file
/// MAMORI_SAFETY_CHECK: rejects a constexpr table of mamori::safety::system() that violates a rule of the
/// kernel (table_rules.hpp) or of the safety layer. The message names the faulty element.
///
/// @satisfies SWR-CYC-002, SWR-CYC-011      Design: docs/design/safety_cycle.md#the-table
#ifndef MAMORI_SAFETY_SAFETY_RULES_HPP
#define MAMORI_SAFETY_SAFETY_RULES_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/system/system_extension.hpp"
#include "mamori/safety/cycle/checkpoint_rules.hpp"
#include "mamori/safety/cycle/protection_rules.hpp"
#include "mamori/safety/cycle/safety_finding.hpp"
#include "mamori/safety/cycle/stop_source_rules.hpp"
#include "mamori/safety/cycle/system.hpp"

namespace mamori::safety {

namespace detail {

template <typename Table>
constexpr SafetyFinding check_faults(const Table& table) noexcept {
    for (std::size_t i = 0U; i < table.faults.size(); ++i) {
        if (table.faults[i].fault != i) {
            return {SafetyRule::kFaultsNumbered, i};
        }
    }
    for (std::size_t i = 0U; i < table.reactions.size(); ++i) {
        if (table.reactions[i].reaction > static_cast<std::uint32_t>(Reaction::kSto)) {
            return {SafetyRule::kReactionKnown, i};
        }
    }
    return {};
}

template <typename Table>
constexpr SafetyFinding check_supervision(const Table& table) noexcept {
    bool is_something_proven = false;
    for (std::size_t i = 0U; i < table.supervised.size(); ++i) {
        const SuperviseRow& row = table.supervised[i];
        if (find_component(table.components, row.watch.component) == kNoIndex) {
            return {SafetyRule::kSupervisedInTable, i};
        }
        for (std::size_t earlier = 0U; earlier < i; ++earlier) {
            if (table.supervised[earlier].watch.component == row.watch.component) {
                return {SafetyRule::kSupervisedOnce, i};
            }
        }
        if (!is_valid(row.watch.limits.alive)) {
            return {SafetyRule::kAliveInRange, i};
        }
        if (!is_valid(row.watch.limits.deadline)) {
            return {SafetyRule::kDeadlineInRange, i};
        }
        if (row.fault != kNoFault && row.fault >= table.faults.size()) {
            return {SafetyRule::kRaisedFaultDeclared, i};
        }
        is_something_proven = is_something_proven || row.fault == kNoFault;
    }
    return {is_something_proven ? SafetyRule::kNone : SafetyRule::kSomethingProven, 0U};
}

template <typename Table>
constexpr SafetyFinding check_confirmations(const Table& table) noexcept {
    for (std::size_t i = 0U; i < table.confirmations.size(); ++i) {
        const ConfirmRow& row = table.confirmations[i];
        if (row.fault >= table.faults.size()) {
            return {SafetyRule::kConfirmedFaultDeclared, i};
        }
        for (std::size_t earlier = 0U; earlier < i; ++earlier) {
            if (table.confirmations[earlier].fault == row.fault) {
                return {SafetyRule::kConfirmedOnce, i};
            }
        }
        if (!is_valid(row.confirmation) || !is_valid(row.healing)) {
            return {SafetyRule::kConfirmationInRange, i};
        }
    }
    return {};
}

/// @param[in] sto faults with the reaction STO: bit n = fault n.
constexpr SafetyRule check_brakes_first(const CycleRow& row, std::size_t fault_count,
                                        std::uint64_t sto) noexcept {
    if (row.brakes_first == 0U) {
        return SafetyRule::kNone;
    }
    if (fault_count > 64U || (fault_count < 64U && (row.brakes_first >> fault_count) != 0U)) {
        return SafetyRule::kBrakesFirstDeclared;
    }
    if ((row.brakes_first & ~sto) != 0U) {
        return SafetyRule::kBrakesFirstBySto;
    }
    return row.brakes.has_contacts ? SafetyRule::kNone : SafetyRule::kBrakesFirstHasContacts;
}

template <typename Table>
constexpr std::uint64_t list_sto_faults(const Table& table) noexcept {
    std::uint64_t faults = 0U;
    for (std::size_t i = 0U; i < table.reactions.size(); ++i) {
        const ReactionRow& row = table.reactions[i];
        if (row.reaction == static_cast<std::uint32_t>(Reaction::kSto)) {
            faults |= std::uint64_t{1U} << (row.fault & 63U);
        }
    }
    return faults;
}

template <typename Table>
constexpr SafetyFinding check_self_tests(const Table& table) noexcept {
    for (std::size_t i = 0U; i < table.self_tests.size(); ++i) {
        if (table.self_tests[i].fault >= table.faults.size()) {
            return {SafetyRule::kTestedFaultDeclared, i};
        }
        for (std::size_t earlier = 0U; earlier < i; ++earlier) {
            if (table.self_tests[earlier].check == table.self_tests[i].check) {
                return {SafetyRule::kTestedOnce, i};
            }
        }
    }
    return {};
}

template <typename Table>
constexpr SafetyFinding check_assumptions(const Table& table) noexcept {
    for (std::size_t i = 0U; i < table.assumptions.size(); ++i) {
        if (table.assumptions[i].assumption != i) {
            return {SafetyRule::kAssumptionsNumbered, i};
        }
        if (table.assumptions[i].within <= Duration{0}) {
            return {SafetyRule::kAssumptionHasTime, i};
        }
    }
    return {};
}

template <typename Table>
constexpr SafetyFinding check_cycle(const Table& table) noexcept {
    constexpr Duration kNothing{0};
    const CycleRow& row = table.cycle;
    if (Table::kCycleCount != 1U) {
        return {SafetyRule::kCycleOnce, Table::kCycleCount};
    }
    if (row.stops.ss1_within <= kNothing || row.stops.ss2_within <= kNothing) {
        return {SafetyRule::kStopBoundsInRange, 0U};
    }
    if (row.brakes.closes_within <= kNothing || !have_brakes_time(row.stops, row.brakes)) {
        return {SafetyRule::kBrakesHaveTime, 0U};
    }
    if (row.watchdog.shortest < kNothing || row.watchdog.shortest >= row.watchdog.longest) {
        return {SafetyRule::kWatchdogInRange, 0U};
    }
    if (row.torque_feedback <= kNothing) {
        return {SafetyRule::kTorqueFeedbackInRange, 0U};
    }
    if (row.lateness_max < kNothing) {
        return {SafetyRule::kLatenessInRange, 0U};
    }
    const bool are_declared = row.late_fault < table.faults.size() &&
                              row.self_test_fault < table.faults.size() &&
                              row.brake_fault < table.faults.size();
    if (!are_declared) {
        return {SafetyRule::kCycleFaultDeclared, 0U};
    }
    return {check_brakes_first(row, table.faults.size(), list_sto_faults(table)), 0U};
}

template <typename Table>
constexpr SafetyFinding check_safety(const Table& table) noexcept {
    SafetyFinding finding = check_faults(table);
    finding = finding.rule == SafetyRule::kNone ? check_supervision(table) : finding;
    finding = finding.rule == SafetyRule::kNone ? check_checkpoints(table) : finding;
    finding = finding.rule == SafetyRule::kNone ? check_confirmations(table) : finding;
    finding = finding.rule == SafetyRule::kNone ? check_self_tests(table) : finding;
    finding = finding.rule == SafetyRule::kNone ? check_protections(table) : finding;
    finding = finding.rule == SafetyRule::kNone ? check_assumptions(table) : finding;
    finding = finding.rule == SafetyRule::kNone ? check_cycle(table) : finding;
    return finding.rule == SafetyRule::kNone ? check_stop_sources(table) : finding;
}

}  // namespace detail

namespace detail {

template <const auto& kTable, std::size_t... kIndices>
constexpr std::size_t count_cycles(std::index_sequence<kIndices...>) noexcept {
    return (std::size_t{std::is_base_of_v<CycleComponent, extension::ComponentAt<kTable, kIndices>>} + ... +
            0U);
}
/// Sum of the indices of all cycles: the index of the only one.
template <const auto& kTable, std::size_t... kIndices>
constexpr std::size_t find_cycle(std::index_sequence<kIndices...>) noexcept {
    return ((std::is_base_of_v<CycleComponent, extension::ComponentAt<kTable, kIndices>> ? kIndices : 0U) +
            ... + 0U);
}

/// Rules of the component that executes the table. @param[in] window index of its window.
template <typename Table>
constexpr SafetyFinding check_cycle_window(const Table& table, std::size_t window) noexcept {
    const Duration period = table.windows[window].period;
    if (period < table.cycle.watchdog.shortest || period > table.cycle.watchdog.longest) {
        return {SafetyRule::kWatchdogFitsPeriod, 0U};
    }
    for (std::size_t i = 0U; i < table.supervised.size(); ++i) {
        const std::size_t index = find_component(table.components, table.supervised[i].watch.component);
        if (table.windows[table.component_rows[index].window].core != table.windows[window].core) {
            return {SafetyRule::kSupervisedOnCore, i};
        }
    }
    for (std::size_t i = 0U; i < table.protections.size(); ++i) {
        const std::size_t index = find_component(table.components, table.protections[i].component);
        if (table.windows[table.component_rows[index].window].core != table.windows[window].core) {
            return {SafetyRule::kProtectedOnCore, i};
        }
    }
    for (std::size_t i = 0U; i < table.self_tests.size(); ++i) {
        if (table.self_tests[i].found_within.ns / 2 < period.ns) {
            return {SafetyRule::kTestHasSteps, i};
        }
    }
    return {};
}

/// Index of the window that runs the safety cycle. @tparam kTable has exactly one.
template <const auto& kTable>
inline constexpr std::size_t kCycleWindow =
    kTable.component_rows[find_cycle<kTable>(std::make_index_sequence<kTable.components.size()>{})].window;

template <const auto& kTable>
constexpr SafetyFinding check_cycle_component() noexcept {
    using Indices = std::make_index_sequence<kTable.components.size()>;
    constexpr std::size_t kCount = count_cycles<kTable>(Indices{});
    if constexpr (kCount == 1U) {
        const SafetyFinding finding = check_cycle_window(kTable, kCycleWindow<kTable>);
        return finding.rule == SafetyRule::kNone
                   ? check_sources_of_cycle(kTable, find_cycle<kTable>(Indices{}))
                   : finding;
    } else {
        return {SafetyRule::kCycleComponentOnce, kCount};
    }
}
template <const auto& kTable>
constexpr SafetyFinding check_safety_of() noexcept {
    const SafetyFinding finding = check_safety(kTable);
    return finding.rule == SafetyRule::kNone ? check_cycle_component<kTable>() : finding;
}

}  // namespace detail

/// A row as a compiler message shows it, 0 is the first of its kind.
template <std::size_t kRow>
struct TableRow {};
/// What lacks its source, as a compiler message shows it.
template <StopConfirmation kConfirmation>
struct Unconfirmed {};

/// Does not compile for a violated rule; the compiler prints it with the faulty component, fault or row.
template <SafetyRule kRule, typename Faulty>
struct SafetyTableIsSound : std::true_type {
    static_assert(kRule != SafetyRule::kFaultsNumbered,
                  "faults<...>() lists the enumerators 0, 1, ... of one enumeration, in this order");
    static_assert(kRule != SafetyRule::kReactionKnown,
                  "a reaction is an enumerator of mamori::safety::Reaction");
    static_assert(kRule != SafetyRule::kSupervisedInTable,
                  "supervise(...) names a component that no window of the table runs; remove it");
    static_assert(kRule != SafetyRule::kSupervisedOnce, "a component has two supervise(...); keep one");
    static_assert(kRule != SafetyRule::kAliveInRange,
                  "alive(...) is out of range; 1 <= late_cycles <= expired_cycles");
    static_assert(kRule != SafetyRule::kDeadlineInRange,
                  "deadline(...) is out of range; 0 <= shortest <= longest and longest > 0");
    static_assert(kRule != SafetyRule::kRaisedFaultDeclared,
                  "raises(...) names a fault that faults<...>() does not declare");
    static_assert(kRule != SafetyRule::kSomethingProven,
                  "no supervise(...) without raises(...): nothing would permit the service of the watchdog");
    static_assert(kRule != SafetyRule::kConfirmedFaultDeclared,
                  "confirm(...) names a fault that faults<...>() does not declare");
    static_assert(kRule != SafetyRule::kConfirmedOnce, "a fault has two confirm(...); keep one");
    static_assert(kRule != SafetyRule::kConfirmationInRange,
                  "confirm(...) is out of range; see is_valid(Confirmation) and is_valid(Healing)");
    static_assert(kRule != SafetyRule::kCycleOnce, "a table has exactly one cycle(...)");
    static_assert(kRule != SafetyRule::kStopBoundsInRange, "the bounds of SS1 and SS2 are positive");
    static_assert(kRule != SafetyRule::kBrakesHaveTime,
                  "the brakes close in a positive time, shorter than the bound of SS1");
    static_assert(kRule != SafetyRule::kWatchdogInRange,
                  "the window of the watchdog is out of range; 0 <= shortest < longest");
    static_assert(kRule != SafetyRule::kTorqueFeedbackInRange, "the time of the torque feedback is positive");
    static_assert(kRule != SafetyRule::kLatenessInRange, "the tolerated lateness is not negative");
    static_assert(kRule != SafetyRule::kCycleFaultDeclared,
                  "cycle(...) raises a fault that faults<...>() does not declare");
    static_assert(
        kRule != SafetyRule::kCycleComponentOnce,
        "a window of the table runs exactly one component derived from SafetyCycle; the row is their "
        "number");
    static_assert(kRule != SafetyRule::kWatchdogFitsPeriod,
                  "the period of the safety cycle is inside the window of the watchdog");
    static_assert(kRule != SafetyRule::kSupervisedOnCore,
                  "a supervised component runs on the core and in the class of the safety cycle; other cores "
                  "have a supervision of their own");
    static_assert(
        kRule != SafetyRule::kBrakesFirstDeclared,
        "brakes_first<...>() names a fault that faults<...>() does not declare, or the table has more than "
        "64 faults");
    static_assert(kRule != SafetyRule::kBrakesFirstBySto,
                  "brakes_first<...>() names a fault whose reaction is STO in no mode");
    static_assert(kRule != SafetyRule::kBrakesFirstHasContacts,
                  "brakes_first<...>() needs brakes with contacts: torque ends when they report closed");
    static_assert(
        kRule != SafetyRule::kStopConfirmed,
        "a reaction stops the machine, and nothing confirms the stop; name the output that delivers "
        "the confirmation with confirmed_by(...)");
    static_assert(kRule != SafetyRule::kConfirmedByOnce,
                  "two confirmed_by(...) deliver one confirmation; keep one");
    static_assert(kRule != SafetyRule::kSourceInTable,
                  "confirmed_by(...) names an output of a component that no window of the table runs");
    static_assert(kRule != SafetyRule::kSourceSupervised,
                  "the component that confirms a stop has no supervise(...); add it");
    static_assert(
        kRule != SafetyRule::kSourceConnected,
        "the output that confirms a stop is connected to the safety cycle in each mode of the cycle");
    static_assert(kRule != SafetyRule::kSourceBeforeCycle,
                  "the component that confirms a stop runs before the safety cycle, at least as often");
    static_assert(kRule != SafetyRule::kCheckpointsOfOneTable,
                  "checkpoints<...>(...) of two supervisors or tables; use one for all components");
    static_assert(kRule != SafetyRule::kEntityKnown,
                  "checkpoints<...>(...) names an entity that its table does not have");
    static_assert(kRule != SafetyRule::kEntityOfOneComponent,
                  "two components report the checkpoints of one entity; give each its own");
    static_assert(
        kRule != SafetyRule::kEntityOfAComponent,
        "an entity of the table of checkpoints has no component; name it with checkpoints<...>(...)");
    static_assert(kRule != SafetyRule::kTestedFaultDeclared,
                  "self_test(...) raises a fault that faults<...>() does not declare");
    static_assert(kRule != SafetyRule::kTestedOnce, "a check has two self_test(...); keep one");
    static_assert(kRule != SafetyRule::kTestHasSteps,
                  "found_within(...) is at least two periods of the safety cycle, or the check has no step");
    static_assert(kRule != SafetyRule::kProtectedInTable,
                  "protect(...) names a receiver that no window of the table runs; remove it");
    static_assert(kRule != SafetyRule::kProtectedOnce, "a receiver has two protect(...); keep one");
    static_assert(kRule != SafetyRule::kProtectedFaultDeclared,
                  "protect(...) raises a fault that faults<...>() does not declare");
    static_assert(kRule != SafetyRule::kProtectedReachable,
                  "fresh_within(...) of protect(...) is at least the period of the receiver, and lead_max is "
                  "not negative");
    static_assert(
        kRule != SafetyRule::kProtectedLossesInTime,
        "the receiver accepts a gap of more messages than fit into fresh_within(...) of protect(...); "
        "lower max_delta");
    static_assert(kRule != SafetyRule::kProtectedOnCore,
                  "the receiver of protect(...) runs on the core and in the class of the safety cycle");
    static_assert(kRule != SafetyRule::kAssumptionsNumbered,
                  "assume(...) names the enumerators 0, 1, ... of one enumeration, in this order");
    static_assert(kRule != SafetyRule::kAssumptionHasTime, "the time of assume(...) is positive");
};

namespace detail {

template <typename T>
struct Shown {
    using Type = T;
};

template <const auto& kTable, SafetyRule kRule, std::size_t kRow>
constexpr auto show_faulty() noexcept {
    if constexpr ((kRule >= SafetyRule::kSupervisedOnce && kRule <= SafetyRule::kRaisedFaultDeclared) ||
                  kRule == SafetyRule::kSupervisedOnCore ||
                  (kRule >= SafetyRule::kCheckpointsOfOneTable &&
                   kRule <= SafetyRule::kEntityOfOneComponent)) {
        constexpr std::size_t kIndex =
            find_component(kTable.components, kTable.supervised[kRow].watch.component);
        return Shown<extension::ComponentAt<kTable, kIndex>>{};
    } else if constexpr (kRule >= SafetyRule::kSourceSupervised && kRule <= SafetyRule::kSourceBeforeCycle) {
        return Shown<extension::ComponentAt<kTable, find_owner(kTable, kTable.stop_sources[kRow].port)>>{};
    } else if constexpr (kRule >= SafetyRule::kProtectedOnce && kRule <= SafetyRule::kProtectedOnCore) {
        constexpr std::size_t kIndex = find_component(kTable.components, kTable.protections[kRow].component);
        return Shown<extension::ComponentAt<kTable, kIndex>>{};
    } else if constexpr (kRule == SafetyRule::kStopConfirmed) {
        return Shown<Unconfirmed<static_cast<StopConfirmation>(kRow)>>{};
    } else if constexpr (kRule == SafetyRule::kConfirmedOnce || kRule == SafetyRule::kConfirmationInRange) {
        return Shown<extension::FaultAt<kTable, kTable.confirmations[kRow].fault>>{};
    } else if constexpr (kRule == SafetyRule::kTestedOnce || kRule == SafetyRule::kTestHasSteps) {
        return Shown<extension::FaultAt<kTable, kTable.self_tests[kRow].fault>>{};
    } else if constexpr (kRule == SafetyRule::kFaultsNumbered) {
        return Shown<extension::FaultAt<kTable, kRow>>{};
    } else {
        return Shown<TableRow<kRow>>{};
    }
}

}  // namespace detail

/// @tparam kTable constexpr table of safety::system(), of static storage. @return true; every other outcome
/// does not compile.
template <const auto& kTable>
constexpr bool keeps_safety_rules() noexcept {
    if constexpr (extension::keeps_rules<kTable>()) {
        using Types = typename std::remove_const_t<std::remove_reference_t<decltype(kTable)>>::Types;
        constexpr SafetyFinding kFinding = extension::kHasReactionsOf<Reaction, Types>
                                               ? detail::check_safety_of<kTable>()
                                               : SafetyFinding{SafetyRule::kReactionKnown, 0U};
        using Faulty = typename decltype(detail::show_faulty<kTable, kFinding.rule, kFinding.row>())::Type;
        return SafetyTableIsSound<kFinding.rule, Faulty>::value;
    }
    return false;
}

}  // namespace mamori::safety

/// Rejects the constexpr table `table`, made by mamori::safety::system(), if it violates a rule.
#define MAMORI_SAFETY_CHECK(table)                               \
    static_assert(::mamori::safety::keeps_safety_rules<table>(), \
                  "the system table violates the rule named above")

#endif  // MAMORI_SAFETY_SAFETY_RULES_HPP

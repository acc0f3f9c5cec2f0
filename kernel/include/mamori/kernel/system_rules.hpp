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
#include <type_traits>
#include <utility>

#include "mamori/kernel/system_builder.hpp"
#include "mamori/kernel/system_check.hpp"

namespace mamori {

/// Name of a window, letter by letter, since C++17 has no strings as template arguments.
template <char... kLetters>
struct Name {};

namespace rules {

/// Never true, but only known when instantiated.
template <typename...>
inline constexpr bool kKept = false;
/// A row that has no better name than its number.
template <std::size_t kIndex>
struct Row {};

// The last argument of a component or port tells instances of one type apart: 0 is the first in the table.

template <typename Element>
struct RowIsValid {
    static_assert(kKept<Element>, "a row of the table is invalid in itself; build it with mamori::system()");
};
template <typename Element>
struct FrameIsPositive {
    static_assert(kKept<Element>, "a frame has a positive length");
};
template <typename WindowName>
struct PeriodDividesFrame {
    static_assert(kKept<WindowName>, "the period of a window divides the frame");
};
template <typename WindowName>
struct WindowIsInsideItsPeriod {
    static_assert(kKept<WindowName>, "a window opens and closes within its period, at most the frame");
};
template <typename WindowName, typename OtherName>
struct WindowsAreDisjoint {
    static_assert(kKept<WindowName>, "windows of one core never overlap");
};
template <typename WindowName>
struct BudgetIsInsideWindow {
    static_assert(kKept<WindowName>, "the budget of a window is positive and not longer than the window");
};
template <typename WindowName>
struct WorstCasesFitBudget {
    static_assert(kKept<WindowName>, "the declared worst cases of a window together fit into its budget");
};
template <typename WindowName>
struct RateEqualsOccurrences {
    static_assert(kKept<WindowName>, "the declared rate of a window is that of its openings");
};
template <typename WindowName>
struct AlternativeRateDividesRate {
    static_assert(kKept<WindowName>,
                  "a slower rate is reached by leaving openings out, so it divides the first");
};
template <typename C, std::size_t kInstance>
struct ComponentRunsInOneContext {
    static_assert(kKept<C>, "a component runs in one window, once");
};
template <typename Connection>
struct ConnectionJoinsComponentsOfTheTable {
    static_assert(kKept<Connection>, "both ends of a connection belong to components that a window runs");
};
template <typename C, auto kPort, std::size_t kInstance>
struct InputIsConnected {
    static_assert(kKept<C>, "a mandatory input is connected");
};
template <typename C, auto kPort, std::size_t kInstance>
struct InputHasOneWriter {
    static_assert(kKept<C>, "an input has one writer");
};
template <typename C, auto kPort, std::size_t kInstance>
struct InputFromElsewhereHasACrossing {
    static_assert(kKept<C>,
                  "a connection between cores or partitions goes through(...) a Crossing, or to a queue");
};
template <typename C, auto kPort, std::size_t kInstance>
struct InputHasACrossingOfItsOwn {
    static_assert(kKept<C>, "a Crossing serves one connection");
};
template <typename C, auto kPort, std::size_t kInstance>
struct ReaderNeverOpensWhileItsWriterIsOpen {
    static_assert(kKept<C>,
                  "a latest value crosses cores between the close of its writer and its next opening");
};
template <auto kFault>
struct FaultHasReaction {
    static_assert(kKept<decltype(kFault)>,
                  "a declared fault has exactly one reaction: add react(fault, ...)");
};
template <typename Reaction>
struct ReactionAnswersADeclaredFault {
    static_assert(kKept<Reaction>, "a reaction answers a declared fault, in a positive time");
};

template <typename ModeName>
struct ModeHasANameOfItsOwn {
    static_assert(kKept<ModeName>, "each mode has a name of its own");
};
template <typename ModeName, typename C>
struct ModeRunsComponentsOfTheTable {
    static_assert(kKept<ModeName>, "a mode runs components that a window runs");
};
template <typename ModeName, typename SetName>
struct ModeHasAKnownConfigurationSet {
    static_assert(kKept<ModeName>, "the parameters of a mode are a configuration_set of the table");
};
template <typename C, std::size_t kInstance>
struct ComponentRunsInSomeMode {
    static_assert(kKept<C>, "each component runs in at least one mode");
};
template <typename ModeName, typename Input>
struct InputIsFedInEachModeOfItsComponent {
    static_assert(kKept<ModeName>,
                  "in each mode that runs its component, a mandatory input is fed by a component that runs");
};
template <typename ModeName>
struct ConnectionHoldsInKnownModes {
    static_assert(kKept<ModeName>, "only_in(...) names modes of the table");
};
template <typename SourceName, typename TargetName>
struct TransitionJoinsKnownModes {
    static_assert(kKept<SourceName>, "a transition leads from a mode of the table to a mode of the table");
};
template <typename SourceName, std::size_t kEvent>
struct EventLeadsToOneMode {
    static_assert(kKept<SourceName>, "an event has at most one transition in each mode");
};
template <typename ModeName>
struct ModeIsReachable {
    static_assert(kKept<ModeName>, "transitions lead from the first mode to each other one");
};
template <typename FirstMode>
struct SystemHasASafeMode {
    static_assert(kKept<FirstMode>, "a system with modes has a safe_mode(...)");
};
template <typename ModeName>
struct SystemHasOneSafeMode {
    static_assert(kKept<ModeName>, "a system has one safe_mode(...)");
};
template <typename TargetName>
struct SafeModeIsLeftByResetOnly {
    static_assert(kKept<TargetName>, "no transition leaves the safe mode");
};
template <typename C, typename ModeName>
struct SafeModeActivatesNobody {
    static_assert(kKept<C>, "each component of the safe mode runs in every mode");
};

}  // namespace rules

namespace detail {

template <std::size_t kIndex, typename T>
struct Indexed {
    using Type = T;
};
template <typename Sequence, typename List>
struct IndexedList;
template <std::size_t... kIndices, typename... Ts>
struct IndexedList<std::index_sequence<kIndices...>, TypeList<Ts...>> : Indexed<kIndices, Ts>... {};

template <std::size_t kIndex, typename T>
Indexed<kIndex, T> pick(const Indexed<kIndex, T>*) noexcept;
/// Type number `kIndex` of a list.
template <typename List, std::size_t kIndex>
using At = typename decltype(pick<kIndex>(
    static_cast<const IndexedList<std::make_index_sequence<List::kSize>, List>*>(nullptr)))::Type;

constexpr std::size_t calc_length(const char* text) noexcept {
    std::size_t length = 0U;
    while (text[length] != '\0') {  // ends with the text
        ++length;
    }
    return length;
}

// Where a name is found in a table.
struct OfWindow {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.windows[i].name;
    }
};
struct OfMode {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.modes.modes[i].name;
    }
};
struct OfSetOfMode {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.modes.modes[i].set_name;
    }
};
struct OfSource {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.modes.transitions[i].source_name;
    }
};
struct OfTarget {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.modes.transitions[i].target_name;
    }
};
struct OfConnectionMode {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.modes.connection_modes[i].mode_name;
    }
};

template <const auto& kTable, typename Of, std::size_t kIndex, std::size_t... kLetters>
Name<Of::get(kTable, kIndex)[kLetters]...> spell(std::index_sequence<kLetters...>) noexcept;
template <const auto& kTable, typename Of, std::size_t kIndex>
using NameOf =
    decltype(spell<kTable, Of, kIndex>(std::make_index_sequence<calc_length(Of::get(kTable, kIndex))>{}));
template <const auto& kTable, std::size_t kWindow>
using WindowName = NameOf<kTable, OfWindow, kWindow>;
template <const auto& kTable, std::size_t kMode>
using ModeName = NameOf<kTable, OfMode, kMode>;

/// How many components of the same type the table lists before component `kIndex`.
template <typename Components, std::size_t kIndex, std::size_t... kBefore>
constexpr std::size_t count_same_before(std::index_sequence<kBefore...>) noexcept {
    return ((std::is_same_v<At<Components, kBefore>, At<Components, kIndex>> ? 1U : 0U) + ... + 0U);
}
template <const auto& kTable, std::size_t kComponent>
constexpr std::size_t calc_instance() noexcept {
    using Components = typename std::remove_reference_t<decltype(kTable)>::Types::Components;
    return count_same_before<Components, kComponent>(std::make_index_sequence<kComponent>{});
}

template <typename Table>
constexpr std::size_t find_input(const Table& table, const InPortBase* input) noexcept {
    for (std::size_t i = 0U; i < table.ports.size(); ++i) {
        if (table.ports[i].input == input) {
            return i;
        }
    }
    return kNoIndex;
}

// Elements under the names that the rules want.
template <const auto& kTable>
using TypesOf = typename std::remove_reference_t<decltype(kTable)>::Types;
template <const auto& kTable, std::size_t kIndex>
using ComponentAt = At<typename TypesOf<kTable>::Components, kIndex>;
template <const auto& kTable, std::size_t kIndex>
using PortAt = At<typename TypesOf<kTable>::Ports, kIndex>;

template <template <typename, auto, std::size_t> class RuleOf, const auto& kTable, std::size_t kPort>
using OfPort = RuleOf<typename PortAt<kTable, kPort>::Owner, PortAt<kTable, kPort>::kPointer,
                      calc_instance<kTable, kTable.ports[kPort].component>()>;
template <template <typename, auto, std::size_t> class RuleOf, const auto& kTable, std::size_t kConnection>
using OfSink = OfPort<RuleOf, kTable, find_input(kTable, kTable.connections[kConnection].sink)>;

/// The same for a rule of the modes.
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

/// Size of the rule that is broken, with its guilty element as arguments: asking for it ends the compilation.
template <const auto& kTable, Rule kRule, std::size_t kElement, std::size_t kOther>
constexpr std::size_t refuse() noexcept {
    if constexpr (kRule == Rule::kFrameNotPositive) {
        return sizeof(rules::FrameIsPositive<rules::Row<kElement>>);
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
    } else if constexpr (kRule == Rule::kCrossingWithoutBuffer) {
        return sizeof(OfSink<rules::InputFromElsewhereHasACrossing, kTable, kElement>);
    } else if constexpr (kRule == Rule::kCrossingUsedTwice) {
        return sizeof(OfSink<rules::InputHasACrossingOfItsOwn, kTable, kElement>);
    } else if constexpr (kRule == Rule::kCrossingNotOrdered) {
        return sizeof(OfSink<rules::ReaderNeverOpensWhileItsWriterIsOpen, kTable, kElement>);
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

}  // namespace detail

}  // namespace mamori

/// Refuses the constexpr system table `table`, which mamori::system() made, when it breaks a rule.
#define MAMORI_CHECK(table) \
    static_assert(::mamori::detail::keeps_rules<table>(), "the system table breaks the rule named above")

#endif  // MAMORI_KERNEL_SYSTEM_RULES_HPP

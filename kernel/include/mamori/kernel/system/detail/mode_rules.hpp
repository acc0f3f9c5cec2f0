// SPDX-License-Identifier: Apache-2.0
/// @file
/// What MAMORI_CHECK says of a mode or a transition that breaks a rule. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-MOD-003      Design: docs/design/modes.md#what-the-compiler-refuses
#ifndef MAMORI_KERNEL_MODE_RULES_HPP
#define MAMORI_KERNEL_MODE_RULES_HPP

#include <cstddef>

#include "mamori/kernel/system/detail/table_rule.hpp"

namespace mamori {

namespace rules {

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

}  // namespace mamori

#endif  // MAMORI_KERNEL_MODE_RULES_HPP

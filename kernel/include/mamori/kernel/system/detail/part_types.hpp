// SPDX-License-Identifier: Apache-2.0
/// @file
/// Contribution of the parts of a description to the table, as types and counts, from which the size of the
/// table is calculated. Not for users.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_PART_TYPES_HPP
#define MAMORI_KERNEL_PART_TYPES_HPP

#include <cstddef>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/parameter/configuration_set.hpp"

namespace mamori::detail {

/// A part without contribution; each kind of part derives from it and overrides its own contribution.
struct NoTypes {
    using Components = TypeList<>;
    using Ports = TypeList<>;
    using Parameters = TypeList<>;
    using Faults = TypeList<>;
    using FaultTypes = TypeList<>;          ///< enumeration of each fault, in faults() or react()
    using ReactionTypes = TypeList<>;       ///< enumeration of each reaction
    using Members = TypeList<>;             ///< components that the modes run, mode by mode
    using Events = TypeList<>;              ///< enumeration of the event of each transition
    using ModeEnumerators = TypeList<>;     ///< of the modes that have one
    using ModelledComponents = TypeList<>;  ///< component of each modelled time
    using Extensions = TypeList<>;          ///< parts that a layer above adds to its own table
    static constexpr std::size_t kWindows = 0U;
    static constexpr std::size_t kConnections = 0U;
    static constexpr std::size_t kReactions = 0U;
    static constexpr std::size_t kSets = 0U;
    static constexpr std::size_t kAssignments = 0U;
    static constexpr std::size_t kValues = 0U;
    static constexpr std::size_t kModes = 0U;
    static constexpr std::size_t kModeTransitions = 0U;
    static constexpr std::size_t kConnectionModes = 0U;
    static constexpr std::size_t kActionBudgets = 0U;
    static constexpr bool kHasTraceHash = false;
};

template <typename Part>
struct TypesOfPart : Part::Types {};
/// Configuration sets are defined independent of systems.
template <std::size_t kAssignmentCount, std::size_t kValueCount>
struct TypesOfPart<ConfigurationSet<kAssignmentCount, kValueCount>> : NoTypes {
    static constexpr std::size_t kSets = 1U;
    static constexpr std::size_t kAssignments = kAssignmentCount;
    static constexpr std::size_t kValues = kValueCount;
};

/// Contribution of all parts together.
template <typename... Parts>
struct JoinedTypes {
    using Components = typename Concat<typename TypesOfPart<Parts>::Components...>::Type;
    using Ports = typename Concat<typename TypesOfPart<Parts>::Ports...>::Type;
    using Parameters = typename Concat<typename TypesOfPart<Parts>::Parameters...>::Type;
    using Faults = typename Concat<typename TypesOfPart<Parts>::Faults...>::Type;
    using FaultTypes = typename Concat<typename TypesOfPart<Parts>::FaultTypes...>::Type;
    using ReactionTypes = typename Concat<typename TypesOfPart<Parts>::ReactionTypes...>::Type;
    using Members = typename Concat<typename TypesOfPart<Parts>::Members...>::Type;
    using Events = typename Concat<typename TypesOfPart<Parts>::Events...>::Type;
    using ModeEnumerators = typename Concat<typename TypesOfPart<Parts>::ModeEnumerators...>::Type;
    using ModelledComponents = typename Concat<typename TypesOfPart<Parts>::ModelledComponents...>::Type;
    using Extensions = typename Concat<typename TypesOfPart<Parts>::Extensions...>::Type;
    static constexpr std::size_t kWindows = (TypesOfPart<Parts>::kWindows + ... + 0U);
    static constexpr std::size_t kConnections = (TypesOfPart<Parts>::kConnections + ... + 0U);
    static constexpr std::size_t kReactions = (TypesOfPart<Parts>::kReactions + ... + 0U);
    static constexpr std::size_t kSets = (TypesOfPart<Parts>::kSets + ... + 0U);
    static constexpr std::size_t kAssignments = (TypesOfPart<Parts>::kAssignments + ... + 0U);
    static constexpr std::size_t kValues = (TypesOfPart<Parts>::kValues + ... + 0U);
    static constexpr std::size_t kModes = (TypesOfPart<Parts>::kModes + ... + 0U);
    static constexpr std::size_t kModeTransitions = (TypesOfPart<Parts>::kModeTransitions + ... + 0U);
    static constexpr std::size_t kConnectionModes = (TypesOfPart<Parts>::kConnectionModes + ... + 0U);
    static constexpr std::size_t kActionBudgets = (TypesOfPart<Parts>::kActionBudgets + ... + 0U);
    static constexpr bool kHasTraceHash = (TypesOfPart<Parts>::kHasTraceHash || ...);
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_PART_TYPES_HPP

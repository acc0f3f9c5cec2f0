// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/table/system_check.hpp"

#include <array>

namespace mamori {
namespace {

/// In the order of Rule.
constexpr std::array<const char*, 45> kNames{{
    "None",
    "FrameNotPositive",
    "WindowRowInvalid",
    "ComponentRowInvalid",
    "PortRowInvalid",
    "ConnectionRowInvalid",
    "WindowNamedTwice",
    "TriggerUsedTwice",
    "PeriodNotInFrame",
    "WindowOutsideFrame",
    "WindowsOverlap",
    "BudgetExceedsWindow",
    "WorstCasesExceedBudget",
    "RateNotOccurrences",
    "RateNotReachable",
    "ComponentInTwoPlaces",
    "PortOfUnknownComponent",
    "InputNotConnected",
    "InputHasTwoWriters",
    "AgeLimitNotPositive",
    "CrossingWithoutBuffer",
    "CrossingUsedTwice",
    "CrossingNotOrdered",
    "FaultDeclaredTwice",
    "FaultWithoutReaction",
    "FaultWithTwoReactions",
    "ReactionWithoutTime",
    "ReactionToUnknownFault",
    "ParameterRowInvalid",
    "SetRowInvalid",
    "ConfigurationRefused",
    "ModeRowInvalid",
    "ModeNamedTwice",
    "ModeOfUnknownComponent",
    "ModeOfUnknownSet",
    "ComponentInNoMode",
    "InputNotFedInMode",
    "ConnectionOfUnknownMode",
    "TransitionOfUnknownMode",
    "TransitionAmbiguous",
    "ModeUnreachable",
    "NoSafeMode",
    "TwoSafeModes",
    "SafeModeIsLeft",
    "SafeModeActivates",
}};
static_assert(kNames.size() == static_cast<std::size_t>(Rule::kSafeModeActivates) + 1U,
              "each rule has a name");

}  // namespace

const char* get_name(Rule rule) noexcept {
    const auto index = static_cast<std::size_t>(rule);
    const char* name = "Invalid";  // only a corrupted value is beyond
    if (index < kNames.size()) {
        name = kNames[index];
    }
    return name;
}

}  // namespace mamori

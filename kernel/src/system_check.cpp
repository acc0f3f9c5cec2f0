// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/system_check.hpp"

namespace mamori {

const char* get_name(Rule rule) noexcept {
    switch (rule) {
        case Rule::kNone:
            return "None";
        case Rule::kFrameNotPositive:
            return "FrameNotPositive";
        case Rule::kWindowRowInvalid:
            return "WindowRowInvalid";
        case Rule::kComponentRowInvalid:
            return "ComponentRowInvalid";
        case Rule::kPortRowInvalid:
            return "PortRowInvalid";
        case Rule::kConnectionRowInvalid:
            return "ConnectionRowInvalid";
        case Rule::kPeriodNotInFrame:
            return "PeriodNotInFrame";
        case Rule::kWindowOutsideFrame:
            return "WindowOutsideFrame";
        case Rule::kWindowsOverlap:
            return "WindowsOverlap";
        case Rule::kBudgetExceedsWindow:
            return "BudgetExceedsWindow";
        case Rule::kWorstCasesExceedBudget:
            return "WorstCasesExceedBudget";
        case Rule::kRateNotOccurrences:
            return "RateNotOccurrences";
        case Rule::kRateNotReachable:
            return "RateNotReachable";
        case Rule::kComponentInTwoPlaces:
            return "ComponentInTwoPlaces";
        case Rule::kPortOfUnknownComponent:
            return "PortOfUnknownComponent";
        case Rule::kInputNotConnected:
            return "InputNotConnected";
        case Rule::kInputHasTwoWriters:
            return "InputHasTwoWriters";
        case Rule::kCrossingWithoutBuffer:
            return "CrossingWithoutBuffer";
        case Rule::kCrossingUsedTwice:
            return "CrossingUsedTwice";
        case Rule::kCrossingNotOrdered:
            return "CrossingNotOrdered";
        case Rule::kFaultWithoutReaction:
            return "FaultWithoutReaction";
        case Rule::kFaultWithTwoReactions:
            return "FaultWithTwoReactions";
        case Rule::kReactionWithoutTime:
            return "ReactionWithoutTime";
        case Rule::kReactionToUnknownFault:
            return "ReactionToUnknownFault";
    }
    return "Invalid";  // only a corrupted value comes here
}

}  // namespace mamori

// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a fault leads to, and the demand that a latched fault makes.
///
/// @satisfies SWR-FLT-005, SWR-FLT-012      Design: docs/design/supervision.md#reactions
/// Source:   IEC 61800-5-2 (STO, SS1, SS2)
#ifndef MAMORI_SAFETY_REACTION_HPP
#define MAMORI_SAFETY_REACTION_HPP

#include <cstdint>

#include "mamori/kernel/base/time.hpp"

namespace mamori::safety {

/// Number of a fault, 0 .. count - 1 of the application's enumeration.
using FaultIndex = std::uint16_t;

/// "No fault".
inline constexpr FaultIndex kNoFault = 0xFFFFU;

/// What a fault leads to; ordered, the severest is the largest. Stops are named as in IEC 61800-5-2.
enum class Reaction : std::uint8_t {
    kNone,     ///< recorded only
    kDegrade,  ///< go on with reduced limits
    kSs2,      ///< controlled stop, then hold the position under torque (stop category 2)
    kSs1,      ///< controlled stop, then torque off and brakes closed (stop category 1)
    kSto,      ///< torque off and brakes closed at once (stop category 0)
};

/// Spelling for logs and reports; "Invalid" for a corrupted value, never nullptr.
constexpr const char* get_name(Reaction reaction) noexcept {
    switch (reaction) {
        case Reaction::kNone:
            return "None";
        case Reaction::kDegrade:
            return "Degrade";
        case Reaction::kSs2:
            return "Ss2";
        case Reaction::kSs1:
            return "Ss1";
        case Reaction::kSto:
            return "Sto";
    }
    return "Invalid";
}

/// What is demanded of the state machine.
struct ReactionDemand {
    Reaction reaction{Reaction::kNone};
    FaultIndex fault{kNoFault};  ///< the fault that demands it; kNoFault: no demand
    Duration within{0};          ///< from the latching of the fault to the start of the reaction
};

/// True when `demand` is more severe than `other`, or as severe with a shorter time, or when there is no
/// other.
/// @param[in] demand of a fault.
constexpr bool is_worse(const ReactionDemand& demand, const ReactionDemand& other) noexcept {
    return other.fault == kNoFault || demand.reaction > other.reaction ||
           (demand.reaction == other.reaction && demand.within < other.within);
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_REACTION_HPP

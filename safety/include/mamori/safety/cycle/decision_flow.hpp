// SPDX-License-Identifier: Apache-2.0
/// @file
/// Logical supervision of the safety cycle itself: in each frame it begins, judges and commands, each once
/// and in this order. A program counter that jumps over the judgement leaves the watchdog unserved.
///
/// @satisfies SWR-CYC-006      Design: docs/design/safety_cycle.md#order
#ifndef MAMORI_SAFETY_DECISION_FLOW_HPP
#define MAMORI_SAFETY_DECISION_FLOW_HPP

#include <array>

#include "mamori/safety/supervision/checkpoint_supervisor.hpp"

namespace mamori::safety {

enum class FlowEntity { kDecision };
enum class FlowPoint {
    kBegun,      ///< the inputs of this frame are looked at
    kJudged,     ///< the safe-state machine has made its step
    kCommanded,  ///< the commands of this frame are written
};

inline constexpr std::array kFlowEntities{supervise(FlowEntity::kDecision)};
inline constexpr std::array kFlowPoints{
    checkpoint(FlowPoint::kBegun, FlowEntity::kDecision, CheckpointRole::kInitial),
    checkpoint(FlowPoint::kJudged, FlowEntity::kDecision, CheckpointRole::kInner),
    checkpoint(FlowPoint::kCommanded, FlowEntity::kDecision, CheckpointRole::kFinal)};
/// Once in each frame: a supervision cycle is one.
inline constexpr std::array kFlowAlives{alive(FlowPoint::kCommanded, {1U, 0U, 0U, 1U})};
inline constexpr std::array kFlowEdges{edge(FlowPoint::kBegun, FlowPoint::kJudged),
                                       edge(FlowPoint::kJudged, FlowPoint::kCommanded)};
/// Expired for good in the first cycle: nothing acknowledges it but a restart of the program.
inline constexpr SupervisionTable kDecisionFlow{kFlowEntities, kFlowPoints, kFlowAlives, {},
                                                kFlowEdges,    1U,          0U};
static_assert(is_sound<kDecisionFlow>());

/// Supervision with its storage; static storage, one per safety cycle.
struct DecisionFlow {
    constexpr DecisionFlow() noexcept = default;
    DecisionFlow(const DecisionFlow&) = delete;
    DecisionFlow& operator=(const DecisionFlow&) = delete;

    void report(FlowPoint point, Instant now) noexcept {
        storage.get_log(FlowEntity::kDecision).report(point, now);
    }

    SupervisionStorage<kDecisionFlow> storage{};
    ExpiryStorage expiry{};  ///< nothing looks at it after a restart
    ExpiryMemory memory{expiry};
    CheckpointSupervisor supervisor{storage, memory};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_DECISION_FLOW_HPP

// SPDX-License-Identifier: Apache-2.0
/// @file
/// Logical supervision of the supervisor itself: in each frame it begins, judges and commands, each once and
/// in this order. A program counter that jumps over the judgement leaves the watchdog unserved.
///
/// @satisfies SWR-SAF-022      Design: docs/design/safe_arm.md#watchdog
#ifndef EXAMPLES_SAFE_ARM_DECISION_FLOW_HPP
#define EXAMPLES_SAFE_ARM_DECISION_FLOW_HPP

#include <array>

#include "mamori/safety/supervision/checkpoint_supervisor.hpp"

namespace safe_arm {

enum class FlowEntity { kDecision };
enum class FlowPoint {
    kBegun,      ///< the inputs of this frame are looked at
    kJudged,     ///< the safe-state machine has made its step
    kCommanded,  ///< the commands of this frame are written
};

inline constexpr std::array kFlowEntities{mamori::safety::supervise(FlowEntity::kDecision)};
inline constexpr std::array kFlowPoints{
    mamori::safety::checkpoint(FlowPoint::kBegun, FlowEntity::kDecision,
                               mamori::safety::CheckpointRole::kInitial),
    mamori::safety::checkpoint(FlowPoint::kJudged, FlowEntity::kDecision,
                               mamori::safety::CheckpointRole::kInner),
    mamori::safety::checkpoint(FlowPoint::kCommanded, FlowEntity::kDecision,
                               mamori::safety::CheckpointRole::kFinal)};
/// Once in each frame: a supervision cycle is one.
inline constexpr std::array kFlowAlives{mamori::safety::alive(FlowPoint::kCommanded, {1U, 0U, 0U, 1U})};
inline constexpr std::array kFlowEdges{mamori::safety::edge(FlowPoint::kBegun, FlowPoint::kJudged),
                                       mamori::safety::edge(FlowPoint::kJudged, FlowPoint::kCommanded)};
/// Expired for good in the first cycle: nothing acknowledges it but a restart of the program.
inline constexpr mamori::safety::SupervisionTable kDecisionFlow{kFlowEntities, kFlowPoints, kFlowAlives, {},
                                                                kFlowEdges,    1U,          0U};
static_assert(mamori::safety::is_sound<kDecisionFlow>());

/// Supervision with its storage; static storage, one per supervisor.
struct DecisionFlow {
    constexpr DecisionFlow() noexcept = default;
    DecisionFlow(const DecisionFlow&) = delete;
    DecisionFlow& operator=(const DecisionFlow&) = delete;

    void report(FlowPoint point, mamori::Instant now) noexcept {
        storage.get_log(FlowEntity::kDecision).report(point, now);
    }

    mamori::safety::SupervisionStorage<kDecisionFlow> storage{};
    mamori::safety::ExpiryStorage expiry{};  ///< this program does not look at it after a restart
    mamori::safety::ExpiryMemory memory{expiry};
    mamori::safety::CheckpointSupervisor supervisor{storage, memory};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_DECISION_FLOW_HPP

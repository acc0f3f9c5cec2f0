// SPDX-License-Identifier: Apache-2.0
/// @file
/// Why a table of checkpoints is refused, and what the compiler says then.
///
/// @satisfies SWR-SUP-033, SWR-SUP-034, SWR-SUP-035
/// Design:   docs/design/supervision.md#checkpoint-table
#ifndef MAMORI_SAFETY_SUPERVISION_SUPERVISION_FAULT_HPP
#define MAMORI_SAFETY_SUPERVISION_SUPERVISION_FAULT_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace mamori::safety {

/// What is wrong with a table; `SupervisionFinding::row` is the number of the row that is named here.
enum class SupervisionFault : std::uint8_t {
    kNone,
    kTableEmpty,                   ///< no row
    kModeCount,                    ///< no row
    kEntityTwice,                  ///< entity; `other` is the earlier one
    kEntityOutOfOrder,             ///< entity
    kEntityInNoMode,               ///< entity
    kEntityUnsupervised,           ///< entity
    kModeUnsupervised,             ///< mode
    kCheckpointTwice,              ///< checkpoint; `other` is the earlier one
    kCheckpointOutOfOrder,         ///< checkpoint
    kCheckpointOfUnknownEntity,    ///< checkpoint
    kCheckpointUnused,             ///< checkpoint
    kAliveOfUnknownCheckpoint,     ///< alive
    kAliveTwice,                   ///< alive; `other` is the earlier one
    kAliveNothingExpected,         ///< alive
    kAliveMargin,                  ///< alive
    kAliveBeyondQueue,             ///< alive
    kDeadlineOfUnknownCheckpoint,  ///< deadline
    kDeadlineToItself,             ///< deadline
    kDeadlineBetweenEntities,      ///< deadline
    kDeadlineLimits,               ///< deadline
    kDeadlineTwice,                ///< deadline; `other` is the earlier one
    kEdgeOfUnknownCheckpoint,      ///< edge
    kEdgeOfUnorderedCheckpoint,    ///< edge
    kEdgeBetweenEntities,          ///< edge
    kEdgeLeavesFinal,              ///< edge
    kEdgeTwice,                    ///< edge; `other` is the earlier one
    kGraphWithoutInitial,          ///< entity
    kCheckpointUnreachable,        ///< checkpoint
    kCheckpointIsDeadEnd,          ///< checkpoint
    kDeadlineBypassed,             ///< deadline
};

/// The first fault of a table; kNone when it has none.
struct SupervisionFinding {
    SupervisionFault fault{SupervisionFault::kNone};
    std::size_t row{0U};
    std::size_t other{0U};
};

/// Fails to compile for a fault; the compiler prints it with the number of the guilty row.
template <SupervisionFault kFault, std::size_t kRow, std::size_t kOther>
struct SupervisionIsSound : std::true_type {
    using Fault = SupervisionFault;
    static_assert(kFault != Fault::kTableEmpty, "table without an entity; add a row supervise(<entity>)");
    static_assert(kFault != Fault::kModeCount, "number of modes is not in 1 .. 32; correct mode_count");
    static_assert(kFault != Fault::kEntityTwice, "entity that is listed twice; keep one row");
    static_assert(kFault != Fault::kEntityOutOfOrder,
                  "entities are not listed as 0, 1, 2 ...; list them in the order of their enumeration");
    static_assert(kFault != Fault::kEntityInNoMode,
                  "entity that is active in no mode; add a mode, or remove the entity");
    static_assert(kFault != Fault::kEntityUnsupervised,
                  "entity without any supervision; give it a checkpoint with an alive, a deadline or a role");
    static_assert(kFault != Fault::kModeUnsupervised,
                  "mode in which no entity is active: nothing would be proven; add the mode to an entity");
    static_assert(kFault != Fault::kCheckpointTwice, "checkpoint that is listed twice; keep one row");
    static_assert(kFault != Fault::kCheckpointOutOfOrder,
                  "checkpoints are not listed as 0, 1, 2 ...; list them in the order of their enumeration");
    static_assert(kFault != Fault::kCheckpointOfUnknownEntity,
                  "checkpoint of an entity that is not in the table; add a row supervise(<entity>)");
    static_assert(kFault != Fault::kCheckpointUnused,
                  "checkpoint that nothing is demanded of; add an alive, a deadline or a role, or remove it");
    static_assert(kFault != Fault::kAliveOfUnknownCheckpoint,
                  "alive of a checkpoint that is not in the table; add a row checkpoint(...)");
    static_assert(kFault != Fault::kAliveTwice, "checkpoint with two alive rows; keep one");
    static_assert(kFault != Fault::kAliveNothingExpected,
                  "alive that expects nothing, or in no time; expected and reference_cycles are at least 1");
    static_assert(kFault != Fault::kAliveMargin,
                  "alive whose margin takes all that is expected; min_margin is less than expected");
    static_assert(kFault != Fault::kAliveBeyondQueue,
                  "alive that allows more reports than a queue holds; expected + max_margin is at most "
                  "kPendingCheckpointsMax in each supervision cycle");
    static_assert(kFault != Fault::kDeadlineOfUnknownCheckpoint,
                  "deadline of a checkpoint that is not in the table; add a row checkpoint(...)");
    static_assert(kFault != Fault::kDeadlineToItself,
                  "deadline from a checkpoint to itself; count it with alive(...)");
    static_assert(kFault != Fault::kDeadlineBetweenEntities,
                  "deadline between two entities; both ends are checkpoints of one entity");
    static_assert(kFault != Fault::kDeadlineLimits,
                  "deadline with limits out of range; 0 <= shortest <= longest and longest > 0");
    static_assert(kFault != Fault::kDeadlineTwice, "deadline that is listed twice; keep one row");
    static_assert(kFault != Fault::kEdgeOfUnknownCheckpoint,
                  "edge of a checkpoint that is not in the table; add a row checkpoint(...)");
    static_assert(kFault != Fault::kEdgeOfUnorderedCheckpoint,
                  "edge of a checkpoint without a role; give it kInitial, kInner or kFinal");
    static_assert(kFault != Fault::kEdgeBetweenEntities,
                  "edge between two entities; both ends are checkpoints of one entity");
    static_assert(kFault != Fault::kEdgeLeavesFinal,
                  "edge out of a final checkpoint, which ends the run; make it kInner or remove the edge");
    static_assert(kFault != Fault::kEdgeTwice, "edge that is listed twice; keep one row");
    static_assert(kFault != Fault::kGraphWithoutInitial,
                  "entity with a graph but no initial checkpoint; make the first one kInitial");
    static_assert(kFault != Fault::kCheckpointUnreachable,
                  "checkpoint that no sequence of edges from an initial one leads to; add an edge");
    static_assert(kFault != Fault::kCheckpointIsDeadEnd,
                  "checkpoint behind which nothing is legal; make it kFinal or add an edge");
    static_assert(
        kFault != Fault::kDeadlineBypassed,
        "deadline that a legal sequence breaks: its finish can come without its start, or its start "
        "twice without its finish; move the deadline or change the edges");
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_SUPERVISION_FAULT_HPP

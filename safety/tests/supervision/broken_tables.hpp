// SPDX-License-Identifier: Apache-2.0
/// @file
/// A sound table, and one for each fault that a table can have, in which one row of the sound one is spoiled.
/// Judged at run time by supervision_check_test.cpp, and by the compiler for supervision_compile_test.cpp.
#ifndef MAMORI_SAFETY_TESTS_SUPERVISION_BROKEN_TABLES_HPP
#define MAMORI_SAFETY_TESTS_SUPERVISION_BROKEN_TABLES_HPP

#include <array>

#include "mamori/safety/supervision/supervision_check.hpp"

namespace mamori::safety::broken {

enum class Entity : EntityIndex { kControl, kMonitor, kUnknown };
enum class Point : CheckpointIndex { kRead, kCompute, kWrite, kScan, kUnknown };
enum class Mode : std::uint8_t { kIdle, kWork, kBeyond };

constexpr CheckpointRole kInitial = CheckpointRole::kInitial;
constexpr CheckpointRole kInner = CheckpointRole::kInner;
constexpr CheckpointRole kFinal = CheckpointRole::kFinal;
constexpr DeadlineLimits kLimits{Duration{10}, Duration{100}};
constexpr AliveCount kOnce{1U, 0U, 0U, 1U};

constexpr std::array kEntities{supervise(Entity::kControl),
                               supervise(Entity::kMonitor, in_modes(Mode::kWork), 2U)};
constexpr std::array kCheckpoints{
    checkpoint(Point::kRead, Entity::kControl, kInitial),
    checkpoint(Point::kCompute, Entity::kControl, kInner),
    checkpoint(Point::kWrite, Entity::kControl, kFinal),
    checkpoint(Point::kScan, Entity::kMonitor),
};
constexpr std::array kAlives{alive(Point::kRead, kOnce), alive(Point::kScan, {10U, 1U, 1U, 10U})};
constexpr std::array kDeadlines{deadline(Point::kRead, Point::kWrite, kLimits)};
constexpr std::array kEdges{edge(Point::kRead, Point::kCompute), edge(Point::kCompute, Point::kWrite)};

constexpr SupervisionTable kSound{kEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 2U};

// Entities and modes.
constexpr SupervisionTable kTableEmpty{{}, kCheckpoints, kAlives, kDeadlines, kEdges, 2U};
constexpr SupervisionTable kNoMode{kEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 0U};
constexpr SupervisionTable kTooManyModes{kEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 33U};
constexpr std::array kTwiceEntities{supervise(Entity::kControl), supervise(Entity::kControl)};
constexpr SupervisionTable kEntityTwice{kTwiceEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 2U};
constexpr std::array kSwappedEntities{supervise(Entity::kMonitor), supervise(Entity::kControl)};
constexpr SupervisionTable kEntityOutOfOrder{kSwappedEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 2U};
constexpr std::array kRestingEntities{supervise(Entity::kControl),
                                      supervise(Entity::kMonitor, in_modes(Mode::kBeyond))};
constexpr SupervisionTable kEntityInNoMode{kRestingEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 2U};
constexpr std::array kBareEntities{supervise(Entity::kControl), supervise(Entity::kMonitor),
                                   supervise(Entity::kUnknown)};
constexpr SupervisionTable kEntityUnsupervised{kBareEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 2U};
constexpr std::array kWorkEntities{supervise(Entity::kControl, in_modes(Mode::kWork)),
                                   supervise(Entity::kMonitor, in_modes(Mode::kWork))};
constexpr SupervisionTable kModeUnsupervised{kWorkEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 2U};

// Checkpoints.
constexpr std::array kTwiceCheckpoints{kCheckpoints[0], kCheckpoints[1], kCheckpoints[2], kCheckpoints[0]};
constexpr SupervisionTable kCheckpointTwice{kEntities, kTwiceCheckpoints, kAlives, kDeadlines, kEdges, 2U};
constexpr std::array kSwappedCheckpoints{kCheckpoints[0], kCheckpoints[2], kCheckpoints[1], kCheckpoints[3]};
constexpr SupervisionTable kCheckpointOutOfOrder{kEntities, kSwappedCheckpoints, kAlives, kDeadlines, kEdges,
                                                 2U};
constexpr std::array kOrphanCheckpoints{kCheckpoints[0], kCheckpoints[1], kCheckpoints[2],
                                        checkpoint(Point::kScan, Entity::kUnknown)};
constexpr SupervisionTable kCheckpointOfUnknownEntity{
    kEntities, kOrphanCheckpoints, kAlives, kDeadlines, kEdges, 2U};
constexpr std::array kIdleCheckpoints{kCheckpoints[0], kCheckpoints[1], kCheckpoints[2], kCheckpoints[3],
                                      checkpoint(Point::kUnknown, Entity::kMonitor)};
constexpr SupervisionTable kCheckpointUnused{kEntities, kIdleCheckpoints, kAlives, kDeadlines, kEdges, 2U};

// Alive.
constexpr std::array kUnknownAlives{alive(Point::kScan, kOnce), alive(Point::kUnknown, kOnce)};
constexpr SupervisionTable kAliveOfUnknown{kEntities, kCheckpoints, kUnknownAlives, kDeadlines, kEdges, 2U};
constexpr std::array kTwiceAlives{alive(Point::kScan, kOnce), alive(Point::kScan, {2U, 0U, 0U, 2U})};
constexpr SupervisionTable kAliveTwice{kEntities, kCheckpoints, kTwiceAlives, kDeadlines, kEdges, 2U};
constexpr std::array kNothingAlives{alive(Point::kScan, {0U, 0U, 1U, 1U})};
constexpr SupervisionTable kAliveNothing{kEntities, kCheckpoints, kNothingAlives, kDeadlines, kEdges, 2U};
constexpr std::array kNeverAlives{alive(Point::kScan, {1U, 0U, 0U, 0U})};
constexpr SupervisionTable kAliveInNoTime{kEntities, kCheckpoints, kNeverAlives, kDeadlines, kEdges, 2U};
constexpr std::array kMarginAlives{alive(Point::kRead, kOnce), alive(Point::kScan, {3U, 3U, 0U, 4U})};
constexpr SupervisionTable kAliveMargin{kEntities, kCheckpoints, kMarginAlives, kDeadlines, kEdges, 2U};
constexpr std::array kFloodAlives{alive(Point::kScan, {60U, 0U, 1U, 2U})};
constexpr SupervisionTable kAliveBeyondQueue{kEntities, kCheckpoints, kFloodAlives, kDeadlines, kEdges, 2U};

// Deadlines.
constexpr std::array kUnknownStarts{deadline(Point::kUnknown, Point::kWrite, kLimits)};
constexpr SupervisionTable kDeadlineFromUnknown{kEntities, kCheckpoints, kAlives, kUnknownStarts, kEdges, 2U};
constexpr std::array kUnknownFinishes{kDeadlines[0], deadline(Point::kRead, Point::kUnknown, kLimits)};
constexpr SupervisionTable kDeadlineToUnknown{kEntities, kCheckpoints, kAlives, kUnknownFinishes, kEdges, 2U};
constexpr std::array kSelfDeadlines{deadline(Point::kRead, Point::kRead, kLimits)};
constexpr SupervisionTable kDeadlineToItself{kEntities, kCheckpoints, kAlives, kSelfDeadlines, kEdges, 2U};
constexpr std::array kForeignDeadlines{deadline(Point::kRead, Point::kScan, kLimits)};
constexpr SupervisionTable kDeadlineBetween{kEntities, kCheckpoints, kAlives, kForeignDeadlines, kEdges, 2U};
constexpr std::array kWrongLimits{deadline(Point::kRead, Point::kWrite, {Duration{101}, Duration{100}})};
constexpr SupervisionTable kDeadlineLimits{kEntities, kCheckpoints, kAlives, kWrongLimits, kEdges, 2U};
constexpr std::array kTwiceDeadlines{kDeadlines[0], kDeadlines[0]};
constexpr SupervisionTable kDeadlineTwice{kEntities, kCheckpoints, kAlives, kTwiceDeadlines, kEdges, 2U};

// Edges.
constexpr std::array kEdgesFromUnknown{edge(Point::kUnknown, Point::kWrite)};
constexpr SupervisionTable kEdgeFromUnknown{kEntities,  kCheckpoints,      kAlives,
                                            kDeadlines, kEdgesFromUnknown, 2U};
constexpr std::array kEdgesToUnknown{kEdges[0], edge(Point::kRead, Point::kUnknown)};
constexpr SupervisionTable kEdgeToUnknown{kEntities, kCheckpoints, kAlives, kDeadlines, kEdgesToUnknown, 2U};
constexpr std::array kEdgesToUnordered{kEdges[0], kEdges[1], edge(Point::kRead, Point::kScan)};
constexpr SupervisionTable kEdgeToUnordered{kEntities,  kCheckpoints,      kAlives,
                                            kDeadlines, kEdgesToUnordered, 2U};
constexpr std::array kEdgesFromUnordered{edge(Point::kScan, Point::kRead)};
constexpr SupervisionTable kEdgeFromUnordered{kEntities,  kCheckpoints,        kAlives,
                                              kDeadlines, kEdgesFromUnordered, 2U};
constexpr std::array kOrderedCheckpoints{kCheckpoints[0], kCheckpoints[1], kCheckpoints[2],
                                         checkpoint(Point::kScan, Entity::kMonitor, kInitial)};
constexpr SupervisionTable kEdgeBetween{kEntities,  kOrderedCheckpoints, kAlives,
                                        kDeadlines, kEdgesToUnordered,   2U};
constexpr std::array kEdgesBack{kEdges[0], kEdges[1], edge(Point::kWrite, Point::kRead)};
constexpr SupervisionTable kEdgeLeavesFinal{kEntities, kCheckpoints, kAlives, kDeadlines, kEdgesBack, 2U};
constexpr std::array kTwiceEdges{kEdges[0], kEdges[1], kEdges[1]};
constexpr SupervisionTable kEdgeTwice{kEntities, kCheckpoints, kAlives, kDeadlines, kTwiceEdges, 2U};

// Graphs.
constexpr std::array kHeadlessCheckpoints{checkpoint(Point::kRead, Entity::kControl, kInner), kCheckpoints[1],
                                          kCheckpoints[2], kCheckpoints[3]};
constexpr SupervisionTable kGraphWithoutInitial{kEntities, kHeadlessCheckpoints, kAlives, kDeadlines, kEdges,
                                                2U};
constexpr std::array kTwoEnds{kCheckpoints[0], checkpoint(Point::kCompute, Entity::kControl, kFinal),
                              kCheckpoints[2], kCheckpoints[3]};
constexpr std::array kFirstEdge{kEdges[0]};
constexpr SupervisionTable kUnreachable{kEntities, kTwoEnds, kAlives, {}, kFirstEdge, 2U};
constexpr std::array kShortEdges{kEdges[0], edge(Point::kRead, Point::kWrite)};
constexpr SupervisionTable kDeadEnd{kEntities, kCheckpoints, kAlives, kDeadlines, kShortEdges, 2U};
constexpr std::array kTwoBegins{kCheckpoints[0], checkpoint(Point::kCompute, Entity::kControl, kInitial),
                                kCheckpoints[2], kCheckpoints[3]};
constexpr SupervisionTable kFinishWithoutStart{kEntities, kTwoBegins, kAlives, kDeadlines, kEdges, 2U};
constexpr SupervisionTable kStartWithoutFinish{kEntities, kTwoEnds, kAlives, kDeadlines, kShortEdges, 2U};
constexpr std::array kLoopEdges{kEdges[0], kEdges[1], edge(Point::kCompute, Point::kCompute)};
constexpr std::array kLoopDeadlines{deadline(Point::kRead, Point::kCompute, kLimits)};
constexpr SupervisionTable kFinishTwice{kEntities, kCheckpoints, kAlives, kLoopDeadlines, kLoopEdges, 2U};

}  // namespace mamori::safety::broken

#endif  // MAMORI_SAFETY_TESTS_SUPERVISION_BROKEN_TABLES_HPP

// SPDX-License-Identifier: Apache-2.0
// Goal: each fault of a table is found, in the row that is guilty. Method: a sound table with one row spoiled
// at a time, both sides of each limit. That the compiler refuses these tables: supervision_compile_test.cpp.
#include "mamori/safety/supervision/supervision_check.hpp"

#include <array>
#include <limits>

#include "broken_tables.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using broken::Entity;
using broken::Point;
using namespace verification;
using Fault = SupervisionFault;

constexpr std::size_t kCheckpointMax = 8U;

/// As a test wants it, so that it prints what it found.
void expect(const SupervisionTable& table, Fault fault, std::size_t row = 0U, std::size_t other = 0U) {
    const SupervisionFinding finding = find_fault<kCheckpointMax>(table);
    EXPECT_EQ(static_cast<int>(finding.fault), static_cast<int>(fault));
    EXPECT_EQ(finding.row, row);
    EXPECT_EQ(finding.other, other);
}

void expect_alive(AliveCount count, Fault fault) {
    const std::array alives{broken::kAlives[0], alive(Point::kScan, count)};
    SupervisionTable table = broken::kSound;
    table.alives = alives;
    expect(table, fault, fault == Fault::kNone ? 0U : 1U);
}

void expect_limits(std::int64_t shortest_ns, std::int64_t longest_ns, Fault fault) {
    const std::array deadlines{
        deadline(Point::kRead, Point::kWrite, {Duration{shortest_ns}, Duration{longest_ns}})};
    SupervisionTable table = broken::kSound;
    table.deadlines = deadlines;
    expect(table, fault);
}

TEST(SupervisionCheckTest, SoundTableHasNoFault) {
    verifies("SWR-SUP-033");

    expect(broken::kSound, Fault::kNone);
    EXPECT_TRUE(is_sound<broken::kSound>());
}

TEST(SupervisionCheckTest, TableThatNobodyWroteIsOfOneModeAndEmpty) {
    verifies("SWR-SUP-033", Technique::kInterface, Polarity::kViolation);
    const SupervisionTable table{};

    EXPECT_EQ(table.mode_count, 1U);
    EXPECT_EQ(table.expired_cycles_tolerated, 0U);
    EXPECT_EQ(kNoCheckpoint, std::numeric_limits<CheckpointIndex>::max());
    EXPECT_EQ(kNoEntity, std::numeric_limits<EntityIndex>::max());
    expect(table, Fault::kTableEmpty);
}

TEST(SupervisionCheckTest, RowsOfEntitiesAreFound) {
    verifies("SWR-SUP-033", Technique::kErrorGuessing, Polarity::kViolation);

    expect(broken::kTableEmpty, Fault::kTableEmpty);
    expect(broken::kEntityTwice, Fault::kEntityTwice, 1U, 0U);
    expect(broken::kEntityOutOfOrder, Fault::kEntityOutOfOrder, 0U);
    expect(broken::kEntityInNoMode, Fault::kEntityInNoMode, 1U);
    expect(broken::kEntityUnsupervised, Fault::kEntityUnsupervised, 2U);
    expect(broken::kModeUnsupervised, Fault::kModeUnsupervised, 0U);
}

TEST(SupervisionCheckTest, NumberOfModesIsOneToThirtyTwo) {
    verifies("SWR-SUP-033", Technique::kBoundaryValues, Polarity::kViolation);
    SupervisionTable table = broken::kSound;
    const std::array entities{supervise(Entity::kControl), supervise(Entity::kMonitor)};
    table.entities = entities;

    expect(broken::kNoMode, Fault::kModeCount);
    expect(broken::kTooManyModes, Fault::kModeCount);
    table.mode_count = 1U;
    expect(table, Fault::kNone);
    table.mode_count = 32U;
    expect(table, Fault::kNone);
}

TEST(SupervisionCheckTest, RowsOfCheckpointsAreFound) {
    verifies("SWR-SUP-033", Technique::kErrorGuessing, Polarity::kViolation);

    expect(broken::kCheckpointTwice, Fault::kCheckpointTwice, 3U, 0U);
    expect(broken::kCheckpointOutOfOrder, Fault::kCheckpointOutOfOrder, 1U);
    expect(broken::kCheckpointOfUnknownEntity, Fault::kCheckpointOfUnknownEntity, 3U);
    expect(broken::kCheckpointUnused, Fault::kCheckpointUnused, 4U);
}

TEST(SupervisionCheckTest, UnorderedCheckpointOfADeadlineIsUsed) {
    verifies("SWR-SUP-033", Technique::kEquivalenceClasses);
    const std::array checkpoints{broken::kCheckpoints[0], broken::kCheckpoints[1], broken::kCheckpoints[2],
                                 broken::kCheckpoints[3], checkpoint(Point::kUnknown, Entity::kMonitor)};
    const std::array to{deadline(Point::kScan, Point::kUnknown, broken::kLimits)};
    const std::array from{deadline(Point::kUnknown, Point::kScan, broken::kLimits)};
    SupervisionTable table = broken::kSound;
    table.checkpoints = checkpoints;

    table.deadlines = to;
    expect(table, Fault::kNone);
    table.deadlines = from;
    expect(table, Fault::kNone);
}

TEST(SupervisionCheckTest, RowsThatNameNoCheckpointAreFound) {
    verifies("SWR-SUP-033", Technique::kErrorGuessing, Polarity::kViolation);

    expect(broken::kAliveOfUnknown, Fault::kAliveOfUnknownCheckpoint, 1U);
    expect(broken::kDeadlineFromUnknown, Fault::kDeadlineOfUnknownCheckpoint, 0U);
    expect(broken::kDeadlineToUnknown, Fault::kDeadlineOfUnknownCheckpoint, 1U);
    expect(broken::kEdgeFromUnknown, Fault::kEdgeOfUnknownCheckpoint, 0U);
    expect(broken::kEdgeToUnknown, Fault::kEdgeOfUnknownCheckpoint, 1U);
}

TEST(SupervisionCheckTest, RowsThatAreListedTwiceAreFound) {
    verifies("SWR-SUP-033", Technique::kErrorGuessing, Polarity::kViolation);

    expect(broken::kAliveTwice, Fault::kAliveTwice, 1U, 0U);
    expect(broken::kDeadlineTwice, Fault::kDeadlineTwice, 1U, 0U);
    expect(broken::kEdgeTwice, Fault::kEdgeTwice, 2U, 1U);
}

TEST(SupervisionCheckTest, SeveralRowsOfOneCheckpointAreTaken) {
    verifies("SWR-SUP-033", Technique::kEquivalenceClasses);
    const std::array deadlines{deadline(Point::kRead, Point::kCompute, broken::kLimits),
                               deadline(Point::kRead, Point::kWrite, broken::kLimits),
                               deadline(Point::kCompute, Point::kWrite, broken::kLimits)};
    SupervisionTable table = broken::kSound;
    table.deadlines = deadlines;

    expect(table, Fault::kNone);
}

TEST(SupervisionCheckTest, RowsThatJoinTwoEntitiesAreFound) {
    verifies("SWR-SUP-033", Technique::kErrorGuessing, Polarity::kViolation);

    expect(broken::kDeadlineToItself, Fault::kDeadlineToItself, 0U);
    expect(broken::kDeadlineBetween, Fault::kDeadlineBetweenEntities, 0U);
    expect(broken::kEdgeBetween, Fault::kEdgeBetweenEntities, 2U);
}

/// Parameters, so that the rows are not made by the compiler.
void expect_rows(Entity entity, broken::Mode mode) {
    const EntityRow supervised = supervise(entity, in_modes(broken::Mode::kBeyond, mode), 7U);
    EXPECT_EQ(supervised.entity, 1U);
    EXPECT_EQ(supervised.modes, 6U);
    EXPECT_EQ(supervised.failed_reference_cycles, 7U);
    EXPECT_EQ(supervise(entity).modes, kEveryMode);
    EXPECT_EQ(supervise(entity).failed_reference_cycles, 0U);
    const CheckpointRow passed = checkpoint(Point::kScan, entity, CheckpointRole::kFinal);
    EXPECT_EQ(passed.checkpoint, 3U);
    EXPECT_EQ(passed.entity, 1U);
    EXPECT_EQ(passed.role, CheckpointRole::kFinal);
    EXPECT_EQ(checkpoint(Point::kScan, entity).role, CheckpointRole::kUnordered);
}

TEST(SupervisionCheckTest, RowsAreWhatWasWritten) {
    verifies("SWR-SUP-033", Technique::kInterface);

    expect_rows(Entity::kMonitor, broken::Mode::kWork);
}

TEST(SupervisionCheckTest, EnumeratorBeyondSixteenBitsIsNoRow) {
    verifies("SWR-SUP-033", Technique::kBoundaryValues, Polarity::kViolation);
    enum class Wide : std::uint32_t { kLast = 0xFFFEU, kNone = 0xFFFFU, kBeyond = 0x10000U };

    EXPECT_EQ(alive(Wide::kLast, broken::kOnce).checkpoint, 0xFFFEU);
    EXPECT_EQ(alive(Wide::kNone, broken::kOnce).checkpoint, kNoCheckpoint);
    EXPECT_EQ(alive(Wide::kBeyond, broken::kOnce).checkpoint, kNoCheckpoint) << "not checkpoint 0";
}

TEST(SupervisionCheckTest, LimitsInsideTheirRangeAreTaken) {
    verifies("SWR-SUP-034", Technique::kBoundaryValues);

    expect_alive({1U, 0U, 0U, 1U}, Fault::kNone);
    expect_alive({2U, 1U, 0U, 1U}, Fault::kNone);
    expect_alive({29U, 0U, 1U, 1U}, Fault::kNone);
    expect_alive({60U, 0U, 0U, 2U}, Fault::kNone);
    expect_alive({0xFFFFU, 0xFFFEU, 0xFFFFU, 0xFFFFU}, Fault::kNone);
    expect_limits(0, 1, Fault::kNone);
    expect_limits(100, 100, Fault::kNone);
}

TEST(SupervisionCheckTest, LimitsOfAliveOutsideTheirRangeAreFound) {
    verifies("SWR-SUP-034", Technique::kBoundaryValues, Polarity::kViolation);

    expect(broken::kAliveNothing, Fault::kAliveNothingExpected);
    expect(broken::kAliveInNoTime, Fault::kAliveNothingExpected);
    expect(broken::kAliveMargin, Fault::kAliveMargin, 1U);
    expect(broken::kAliveBeyondQueue, Fault::kAliveBeyondQueue);
    expect_alive({1U, 1U, 0U, 1U}, Fault::kAliveMargin);
    expect_alive({1U, 2U, 0U, 1U}, Fault::kAliveMargin);
    expect_alive({30U, 0U, 1U, 1U}, Fault::kAliveBeyondQueue);
    expect_alive({0xFFFFU, 0U, 0xFFFFU, 1U}, Fault::kAliveBeyondQueue);
}

TEST(SupervisionCheckTest, LimitsOfDeadlinesOutsideTheirRangeAreFound) {
    verifies("SWR-SUP-034", Technique::kBoundaryValues, Polarity::kViolation);

    expect(broken::kDeadlineLimits, Fault::kDeadlineLimits);
    expect_limits(-1, 1, Fault::kDeadlineLimits);
    expect_limits(0, 0, Fault::kDeadlineLimits);
    expect_limits(2, 1, Fault::kDeadlineLimits);
}

TEST(SupervisionCheckTest, GraphsWithAllKindsOfCheckpointsAreTaken) {
    verifies("SWR-SUP-035", Technique::kEquivalenceClasses);
    // Read either alone, or begin with Compute, turn it any number of times, and end with Write.
    const std::array checkpoints{checkpoint(Point::kRead, Entity::kControl, CheckpointRole::kInitialAndFinal),
                                 checkpoint(Point::kCompute, Entity::kControl, CheckpointRole::kInitial),
                                 broken::kCheckpoints[2], broken::kCheckpoints[3]};
    const std::array edges{edge(Point::kCompute, Point::kCompute), edge(Point::kCompute, Point::kWrite)};
    SupervisionTable table = broken::kSound;
    table.checkpoints = checkpoints;
    table.deadlines = {};
    table.edges = edges;

    expect(table, Fault::kNone);
}

TEST(SupervisionCheckTest, RingWithoutAnEndIsTaken) {
    verifies("SWR-SUP-035", Technique::kEquivalenceClasses);
    const std::array checkpoints{broken::kCheckpoints[0], broken::kCheckpoints[1],
                                 checkpoint(Point::kWrite, Entity::kControl, CheckpointRole::kInner),
                                 broken::kCheckpoints[3]};
    const std::array edges{broken::kEdges[0], broken::kEdges[1], edge(Point::kWrite, Point::kRead)};
    SupervisionTable table = broken::kSound;
    table.checkpoints = checkpoints;
    table.edges = edges;

    expect(table, Fault::kNone);
}

TEST(SupervisionCheckTest, GraphAgainstTheOrderOfTheNumbersIsTaken) {
    verifies("SWR-SUP-035", Technique::kEquivalenceClasses);
    const std::array checkpoints{
        checkpoint(Point::kRead, Entity::kControl, CheckpointRole::kFinal), broken::kCheckpoints[1],
        checkpoint(Point::kWrite, Entity::kControl, CheckpointRole::kInitial), broken::kCheckpoints[3]};
    const std::array edges{edge(Point::kWrite, Point::kCompute), edge(Point::kCompute, Point::kRead)};
    const std::array deadlines{deadline(Point::kWrite, Point::kRead, broken::kLimits)};
    SupervisionTable table = broken::kSound;
    table.checkpoints = checkpoints;
    table.deadlines = deadlines;
    table.edges = edges;

    expect(table, Fault::kNone);
}

TEST(SupervisionCheckTest, DeadlineWhoseFinishIsTheBeginOfARingIsFound) {
    verifies("SWR-SUP-035", Technique::kErrorGuessing, Polarity::kViolation);
    const std::array checkpoints{
        checkpoint(Point::kRead, Entity::kControl, CheckpointRole::kInner), broken::kCheckpoints[1],
        checkpoint(Point::kWrite, Entity::kControl, CheckpointRole::kInitial), broken::kCheckpoints[3]};
    const std::array edges{broken::kEdges[0], broken::kEdges[1], edge(Point::kWrite, Point::kRead)};
    SupervisionTable table = broken::kSound;
    table.checkpoints = checkpoints;
    table.edges = edges;

    expect(table, Fault::kDeadlineBypassed);
}

TEST(SupervisionCheckTest, DeadlineWithAnUnorderedEndIsNotForTheGraph) {
    verifies("SWR-SUP-035", Technique::kEquivalenceClasses);
    const std::array checkpoints{broken::kCheckpoints[0], broken::kCheckpoints[1], broken::kCheckpoints[2],
                                 broken::kCheckpoints[3], checkpoint(Point::kUnknown, Entity::kControl)};
    const std::array deadlines{deadline(Point::kUnknown, Point::kRead, broken::kLimits),
                               deadline(Point::kRead, Point::kUnknown, broken::kLimits)};
    SupervisionTable table = broken::kSound;
    table.checkpoints = checkpoints;
    table.deadlines = deadlines;

    expect(table, Fault::kNone);
}

TEST(SupervisionCheckTest, EdgesWithoutMeaningAreFound) {
    verifies("SWR-SUP-035", Technique::kErrorGuessing, Polarity::kViolation);

    expect(broken::kEdgeToUnordered, Fault::kEdgeOfUnorderedCheckpoint, 2U);
    expect(broken::kEdgeFromUnordered, Fault::kEdgeOfUnorderedCheckpoint, 0U);
    expect(broken::kEdgeLeavesFinal, Fault::kEdgeLeavesFinal, 2U);
}

TEST(SupervisionCheckTest, GraphsThatNoRunCanPassAreFound) {
    verifies("SWR-SUP-035", Technique::kErrorGuessing, Polarity::kViolation);

    expect(broken::kGraphWithoutInitial, Fault::kGraphWithoutInitial, 0U);
    expect(broken::kUnreachable, Fault::kCheckpointUnreachable, 2U);
    expect(broken::kDeadEnd, Fault::kCheckpointIsDeadEnd, 1U);
}

TEST(SupervisionCheckTest, DeadlinesThatALegalSequenceBreaksAreFound) {
    verifies("SWR-SUP-035", Technique::kErrorGuessing, Polarity::kViolation);

    expect(broken::kFinishWithoutStart, Fault::kDeadlineBypassed);
    expect(broken::kStartWithoutFinish, Fault::kDeadlineBypassed);
    expect(broken::kFinishTwice, Fault::kDeadlineBypassed);
}

TEST(SupervisionCheckTest, MoreCheckpointsThanThereIsRoomForGoToTheAssertionHandler) {
    verifies("SWR-SUP-035", Technique::kInterface, Polarity::kViolation);
    const std::array<CheckpointRow, kCheckpointMax + 1U> checkpoints{};
    SupervisionTable table = broken::kSound;
    table.checkpoints = checkpoints;

    EXPECT_CHECK_FAILS(static_cast<void>(find_fault<kCheckpointMax>(table)), "supervision_check.hpp", 1);
}

}  // namespace
}  // namespace mamori::safety

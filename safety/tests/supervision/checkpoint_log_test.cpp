// SPDX-License-Identifier: Apache-2.0
// Goal: reports come over from another context whole and in order, and one that is lost or wrong is found.
// Method: a queue filled to both sides of its capacity, wrong numbers, and a thread that reports while
// another supervises.
#include "mamori/safety/supervision/checkpoint_log.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <thread>

#include "mamori/verification/failed_check.hpp"
#include "supervision_rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using Violation = CheckpointViolation;

enum class Entity : EntityIndex { kLeft, kRight };
enum class Point : CheckpointIndex { kBegin, kInside, kEnd, kOther, kBeyond };

constexpr std::array kEntities{supervise(Entity::kLeft), supervise(Entity::kRight, in_modes(Entity::kRight))};
constexpr std::array kCheckpoints{
    checkpoint(Point::kBegin, Entity::kLeft, CheckpointRole::kInitial),
    checkpoint(Point::kInside, Entity::kLeft, CheckpointRole::kInner),
    checkpoint(Point::kEnd, Entity::kLeft, CheckpointRole::kFinal),
    checkpoint(Point::kOther, Entity::kRight, CheckpointRole::kInitialAndFinal),
};
constexpr std::array kEdges{edge(Point::kBegin, Point::kInside), edge(Point::kInside, Point::kEnd)};
constexpr SupervisionTable kTable{kEntities, kCheckpoints, {}, {}, kEdges, 2U, 100U};
using Rig = SupervisionRig<kTable>;

TEST(CheckpointLogTest, FullQueueIsTakenWhole) {
    verifies("SWR-SUP-031", Technique::kBoundaryValues);
    Rig rig;

    for (int cycle = 0; cycle < 10; ++cycle) {
        for (std::size_t i = 0U; i < kPendingCheckpointsMax; i += 3U) {
            rig.report_as(Entity::kLeft, Point::kBegin, cycle);
            rig.report_as(Entity::kLeft, Point::kInside, cycle);
            rig.report_as(Entity::kLeft, Point::kEnd, cycle);
        }
        ASSERT_EQ(rig.step(cycle), SupervisionStatus::kOk) << cycle;
    }
}

TEST(CheckpointLogTest, LostReportExpires) {
    verifies("SWR-SUP-031", Technique::kBoundaryValues, Polarity::kViolation);
    Rig rig;
    ASSERT_EQ(rig.sut.set_mode(1U, Instant{0}), Status::kOk);
    for (std::size_t i = 0U; i < kPendingCheckpointsMax; ++i) {
        rig.report_as(Entity::kRight, Point::kOther, 0);
    }
    rig.report_as(Entity::kRight, Point::kOther, 0);

    EXPECT_EQ(rig.step(0), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.sut.get_violation(1U), Violation::kLostReport);
    EXPECT_EQ(rig.sut.get_violation(0U), Violation::kNone) << "the other one is not to blame";
}

TEST(CheckpointLogTest, LaterLossDoesNotReplaceTheFirstViolation) {
    verifies("SWR-SUP-005", Technique::kStateTransition, Polarity::kViolation);
    Rig rig;
    rig.report_as(Entity::kLeft, Point::kEnd, 0);
    ASSERT_EQ(rig.step(0), SupervisionStatus::kExpired);
    for (std::size_t i = 0U; i < 2U * kPendingCheckpointsMax; ++i) {
        rig.report_as(Entity::kLeft, Point::kBegin, 0);
    }

    ASSERT_EQ(rig.step(-1), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kOrder) << "neither the loss nor the clock";
}

TEST(CheckpointLogTest, CountOfLostReportsThatRunsRoundIsALossToo) {
    verifies("SWR-SUP-031", Technique::kBoundaryValues, Polarity::kViolation);
    Rig rig;
    rig.storage.entities[0].lost_count = std::numeric_limits<std::uint32_t>::max();

    EXPECT_EQ(rig.step(0), SupervisionStatus::kExpired) << "one more, which makes 0";
    EXPECT_EQ(rig.get_violation(), Violation::kLostReport);
}

TEST(CheckpointLogTest, ReportsThatADeactivatedEntityLostAreNotHeldAgainstItLater) {
    verifies("SWR-SUP-031", Technique::kStateTransition);
    Rig rig;
    for (int i = 0; i < 100; ++i) {
        rig.report_as(Entity::kRight, Point::kOther, 0);
    }
    ASSERT_EQ(rig.sut.set_mode(1U, Instant{0}), Status::kOk);

    EXPECT_EQ(rig.step(0), SupervisionStatus::kOk);
}

TEST(CheckpointLogTest, CheckpointOfAnotherEntityExpires) {
    verifies("SWR-SUP-031", Technique::kErrorGuessing, Polarity::kViolation);
    Rig rig;
    rig.report_as(Entity::kLeft, Point::kOther, 0);

    EXPECT_EQ(rig.step(0), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kForeign);
}

TEST(CheckpointLogTest, CheckpointThatDoesNotExistExpires) {
    verifies("SWR-SUP-031", Technique::kBoundaryValues, Polarity::kViolation);
    Rig first;
    first.report_as(Entity::kLeft, Point::kBeyond, 0);
    EXPECT_EQ(first.step(0), SupervisionStatus::kExpired);
    EXPECT_EQ(first.get_violation(), Violation::kForeign);

    Rig last;
    last.report_as(Entity::kLeft, static_cast<Point>(0xFFFFU), 0);
    EXPECT_EQ(last.step(0), SupervisionStatus::kExpired);
    EXPECT_EQ(last.get_violation(), Violation::kForeign);
}

TEST(CheckpointLogTest, LogOfAnEntityThatDoesNotExistGoesToTheAssertionHandler) {
    verifies("SWR-SUP-031", Technique::kInterface, Polarity::kViolation);
    Rig rig;

    EXPECT_CHECK_FAILS(static_cast<void>(rig.storage.get_log(static_cast<Entity>(2))), "span.hpp", 1);
}

TEST(CheckpointLogTest, ReportsOfAThreadComeWholeAndInOrder) {
    verifies("SWR-SUP-032");
    Rig rig;
    constexpr std::int64_t kRuns = 3000;
    // Relaxed on purpose: nothing but the queue itself orders the two threads.
    std::atomic<std::uint32_t> cycles{0U};
    std::atomic<bool> is_over{false};

    std::thread entity{[&rig, &cycles, &is_over] {
        std::uint32_t seen = 0U;
        for (std::int64_t run = 0; run < kRuns; ++run) {
            rig.report_as(Entity::kLeft, Point::kBegin, run);
            rig.report_as(Entity::kLeft, Point::kInside, run);
            rig.report_as(Entity::kLeft, Point::kEnd, run);
            // Two further cycles: one of them has begun and ended since, so the queue is empty but for this
            // run.
            while (run % 4 == 3 && cycles.load(std::memory_order_relaxed) - seen < 2U) {
                std::this_thread::yield();
            }
            seen = cycles.load(std::memory_order_relaxed);
        }
        is_over.store(true, std::memory_order_relaxed);
    }};
    constexpr std::int64_t kLate = std::numeric_limits<std::int64_t>::max();
    while (!is_over.load(std::memory_order_relaxed)) {
        static_cast<void>(rig.step(kLate));
        cycles.fetch_add(1U, std::memory_order_relaxed);
        std::this_thread::yield();
    }
    entity.join();

    EXPECT_EQ(rig.step(kLate), SupervisionStatus::kOk) << static_cast<int>(rig.get_violation());
    EXPECT_EQ(rig.storage.entities[0].reported_at.ns, kRuns - 1);
}

}  // namespace
}  // namespace mamori::safety

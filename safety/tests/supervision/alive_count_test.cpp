// SPDX-License-Identifier: Apache-2.0
// Goal: too few, too many and badly spread reports are found, and no burst pays for a stall.
// Method: both sides of each margin, stalls inside and across reference cycles, right and wrong reference
// cycles at both sides of the tolerance.
#include <array>
#include <cstdint>
#include <initializer_list>

#include "supervision_rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

enum class Point : CheckpointIndex { kTick, kTock };

constexpr std::array kEntities{supervise(Only::kEntity)};
constexpr std::array kTolerantEntities{supervise(Only::kEntity, kEveryMode, 2U)};
constexpr std::array kCheckpoints{checkpoint(Point::kTick, Only::kEntity)};
constexpr std::array kLongAlives{alive(Point::kTick, {10U, 1U, 1U, 10U})};
constexpr SupervisionTable kLong{kEntities, kCheckpoints, kLongAlives};
constexpr std::array kExactAlives{alive(Point::kTick, {10U, 0U, 0U, 10U})};
constexpr SupervisionTable kExact{kEntities, kCheckpoints, kExactAlives};
constexpr std::array kRareAlives{alive(Point::kTick, {1U, 0U, 0U, 5U})};
constexpr SupervisionTable kRare{kEntities, kCheckpoints, kRareAlives};
constexpr std::array kEachAlives{alive(Point::kTick, {1U, 0U, 0U, 1U})};
constexpr SupervisionTable kTolerant{kTolerantEntities, kCheckpoints, kEachAlives};
constexpr SupervisionTable kTolerantLong{kTolerantEntities, kCheckpoints, kLongAlives};
constexpr std::array kTwoCheckpoints{checkpoint(Point::kTick, Only::kEntity),
                                     checkpoint(Point::kTock, Only::kEntity)};
constexpr std::array kTwoAlives{alive(Point::kTick, {1U, 0U, 0U, 1U}), alive(Point::kTock, {1U, 0U, 0U, 1U})};
constexpr SupervisionTable kTwo{kTolerantEntities, kTwoCheckpoints, kTwoAlives};

/// A supervisor that is stepped with so many reports of kTick in each cycle.
template <const auto& kTable>
class Line final {
  public:
    EntityStatus run(std::uint32_t reports) {
        for (std::uint32_t i = 0U; i < reports; ++i) {
            rig_.report(Point::kTick, now_);
        }
        static_cast<void>(rig_.step(now_));
        ++now_;
        return rig_.get_status();
    }
    /// The same in several cycles. @return status after the last.
    EntityStatus run_all(std::initializer_list<std::uint32_t> reports) {
        EntityStatus status = EntityStatus::kDeactivated;
        for (const std::uint32_t count : reports) {
            status = run(count);
        }
        return status;
    }
    SupervisionRig<kTable>& get_rig() { return rig_; }

  private:
    SupervisionRig<kTable> rig_{};
    std::int64_t now_{0};
};

TEST(AliveCountTest, SteadyReportsAreHealthy) {
    verifies("SWR-SUP-020");
    Line<kLong> line;

    for (int cycle = 0; cycle < 1000; ++cycle) {
        ASSERT_EQ(line.run(1U), EntityStatus::kOk) << cycle;
    }
}

TEST(AliveCountTest, CountsAtBothMarginsAreHealthy) {
    verifies("SWR-SUP-020", Technique::kBoundaryValues);
    Line<kLong> line;

    EXPECT_EQ(line.run_all({1U, 1U, 1U, 1U, 0U, 1U, 1U, 1U, 1U, 1U}), EntityStatus::kOk) << "9 of 10";
    EXPECT_EQ(line.run_all({1U, 1U, 1U, 1U, 1U, 2U, 1U, 1U, 1U, 1U}), EntityStatus::kOk) << "11 of 10";
    EXPECT_EQ(line.run_all({0U, 1U, 1U, 1U, 1U, 1U, 1U, 1U, 2U, 1U}), EntityStatus::kOk) << "10 of 10";
}

TEST(AliveCountTest, OneReportTooFewIsFoundAtTheEndOfTheReferenceCycle) {
    verifies("SWR-SUP-020", Technique::kBoundaryValues, Polarity::kViolation);
    Line<kLong> line;

    ASSERT_EQ(line.run_all({1U, 0U, 1U, 1U, 0U, 1U, 1U, 1U, 1U}), EntityStatus::kOk);
    EXPECT_EQ(line.run(1U), EntityStatus::kExpired) << "8 of 10";
    EXPECT_EQ(line.get_rig().get_violation(), CheckpointViolation::kAlive);
}

TEST(AliveCountTest, OneReportTooManyIsFoundAtOnce) {
    verifies("SWR-SUP-020", Technique::kBoundaryValues, Polarity::kViolation);
    Line<kLong> line;

    ASSERT_EQ(line.run(11U), EntityStatus::kOk);
    EXPECT_EQ(line.run(1U), EntityStatus::kExpired) << "12 in the second of 10 cycles";
    EXPECT_EQ(line.get_rig().get_violation(), CheckpointViolation::kAlive);
}

TEST(AliveCountTest, CountBeginsAnewInEachReferenceCycle) {
    verifies("SWR-SUP-020", Technique::kStateTransition);
    Line<kRare> line;

    for (int cycle = 0; cycle < 20; ++cycle) {
        ASSERT_EQ(line.run_all({0U, 0U, 1U, 0U, 0U}), EntityStatus::kOk);
    }
    EXPECT_EQ(line.run_all({0U, 0U, 0U, 0U, 0U}), EntityStatus::kExpired) << "an earlier one does not count";
}

TEST(AliveCountTest, ReportAtTheVeryEndOfACycleCountsForIt) {
    verifies("SWR-SUP-020", Technique::kBoundaryValues);
    SupervisionRig<kTolerant> rig;
    rig.report(Point::kTick, 100);
    rig.report(Point::kTick, 101);

    ASSERT_EQ(rig.step(100), SupervisionStatus::kOk);
    EXPECT_EQ(rig.step(200), SupervisionStatus::kOk) << "the second one is of the second cycle";
    EXPECT_EQ(rig.step(300), SupervisionStatus::kFailed);
}

TEST(AliveCountTest, LongestSilenceFollowsFromTheLeastCount) {
    verifies("SWR-SUP-021", Technique::kBoundaryValues);

    EXPECT_EQ((AliveCount{1U, 0U, 0U, 1U}.calc_silence_max()), 0U);
    EXPECT_EQ((AliveCount{10U, 0U, 0U, 10U}.calc_silence_max()), 0U);
    EXPECT_EQ((AliveCount{10U, 1U, 1U, 10U}.calc_silence_max()), 2U);
    EXPECT_EQ((AliveCount{2U, 0U, 0U, 10U}.calc_silence_max()), 8U);
    EXPECT_EQ((AliveCount{20U, 0U, 0U, 10U}.calc_silence_max()), 0U);
    EXPECT_EQ((AliveCount{1U, 0U, 0U, 0xFFFFU}.calc_silence_max()), 2U * 0xFFFEU);
}

TEST(AliveCountTest, LongestSilenceIsHealthy) {
    verifies("SWR-SUP-021", Technique::kBoundaryValues);
    Line<kLong> line;

    EXPECT_EQ(line.run_all({1U, 1U, 1U, 1U, 1U, 1U, 1U, 1U, 2U, 0U}), EntityStatus::kOk);
    EXPECT_EQ(line.run_all({0U, 2U, 1U, 1U, 1U, 1U, 1U, 1U, 1U, 1U}), EntityStatus::kOk)
        << "two silent cycles, over the end of a reference cycle";
}

TEST(AliveCountTest, LateAndEarlyReportsOfAnEvenCountAreHealthy) {
    verifies("SWR-SUP-021", Technique::kBoundaryValues);
    Line<kRare> line;

    EXPECT_EQ(line.run_all({1U, 0U, 0U, 0U, 0U}), EntityStatus::kOk);
    EXPECT_EQ(line.run_all({0U, 0U, 0U, 0U, 1U}), EntityStatus::kOk) << "8 silent cycles in between";
}

TEST(AliveCountTest, OneSilentCycleTooManyIsFoundAtOnce) {
    verifies("SWR-SUP-021", Technique::kBoundaryValues, Polarity::kViolation);
    Line<kLong> line;

    ASSERT_EQ(line.run_all({1U, 1U, 2U, 0U, 0U}), EntityStatus::kOk);
    EXPECT_EQ(line.run(0U), EntityStatus::kExpired) << "long before the end of the reference cycle";
    EXPECT_EQ(line.get_rig().get_violation(), CheckpointViolation::kAlive);
}

TEST(AliveCountTest, BurstDoesNotHideAStall) {
    verifies("SWR-SUP-021", Technique::kFaultInjection, Polarity::kViolation);
    Line<kExact> line;

    ASSERT_EQ(line.run(10U), EntityStatus::kOk) << "the whole reference cycle is paid for";
    EXPECT_EQ(line.run(0U), EntityStatus::kExpired);
}

TEST(AliveCountTest, BurstsAtTheFarEndsOfTwoReferenceCyclesDoNotHideAStall) {
    verifies("SWR-SUP-021", Technique::kFaultInjection, Polarity::kViolation);
    Line<kLong> line;

    ASSERT_EQ(line.run_all({1U, 1U, 1U, 1U, 1U, 1U, 1U, 1U, 1U, 0U}), EntityStatus::kOk);
    ASSERT_EQ(line.run(0U), EntityStatus::kOk);
    EXPECT_EQ(line.run(0U), EntityStatus::kExpired) << "silence is counted over the end";
}

constexpr std::array kShortAlives{alive(Point::kTick, {3U, 1U, 1U, 4U})};
constexpr SupervisionTable kShort{kEntities, kCheckpoints, kShortAlives};
constexpr std::size_t kShortCycles = 9U;

/// The definition, over the whole past: is anything wrong in the first `cycles` cycles?
bool is_wrong_in(const std::array<std::uint32_t, kShortCycles>& reports, std::size_t cycles) {
    bool is_wrong = false;
    std::uint32_t silent = 0U;
    for (std::size_t i = 0U; i < cycles; ++i) {
        std::uint32_t count = 0U;
        for (std::size_t j = i / 4U * 4U; j <= i; ++j) {
            count += reports[j];
        }
        silent = reports[i] == 0U ? silent + 1U : 0U;
        is_wrong = is_wrong || count > 4U || (i % 4U == 3U && count < 2U) || silent > 2U;
    }
    return is_wrong;
}

TEST(AliveCountTest, EverySequenceOfCountsIsJudgedByTheDefinition) {
    verifies("SWR-SUP-021", Technique::kBackToBack, Polarity::kViolation);

    for (std::uint32_t sequence = 0U; sequence < 19683U;
         ++sequence) {  // 3^9: 0, 1 or 2 reports in each cycle
        std::array<std::uint32_t, kShortCycles> reports{};
        std::uint32_t rest = sequence;
        for (std::uint32_t& count : reports) {
            count = rest % 3U;
            rest /= 3U;
        }
        Line<kShort> line;
        for (std::size_t i = 0U; i < kShortCycles; ++i) {
            const EntityStatus status = line.run(reports[i]);
            ASSERT_EQ(status == EntityStatus::kExpired, is_wrong_in(reports, i + 1U)) << sequence << ' ' << i;
        }
    }
}

TEST(AliveCountTest, StallInsideTheToleranceCountsOnceInEachReferenceCycle) {
    verifies("SWR-SUP-021", Technique::kStateTransition, Polarity::kViolation);
    Line<kTolerantLong> line;

    ASSERT_EQ(line.run_all({0U, 0U}), EntityStatus::kOk);
    for (int cycle = 2; cycle < 20; ++cycle) {
        ASSERT_EQ(line.run(0U), EntityStatus::kFailed) << cycle;
    }
    EXPECT_EQ(line.run(0U), EntityStatus::kExpired) << "the third reference cycle is wrong from its begin on";
}

TEST(AliveCountTest, WrongCyclesUpToTheToleranceFailAndTheNextOneExpires) {
    verifies("SWR-SUP-026", Technique::kBoundaryValues, Polarity::kViolation);
    Line<kTolerant> line;

    ASSERT_EQ(line.run(1U), EntityStatus::kOk);
    EXPECT_EQ(line.run(0U), EntityStatus::kFailed);
    EXPECT_EQ(line.run(2U), EntityStatus::kFailed);
    EXPECT_EQ(line.run(0U), EntityStatus::kExpired);
    for (int cycle = 0; cycle < 10; ++cycle) {
        ASSERT_EQ(line.run(1U), EntityStatus::kExpired) << "for good";
    }
}

TEST(AliveCountTest, EachRightCycleTakesOneWrongBack) {
    verifies("SWR-SUP-026", Technique::kStateTransition);
    Line<kTolerant> line;

    ASSERT_EQ(line.run_all({0U, 0U}), EntityStatus::kFailed);
    EXPECT_EQ(line.run(1U), EntityStatus::kFailed);
    EXPECT_EQ(line.run(1U), EntityStatus::kOk);
    EXPECT_EQ(line.run(1U), EntityStatus::kOk) << "right cycles are not saved up";
    ASSERT_EQ(line.run_all({0U, 0U}), EntityStatus::kFailed);
    EXPECT_EQ(line.run(0U), EntityStatus::kExpired);
}

TEST(AliveCountTest, NoToleranceExpiresAtOnce) {
    verifies("SWR-SUP-026", Technique::kBoundaryValues, Polarity::kViolation);
    Line<kRare> line;

    ASSERT_EQ(line.run_all({0U, 0U, 0U, 0U}), EntityStatus::kOk);
    EXPECT_EQ(line.run(0U), EntityStatus::kExpired);
}

TEST(AliveCountTest, RightCheckpointDoesNotHealAWrongOne) {
    verifies("SWR-SUP-026", Technique::kFaultInjection, Polarity::kViolation);
    SupervisionRig<kTwo> rig;

    for (std::int64_t cycle = 0; cycle < 3; ++cycle) {
        rig.report(Point::kTick, cycle);
        static_cast<void>(rig.step(cycle));
        ASSERT_EQ(rig.get_status(), cycle < 2 ? EntityStatus::kFailed : EntityStatus::kExpired) << cycle;
    }
}

}  // namespace
}  // namespace mamori::safety

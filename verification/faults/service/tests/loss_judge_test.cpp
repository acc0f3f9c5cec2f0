// SPDX-License-Identifier: Apache-2.0
// Goal: the judgement about lost services can fail, in each of its ways. Method: trials made by hand, of a
// watchdog with 5 ms; instants in microseconds.
#include "loss_judge.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace mamori::lost_service {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

constexpr Instant at(std::int64_t us) noexcept {
    return Instant{us * 1000};
}
/// Served last at 10,000 us, lost at 10,900, so the time is over at 15,000.
LossTrial make(Loss loss, std::int64_t closed_us) {
    return {loss, true, at(10900), at(10000), at(10000), closed_us != 0, at(closed_us), {}, at(20000)};
}
LossVerdict judge(const LossTrial& trial, const std::vector<Stall>& stalls = {}) {
    return judge_losses({trial}, stalls, Duration{5'000'000});
}

TEST(LossJudgeTest, ClosedWithinATickAfterTheTimeIsWellAndLaterIsLateUnlessTheMachineStoodStill) {
    verifies("SWR-PRT-022", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_TRUE(judge(make(Loss::kHang, 16000)).is_well());
    EXPECT_EQ(judge(make(Loss::kHang, 16000)).reaction_ns, (std::vector<std::int64_t>{1'000'000}));
    const LossVerdict late = judge(make(Loss::kHang, 16001), {{at(14000), at(14999)}});
    EXPECT_EQ(late.late, 1U);
    EXPECT_EQ(late.unexplained.size(), 1U);
    EXPECT_FALSE(late.is_well());
    EXPECT_EQ(judge(make(Loss::kHang, 16001), {{at(14000), at(15000)}}).suspected, 1U) << "it took no time";
    EXPECT_FALSE(judge(make(Loss::kHang, 16001), {{at(14000), at(15000)}}).is_well());
    EXPECT_EQ(judge(make(Loss::kHang, 16300), {{at(15100), at(15399)}}).suspected, 1U);
    const LossVerdict excused = judge(make(Loss::kHang, 16300), {{at(15100), at(15400)}});
    EXPECT_EQ(excused.late_by_host, 1U);
    EXPECT_TRUE(excused.unexplained.empty());
    EXPECT_TRUE(excused.is_well());
}

TEST(LossJudgeTest, ClosedBeforeTheTimeIsOverIsEarlyAndNeverClosedIsUnanswered) {
    verifies("SWR-PRT-022", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(judge(make(Loss::kUnhealthy, 15000)).early, 1U);
    EXPECT_FALSE(judge(make(Loss::kUnhealthy, 15000)).is_well());
    EXPECT_EQ(judge(make(Loss::kWait, 0)).unanswered, 1U);
    EXPECT_FALSE(judge(make(Loss::kWait, 0)).is_well());
}

TEST(LossJudgeTest, TheTimeBeginsAnywhereWithinTheServiceThatWasTaken) {
    verifies("SWR-PRT-022", Technique::kBoundaryValues, Polarity::kViolation);
    const auto judge_held_up = [](std::int64_t closed_us) {
        LossTrial trial = make(Loss::kHang, closed_us);
        trial.taken_at = at(10400);
        return judge(trial);
    };
    EXPECT_EQ(judge_held_up(15000).early, 1U);
    EXPECT_TRUE(judge_held_up(15001).is_well());
    EXPECT_EQ(judge_held_up(15001).reaction_ns, (std::vector<std::int64_t>{0}));
    EXPECT_TRUE(judge_held_up(16400).is_well());
    EXPECT_EQ(judge_held_up(16401).late, 1U);
}

TEST(LossJudgeTest, ATrialThatEndedBeforeAnAnswerWasDueIsTheMachines) {
    verifies("SWR-PRT-022", Technique::kBoundaryValues, Polarity::kViolation);
    LossTrial trial = make(Loss::kWait, 0);
    trial.ended_at = at(16000);
    EXPECT_EQ(judge(trial).by_host, 1U);
    EXPECT_EQ(judge(trial).injected, 0U);
    EXPECT_FALSE(judge(trial).is_well()) << "nothing was shown";
    trial.ended_at = at(16001);
    EXPECT_EQ(judge(trial).unanswered, 1U);
    EXPECT_EQ(judge(trial).unexplained.size(), 1U);
}

TEST(LossJudgeTest, RunawayIsToBeAnsweredAtOnce) {
    verifies("SWR-PRT-022", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_TRUE(judge(make(Loss::kRunaway, 11900)).is_well());
    EXPECT_EQ(judge(make(Loss::kRunaway, 11901)).late, 1U);
}

TEST(LossJudgeTest, ClosedWithoutALossIsInventedUnlessTheMachineStoodStill) {
    verifies("SWR-PRT-022", Technique::kFaultInjection, Polarity::kViolation);
    const LossTrial clean{Loss::kNone, false, {}, at(10000), at(10000), true, at(15010), {}};
    EXPECT_EQ(judge(clean).invented, 1U);
    EXPECT_EQ(judge(clean).unexplained.size(), 1U);
    EXPECT_FALSE(judge(clean).is_well());
    EXPECT_EQ(judge(clean, {{at(15011), at(15100)}}).invented, 1U);
    EXPECT_EQ(judge(clean, {{at(9000), at(9999)}}).invented, 1U);
    EXPECT_EQ(judge(clean, {{at(12000), at(12500)}}).by_host, 1U);
    EXPECT_EQ(judge(clean, {{at(12000), at(12499)}}).suspected, 1U) << "too short for a service to be missed";
    LossTrial before = make(Loss::kHang, 10899);
    EXPECT_EQ(judge(before).invented, 1U) << "the loss came after it";
    EXPECT_EQ(judge(before).injected, 0U);
}

TEST(LossJudgeTest, ServedToTheEndIsWellAndARunWithoutLossesThatTookEffectIsNot) {
    verifies("SWR-PRT-022", Technique::kEquivalenceClasses);
    EXPECT_TRUE(judge({Loss::kNone, false, {}, at(10000), at(10000), false, {}, {}}).is_well());
    EXPECT_FALSE(judge({Loss::kHang, false, {}, at(10000), at(10000), false, {}, {}}).is_well());
}

}  // namespace
}  // namespace mamori::lost_service

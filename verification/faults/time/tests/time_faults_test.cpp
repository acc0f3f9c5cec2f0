// SPDX-License-Identifier: Apache-2.0
// Goal: whatever takes too long, comes too late or shows the wrong time is reported in time and under its
// name, by the guard or by the watch, and nothing else is. Method: one short run by the clock with faults at
// random places, beside a process that faults pages and a reader that is kept from running at random;
// `assess_run()` decides from the evidence. The long run is the program `time_faults`.
#include "time_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/real_time_result.hpp"

namespace mamori::time_faults {
namespace {

using verification::assess_run;
using verification::Polarity;
using verification::report_run;
using verification::Technique;
using verification::verifies;

constexpr Request kRequest{4000U, 50U, 20261122U, true};
/// All tests look at one run.
class TimeFaultsRunTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        verdict_ = run(kRequest);
        facts_ = to_json(kRequest, verdict_);
    }
    void SetUp() override {
        RecordProperty("seed", static_cast<int>(kRequest.seed));
        ASSERT_EQ(verdict_.frames, kRequest.frame_count);
        if (!verdict_.has_priority) {
            GTEST_SKIP() << "verdict=no-privilege: no fixed priority: any thread of the machine may hold up "
                            "what tells of stalls, or "
                            "the windows";
        }
    }
    static Verdict verdict_;
    static std::string facts_;
};
Verdict TimeFaultsRunTest::verdict_;
std::string TimeFaultsRunTest::facts_;

TEST_F(TimeFaultsRunTest, EachFaultIsReportedInATickUnderItsNameAndNoneIsInvented) {
    verifies("SWR-PRT-007", Technique::kFaultInjection, Polarity::kViolation);
    report_run(assess_run(verdict_.get_report_evidence()), facts_);
}

TEST_F(TimeFaultsRunTest, EachHangOfTheRunnerAndEachWrongClockIsFoundInItsBoundAndNoneIsInvented) {
    verifies("SWR-PRT-034", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_GT(verdict_.watch.holds_seen, 0U) << facts_;
    EXPECT_GT(verdict_.watch.clock_faults_seen, 0U) << facts_;
    report_run(assess_run(verdict_.get_watch_evidence()), facts_);
}

TEST_F(TimeFaultsRunTest, AComponentThatWaitsForAThreadWithoutPriorityIsCutAndNamed) {
    verifies("SWR-PRT-035", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_GT(verdict_.locked_out, 0U) << facts_;
    EXPECT_EQ(verdict_.locked_out_seen, verdict_.locked_out) << facts_;
}

TEST_F(TimeFaultsRunTest, AReaderThatIsStoppedInTheMiddleOfARequestHoldsUpNoWindow) {
    verifies("SWR-PRT-036", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_GT(verdict_.requests, 0U);
    EXPECT_GT(verdict_.reads_under_way, 0U) << "it was stopped there, since it runs on the same processor";
    report_run(assess_run(verdict_.get_report_evidence()), facts_);
}

TEST_F(TimeFaultsRunTest, AProcessThatFaultsPagesCausesNoneInTheWindows) {
    verifies("SWR-PRT-037", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_TRUE(verdict_.has_storm) << "it must blow until the end";
    if (!verdict_.has_locked_memory) {
        GTEST_SKIP() << "verdict=no-privilege: the machine does not let this process lock its memory";
    }
    EXPECT_TRUE(verdict_.are_pages_well()) << facts_;
}

TEST(TimeFaultsTest, ARequestAlwaysGivesTheSameFaultsInsideItsLimits) {
    verifies("SWR-PRT-034", Technique::kBoundaryValues);
    const std::vector<Injection> first = make_injections({100'000U, 1'000U, 7U});
    const std::vector<Injection> second = make_injections({100'000U, 1'000U, 7U});
    const std::vector<Injection> other = make_injections({100'000U, 1'000U, 8U});
    const auto is_same = [](const Injection& a, const Injection& b) {
        return a.frame == b.frame && a.kind == b.kind && a.place == b.place && a.size == b.size &&
               a.ppm == b.ppm;
    };
    std::array<std::size_t, kKindCount> kinds{};

    EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin(), second.end(), is_same));
    EXPECT_FALSE(std::equal(first.begin(), first.end(), other.begin(), other.end(), is_same));
    for (std::size_t i = 0U; i < first.size(); ++i) {
        const bool is_clock = first[i].ppm != 0;
        ++kinds[static_cast<std::size_t>(first[i].kind)];
        EXPECT_GE(first[i].size.ns, kTick.ns * 11 / 10);
        EXPECT_LE(first[i].size.ns, is_clock ? kTick.ns * 25 : kTick.ns * 4);
        EXPECT_EQ(is_clock, first[i].kind == Kind::kFastClock || first[i].kind == Kind::kSlowClock);
        EXPECT_LT(first[i].frame, 100'000U);
        EXPECT_TRUE(i == 0U || first[i].frame >= first[i - 1U].frame + kDistance);
    }
    EXPECT_GT(*std::min_element(kinds.begin(), kinds.end()), 0U) << "each kind takes part";
    EXPECT_TRUE(make_injections({1U, 0U, 1U}).empty());
}

}  // namespace
}  // namespace mamori::time_faults

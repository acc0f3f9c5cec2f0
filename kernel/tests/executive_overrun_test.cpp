// SPDX-License-Identifier: Apache-2.0
// Goal: a window whose budget is used up publishes nothing, its guilty component is named, and the others
// run. Method: a fake host that cuts work off in either pass, on both sides of the budget. Work that goes on
// after it was cut off: executive_abandon_test.cpp.
#include <gtest/gtest.h>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Heard = std::vector<std::string>;
using Values = std::vector<std::int64_t>;
using Pass = WindowHost::Pass;

/// Counter and relay in window 0 with a budget of 300 ns of 400 ns; a second counter and a sink in window 1.
class ExecutiveOverrunTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        ASSERT_EQ(sut_.start(), Status::kOk);
        sut_.set_observer(&observer_);
    }
    WindowOutcome run(std::size_t window, std::int64_t frame) {
        const Instant release{frame * 1000 + table_.windows[window].offset.ns};
        host_.now = release;
        return sut_.run_window(window, release, host_);
    }

    Counter counter_;
    Relay relay_;
    Counter other_{"other"};
    Sink sink_;
    SystemTable<2U, 4U, 5U, 2U> table_ =
        system(frame(1000_ns), trace_hash(),
               window("first", 0_ns, 400_ns, budget(300_ns), mamori::run(counter_, relay_)),
               window("second", 400_ns, 600_ns, budget(500_ns), mamori::run(other_, sink_)),
               connect(counter_.out, relay_.in, any_age()), connect(relay_.out, sink_.in, any_age()));
    FakeHost host_;
    SpyObserver observer_;
    ExecutiveFor<decltype(table_)> sut_{table_};
};

TEST_F(ExecutiveOverrunTest, AWindowThatUsesItsWholeBudgetCompletes) {
    verifies("SWR-KRN-022", Technique::kBoundaryValues);
    host_.durations[{0U, Pass::kExecute}] = 100_ns;
    host_.durations[{1U, Pass::kExecute}] = 150_ns;
    host_.durations[{1U, Pass::kStateUpdate}] = 50_ns;

    EXPECT_EQ(run(0U, 0), WindowOutcome::kCompleted);

    EXPECT_EQ(host_.now, Instant{300});
    EXPECT_EQ(relay_.out.get_published(), 11);
}

TEST_F(ExecutiveOverrunTest, OneNanosecondMorePublishesNothingAndNamesTheComponent) {
    verifies("SWR-KRN-022", Technique::kBoundaryValues, Polarity::kViolation);
    host_.durations[{0U, Pass::kExecute}] = 100_ns;
    host_.durations[{1U, Pass::kExecute}] = 201_ns;

    EXPECT_EQ(run(0U, 0), WindowOutcome::kOverrun);

    EXPECT_EQ(counter_.out.get_sequence(), 0U) << "not even the one that was in time";
    EXPECT_EQ(relay_.out.get_sequence(), 0U);
    EXPECT_EQ(sut_.get_trace_hash(), TraceHash{}.get_value());
    EXPECT_EQ(observer_.heard, (Heard{"overrun window 0 component 1 @300"}));
    EXPECT_EQ(observer_.take_seen(2U), (std::vector<std::uint32_t>{ExecutionRecord::kWithin, 0U}));
}

TEST_F(ExecutiveOverrunTest, AHangInTheFirstComponentKeepsTheRestOfItsWindowFromRunning) {
    verifies("SWR-KRN-022", Technique::kFaultInjection, Polarity::kViolation);
    host_.hangs[{0U, Pass::kExecute}] = true;

    EXPECT_EQ(run(0U, 0), WindowOutcome::kOverrun);

    EXPECT_EQ(observer_.heard, (Heard{"overrun window 0 component 0 @300"}));
    EXPECT_EQ(observer_.take_seen(2U), (std::vector<std::uint32_t>{0U, 0U}));
    EXPECT_FALSE(relay_.out.is_staged());
}

TEST_F(ExecutiveOverrunTest, TheSecondPassIsUnderTheBudgetToo) {
    verifies("SWR-KRN-022", Technique::kFaultInjection, Polarity::kViolation);
    host_.hangs[{0U, Pass::kStateUpdate}] = true;

    EXPECT_EQ(run(0U, 0), WindowOutcome::kOverrun);

    EXPECT_EQ(observer_.heard.back(), "overrun window 0 component 0 @300");
    EXPECT_EQ(relay_.out.get_sequence(), 0U);
}

TEST_F(ExecutiveOverrunTest, AnOverrunDoesNotStopTheOtherWindowsWhichSeeTheLastPublication) {
    verifies("SWR-KRN-022", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(run(0U, 0), WindowOutcome::kCompleted);
    ASSERT_EQ(run(1U, 0), WindowOutcome::kCompleted);
    host_.hangs[{1U, Pass::kExecute}] = true;

    EXPECT_EQ(run(0U, 1), WindowOutcome::kOverrun);
    EXPECT_EQ(run(1U, 1), WindowOutcome::kCompleted);

    EXPECT_EQ(sink_.get_values(), (Values{11, 11}));
    EXPECT_FALSE(sink_.notes[1].is_new);
    EXPECT_EQ(sink_.notes[1].age, 1000_ns);
    EXPECT_EQ(other_.out.get_sequence(), 2U);
}

TEST_F(ExecutiveOverrunTest, AWindowThatOpensAfterItsCloseRunsNothingAndBlamesNobody) {
    verifies("SWR-KRN-034", Technique::kBoundaryValues, Polarity::kViolation);
    host_.now = Instant{401};
    EXPECT_EQ(sut_.run_window(0U, Instant{0}, host_), WindowOutcome::kMissed);
    EXPECT_FALSE(counter_.out.is_staged());
    EXPECT_EQ(observer_.heard, (Heard{"late window 0 by 401 @401"}));
    EXPECT_TRUE(host_.deadlines.empty());

    host_.now = Instant{1400};  // nothing is left of its budget, which is another matter
    host_.durations[{0U, Pass::kExecute}] = 1_ns;
    EXPECT_EQ(sut_.run_window(0U, Instant{1000}, host_), WindowOutcome::kOverrun);
    EXPECT_EQ(observer_.heard.back(), "overrun window 0 component 0 @1400");
    host_.durations.clear();
    EXPECT_EQ(run(0U, 2), WindowOutcome::kCompleted) << "the next opening is on time";
}

TEST_F(ExecutiveOverrunTest, AfterAnOverrunTheNextCycleIsComplete) {
    verifies("SWR-KRN-022", Technique::kFaultInjection);
    host_.durations[{0U, Pass::kExecute}] = 301_ns;
    ASSERT_EQ(run(0U, 0), WindowOutcome::kOverrun);
    host_.durations.clear();

    EXPECT_EQ(run(0U, 1), WindowOutcome::kCompleted);

    EXPECT_EQ(counter_.out.get_sequence(), 1U);
    EXPECT_EQ(counter_.out.get_published(), 20) << "the late run counted on, its output did not leave";
}

TEST_F(ExecutiveOverrunTest, WhatAnOverrunWindowWroteDoesNotLeaveInALaterCycleEither) {
    verifies("SWR-KRN-022", Technique::kErrorGuessing, Polarity::kViolation);
    host_.durations[{1U, Pass::kExecute}] = 301_ns;
    ASSERT_EQ(run(0U, 0), WindowOutcome::kOverrun);
    EXPECT_FALSE(counter_.out.is_staged());
    host_.durations.clear();
    counter_.is_writing = false;

    ASSERT_EQ(run(0U, 1), WindowOutcome::kCompleted);

    EXPECT_EQ(counter_.out.get_sequence(), 0U);
}

TEST_F(ExecutiveOverrunTest, ALateReleaseKeepsTheBudgetButNotBeyondTheClose) {
    verifies("SWR-KRN-022", Technique::kBoundaryValues, Polarity::kViolation);
    const auto release_at = [this](std::int64_t lateness) {
        host_.now = Instant{lateness};
        host_.deadlines.clear();
        EXPECT_EQ(sut_.run_window(0U, Instant{0}, host_), WindowOutcome::kCompleted);
        return host_.deadlines.front();
    };

    EXPECT_EQ(release_at(0), Instant{300});
    EXPECT_EQ(release_at(99), Instant{399});
    EXPECT_EQ(release_at(100), Instant{400});
    EXPECT_EQ(release_at(101), Instant{400});
}

TEST_F(ExecutiveOverrunTest, AnInputIsNewAgainForAComponentThatHadNoCycle) {
    verifies("SWR-KRN-016", Technique::kFaultInjection);
    ASSERT_EQ(run(0U, 0), WindowOutcome::kCompleted);
    host_.hangs[{2U, Pass::kExecute}] = true;  // the counter before the sink
    ASSERT_EQ(run(1U, 0), WindowOutcome::kOverrun);
    host_.hangs.clear();

    ASSERT_EQ(run(1U, 1), WindowOutcome::kCompleted);

    ASSERT_EQ(sink_.notes.size(), 1U);
    EXPECT_TRUE(sink_.notes[0].is_new);
}

TEST_F(ExecutiveOverrunTest, AnInputIsNewAgainForTheComponentThatWasCutOff) {
    verifies("SWR-KRN-016", Technique::kFaultInjection);
    ASSERT_EQ(run(0U, 0), WindowOutcome::kCompleted);
    host_.durations[{3U, Pass::kExecute}] = 501_ns;
    ASSERT_EQ(run(1U, 0), WindowOutcome::kOverrun);
    host_.durations.clear();

    ASSERT_EQ(run(1U, 1), WindowOutcome::kCompleted);
    ASSERT_EQ(run(1U, 2), WindowOutcome::kCompleted);

    ASSERT_EQ(sink_.notes.size(), 3U);
    EXPECT_TRUE(sink_.notes[1].is_new) << "its late run did not count as a cycle";
    EXPECT_FALSE(sink_.notes[2].is_new);
}

}  // namespace
}  // namespace mamori

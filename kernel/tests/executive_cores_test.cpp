// SPDX-License-Identifier: Apache-2.0
// Goal: two cores exchange values by their planned instants, late or not; windows of several rates run as
// often as they say. Method: two executives of one table, run by hand in orders that a real machine may show.
#include <gtest/gtest.h>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Values = std::vector<std::int64_t>;

/// The counter writes from 0 to 400 ns on core 0, the sink reads at 400 ns on core 1.
class ExecutiveCoresTest : public ::testing::Test {
  protected:
    void SetUp() override {
        for (Executive* core : {static_cast<Executive*>(&writer_), static_cast<Executive*>(&reader_)}) {
            ASSERT_EQ(core->initialize(), Status::kOk);
        }
        for (Executive* core : {static_cast<Executive*>(&writer_), static_cast<Executive*>(&reader_)}) {
            ASSERT_EQ(core->start(), Status::kOk);
        }
    }
    void write(std::int64_t frame, std::int64_t late = 0) {
        host_.now = Instant{frame * 1000 + late};
        ASSERT_EQ(writer_.run_window(0U, Instant{frame * 1000}, host_), WindowOutcome::kCompleted);
    }
    void read(std::int64_t frame, std::int64_t late = 0) {
        host_.now = Instant{frame * 1000 + 400 + late};
        ASSERT_EQ(reader_.run_window(1U, Instant{frame * 1000 + 400}, host_), WindowOutcome::kCompleted);
    }

    Counter counter_;
    Sink sink_;
    Crossing<std::int64_t> crossing_;
    SystemTable<2U, 2U, 2U, 1U> table_ =
        system(frame(1000_ns), window("write", 0_ns, 400_ns, budget(300_ns), run(counter_)),
               window("read", 400_ns, 600_ns, core(1), budget(100_ns), run(sink_)),
               connect(counter_.out, sink_.in, through(crossing_), fresh_within(500_ns)));
    FakeHost host_;
    ExecutiveFor<decltype(table_)> writer_{table_};
    ExecutiveFor<decltype(table_)> reader_{table_, 1U};
};

TEST_F(ExecutiveCoresTest, AValueArrivesAtTheFirstOpeningThatIsNotBeforeItsPublication) {
    verifies("SWR-KRN-026");
    write(0);
    read(0);
    write(1);
    read(1);

    EXPECT_EQ(sink_.get_values(), (Values{10, 20}));
    EXPECT_TRUE(sink_.notes[1].is_new);
    EXPECT_EQ(sink_.notes[1].age, 0_ns) << "published at the close, 400 ns, and read there";
}

TEST_F(ExecutiveCoresTest, AnIntrospectionOfARunningCoreShowsItsNumberAndTheTimeOfAStep) {
    verifies("SWR-INS-001", Technique::kInterface);
    SpyObserver observer;
    reader_.set_observer(&observer);
    host_.durations[{1U, FakeHost::Pass::kExecute}] = 40_ns;
    read(0);
    IntrospectionFor<decltype(table_)> introspection{table_};
    const Introspection& shown = introspection;
    reader_.set_introspection(&introspection);
    read(1);
    WindowSnapshot window{};
    ComponentSnapshot component{};

    ASSERT_EQ(shown.read_window(1U, window), Status::kOk);
    ASSERT_EQ(shown.read_component(1U, component), Status::kOk);
    EXPECT_EQ(window.core, 1U);
    EXPECT_EQ(component.worst_used, 40_ns);
    reader_.set_introspection(nullptr);
    reader_.set_observer(nullptr);
}

TEST_F(ExecutiveCoresTest, ALateReaderReceivesTheValueOfItsPlannedWindowStart) {
    verifies("SWR-KRN-052", Technique::kBoundaryValues);
    write(0);
    read(0);
    write(1);
    write(2);
    read(1, 600);  // the reader of frame 1 starts in frame 2, after its writer
    read(2);
    read(3);

    EXPECT_EQ(sink_.get_values(), (Values{10, 20, 30, 30}));
    EXPECT_TRUE(sink_.notes[1].is_new);
    EXPECT_FALSE(sink_.notes[3].is_new);
    EXPECT_EQ(sink_.in.get_missed_count(), 0U);
}

TEST_F(ExecutiveCoresTest, AWindowOfAnotherCoreEndsInTheAssertion) {
    verifies("SWR-KRN-024", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_CHECK_FAILS(static_cast<void>(writer_.run_window(1U, host_)), "executive.cpp", 6);
    EXPECT_CHECK_FAILS(static_cast<void>(reader_.run_window(0U, host_)), "executive.cpp", 6);
}

TEST_F(ExecutiveCoresTest, AnEarlierRunLeavesNothingToMiss) {
    verifies("SWR-KRN-026", Technique::kStateTransition);
    write(0);
    read(0);
    write(1);
    write(2);
    for (Executive* core : {static_cast<Executive*>(&writer_), static_cast<Executive*>(&reader_)}) {
        ASSERT_EQ(core->stop(), Status::kOk);
        ASSERT_EQ(core->start(), Status::kOk);
    }

    write(0);
    write(1);
    read(0, 600);
    EXPECT_EQ(sink_.get_values(), (Values{10, 40})) << "30 is of the earlier run";
    EXPECT_EQ(sink_.in.get_missed_count(), 0U);
}

TEST_F(ExecutiveCoresTest, ASilentWriterMakesItsValueStaleAtTheReader) {
    verifies("SWR-KRN-016", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(sink_.in.calc_status(Instant{0}), PortStatus::kBufferEmpty);
    write(0);
    read(0);
    read(1);

    EXPECT_EQ(sink_.in.calc_status(Instant{400 + 500}), PortStatus::kOk);
    EXPECT_EQ(sink_.in.calc_status(Instant{400 + 501}), PortStatus::kBufferTimeout);
}

TEST_F(ExecutiveCoresTest, EachExecutiveStartsStopsAndFinalizesItsOwnCoreOnly) {
    verifies("SWR-KRN-024", Technique::kStateTransition);
    EXPECT_EQ(writer_.get_core(), 0U);
    EXPECT_EQ(reader_.get_core(), 1U);
    EXPECT_EQ(writer_.stop(), Status::kOk);
    EXPECT_EQ(writer_.finalize(), Status::kOk);

    EXPECT_FALSE(counter_.is_alive());
    EXPECT_TRUE(sink_.is_alive());
    EXPECT_TRUE(reader_.get_context(1U).is_running());
    read(0);
    EXPECT_EQ(reader_.stop(), Status::kOk);
    EXPECT_EQ(reader_.finalize(), Status::kOk);
}

TEST_F(ExecutiveCoresTest, ACoreWithoutAnInitialisedExecutiveKeepsTheOtherFromStarting) {
    verifies("SWR-KRN-049", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(writer_.stop(), Status::kOk);
    ASSERT_EQ(reader_.stop(), Status::kOk);
    ASSERT_EQ(reader_.finalize(), Status::kOk);

    EXPECT_EQ(writer_.start(), Status::kPreconditionNotMet);
    EXPECT_EQ(writer_.get_failed_component(), 1U) << "sink, on core 1";
    EXPECT_FALSE(writer_.get_context(0U).is_running());

    ASSERT_EQ(reader_.initialize(), Status::kOk);
    EXPECT_EQ(writer_.start(), Status::kOk) << "an initialised executive need not be started";
    EXPECT_EQ(writer_.get_failed_component(), kNoIndex);
    ASSERT_EQ(reader_.start(), Status::kOk);
    EXPECT_EQ(writer_.stop(), Status::kOk);
    EXPECT_EQ(reader_.stop(), Status::kOk);
}

/// The counter writes each 1000 ns on core 0; the sink reads each 4000 ns on core 1, at 400 ns or later.
class ExecutiveSlowReaderTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(writer_.initialize(), Status::kOk);
        ASSERT_EQ(reader_.initialize(), Status::kOk);
        ASSERT_EQ(writer_.start(), Status::kOk);
        ASSERT_EQ(reader_.start(), Status::kOk);
    }
    void write(std::int64_t first, std::int64_t last) {
        for (std::int64_t period = first; period <= last; ++period) {
            host_.now = Instant{period * 1000};
            ASSERT_EQ(writer_.run_window(0U, host_.now, host_), WindowOutcome::kCompleted);
        }
    }
    void read(std::int64_t frame, std::int64_t late = 0) {
        const Instant release{frame * 4000 + 400};
        host_.now = release + Duration{late};
        ASSERT_EQ(reader_.run_window(1U, release, host_), WindowOutcome::kCompleted);
    }

    Counter counter_;
    Sink sink_;
    Crossing<std::int64_t> crossing_;
    SystemTable<2U, 2U, 2U, 1U> table_ =
        system(frame(4000_ns), window("write", 0_ns, 400_ns, every(1000_ns), budget(300_ns), run(counter_)),
               window("read", 400_ns, 3600_ns, core(1), budget(100_ns), run(sink_)),
               connect(counter_.out, sink_.in, through(crossing_), any_age()));
    FakeHost host_;
    ExecutiveFor<decltype(table_)> writer_{table_};
    ExecutiveFor<decltype(table_)> reader_{table_, 1U};
};

TEST_F(ExecutiveSlowReaderTest, AReaderThatIsLateByTwoPeriodsKeepsItsValueAndCountsIt) {
    verifies("SWR-KRN-052", Technique::kBoundaryValues, Polarity::kViolation);
    write(0, 0);
    read(0);
    write(1, 5);
    read(1, 1999);
    EXPECT_EQ(sink_.get_values(), (Values{10, 50})) << "late by less than two periods";
    EXPECT_EQ(sink_.in.get_missed_count(), 0U);

    write(6, 10);
    read(2, 2000);
    EXPECT_EQ(sink_.get_values(), (Values{10, 50, 60})) << "90 was overwritten; 60 had arrived before";
    EXPECT_EQ(sink_.in.get_missed_count(), 1U);

    write(11, 12);
    read(3);
    EXPECT_EQ(sink_.get_values(), (Values{10, 50, 60, 130}));
    EXPECT_EQ(sink_.in.get_missed_count(), 1U);
}

TEST_F(ExecutiveSlowReaderTest, AFirstValueThatIsOverwrittenBeforeTheFirstReadIsCounted) {
    verifies("SWR-KRN-052", Technique::kErrorGuessing, Polarity::kViolation);
    write(0, 2);
    read(0, 2000);
    write(3, 4);
    read(1);

    EXPECT_EQ(sink_.get_values(), (Values{0, 50}));
    EXPECT_EQ(sink_.in.get_missed_count(), 1U);
}

TEST(ExecutiveStartTest, WhatWasWrittenOnTheWayToTheLastStopIsNotPublishedByTheNextRun) {
    verifies("SWR-KRN-015", Technique::kErrorGuessing, Polarity::kViolation);
    Counter counter;
    const auto table = system(frame(1000_ns), window("w", 0_ns, 400_ns, budget(300_ns), run(counter)));
    ExecutiveFor sut{table};
    FakeHost host;
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    counter.out.write(666);  // as on_deactivated would
    ASSERT_EQ(sut.stop(), Status::kOk);
    counter.is_writing = false;

    ASSERT_EQ(sut.start(), Status::kOk);
    ASSERT_EQ(sut.run_window(0U, host), WindowOutcome::kCompleted);

    EXPECT_EQ(counter.out.get_sequence(), 0U);
}

}  // namespace
}  // namespace mamori

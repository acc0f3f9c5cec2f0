// SPDX-License-Identifier: Apache-2.0
// Goal: windows move data at their boundaries only, as the plan says and not as the clock says.
// Method: counters, relays and sinks in one or two windows under a fake host. Overruns:
// executive_overrun_test.
#include "mamori/kernel/run/executive.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Values = std::vector<std::int64_t>;
using Seen = std::vector<std::uint32_t>;

constexpr Duration kFrame{1000};
constexpr std::uint32_t kWithin = ExecutionRecord::kWithin;
constexpr std::uint32_t kOutside = ExecutionRecord::kOutside;

/// Runs every window of frame `frame` on time.
void run_frame(Executive& executive, FakeHost& host, std::int64_t frame) {
    const SystemView& view = executive.get_view();
    for (std::size_t w = 0U; w < view.windows.size(); ++w) {
        host.now = Instant{} + view.frame * frame + view.windows[w].offset;
        EXPECT_EQ(executive.run_window(w, host.now, host), WindowOutcome::kCompleted);
    }
}

/// Two windows: counter and relay in the first, a sink in the second.
class ExecutiveTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        ASSERT_EQ(sut_.start(), Status::kOk);
    }

    Counter counter_;
    Relay relay_;
    Sink sink_;
    SystemTable<2U, 3U, 4U, 2U> table_ = system(
        frame(kFrame), trace_hash(), window("first", 0_ns, 400_ns, budget(300_ns), run(counter_, relay_)),
        window("second", 400_ns, 600_ns, budget(600_ns), run(sink_)),
        connect(counter_.out, relay_.in, any_age()), connect(relay_.out, sink_.in, any_age()));
    FakeHost host_;
    ExecutiveFor<decltype(table_)> sut_{table_};
};

TEST_F(ExecutiveTest, OutputsAreSeenByALaterWindowWithTheInstantOfTheirClose) {
    verifies("SWR-KRN-021");

    run_frame(sut_, host_, 0);
    run_frame(sut_, host_, 1);

    EXPECT_EQ(sink_.get_values(), (Values{11, 21}));
    EXPECT_EQ(sink_.notes[1].now, Instant{1400});
    EXPECT_EQ(sink_.notes[1].age, 0_ns) << "published at 1400, the close of the first window";
    EXPECT_TRUE(sink_.notes[1].is_new);
}

TEST_F(ExecutiveTest, DataAndHashDoNotDependOnHowLongTheCodeTook) {
    verifies("SWR-KRN-021", Technique::kEquivalenceClasses);
    std::vector<std::uint64_t> hashes;
    std::vector<Values> values;

    for (const std::int64_t slow : {0, 1, 149, 150}) {
        Counter counter;
        Relay relay;
        Sink sink;
        const auto table = system(
            frame(kFrame), trace_hash(), window("first", 0_ns, 400_ns, budget(300_ns), run(counter, relay)),
            window("second", 400_ns, 600_ns, budget(600_ns), run(sink)),
            connect(counter.out, relay.in, any_age()), connect(relay.out, sink.in, any_age()));
        ExecutiveFor executive{table};
        FakeHost host;
        host.durations[{0U, WindowHost::Pass::kExecute}] = Duration{slow};
        host.durations[{1U, WindowHost::Pass::kExecute}] = Duration{slow};
        ASSERT_EQ(executive.initialize(), Status::kOk);
        ASSERT_EQ(executive.start(), Status::kOk);
        for (std::int64_t frame = 0; frame < 20; ++frame) {
            run_frame(executive, host, frame);
        }
        hashes.push_back(executive.get_trace_hash());
        values.push_back(sink.get_values());
    }

    for (std::size_t i = 1U; i < hashes.size(); ++i) {
        EXPECT_EQ(hashes[i], hashes[0]);
        EXPECT_EQ(values[i], values[0]);
    }
}

TEST_F(ExecutiveTest, TheHashTellsADifferentValueApart) {
    verifies("SWR-KRN-021", Technique::kErrorGuessing);
    run_frame(sut_, host_, 0);
    const std::uint64_t after_one = sut_.get_trace_hash();
    run_frame(sut_, host_, 1);
    const std::uint64_t after_two = sut_.get_trace_hash();

    counter_.is_writing = false;
    relay_.in.mark_read();
    run_frame(sut_, host_, 2);

    EXPECT_NE(after_one, TraceHash{}.get_value());
    EXPECT_NE(after_two, after_one);
    EXPECT_NE(sut_.get_trace_hash(), after_two) << "the relay still publishes";
}

TEST_F(ExecutiveTest, TheHashIsThatOfEachPublishedPortAndWhatItPublished) {
    verifies("SWR-KRN-050", Technique::kBackToBack);
    run_frame(sut_, host_, 0);

    TraceHash expected;
    for (std::size_t p = 0U; p < table_.ports.size(); ++p) {
        if (table_.ports[p].output != nullptr && table_.ports[p].output->get_sequence() != 0U) {
            expected(static_cast<std::uint64_t>(p));
            table_.ports[p].hash_published(*table_.ports[p].output, expected);
        }
    }
    EXPECT_EQ(sut_.get_trace_hash(), expected.get_value());
}

TEST_F(ExecutiveTest, APortThatPublishesNothingIsNotHashedAgain) {
    verifies("SWR-KRN-050", Technique::kBoundaryValues);
    Counter counter;
    const auto table =
        system(frame(kFrame), trace_hash(), window("w", 0_ns, 400_ns, budget(300_ns), run(counter)));
    ExecutiveFor executive{table};
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);
    run_frame(executive, host_, 0);
    const std::uint64_t after_one = executive.get_trace_hash();

    counter.is_writing = false;
    run_frame(executive, host_, 1);

    EXPECT_NE(after_one, TraceHash{}.get_value());
    EXPECT_EQ(executive.get_trace_hash(), after_one);
}

TEST_F(ExecutiveTest, AnInputDoesNotReferToATableAfterItsExecutiveIsFinalized) {
    verifies("SWR-KRN-016", Technique::kErrorGuessing);
    Counter counter;
    Sink sink;
    const auto run_once = [&](const auto& table) {
        ExecutiveFor executive{table};
        ASSERT_EQ(executive.initialize(), Status::kOk);
        ASSERT_EQ(executive.start(), Status::kOk);
        run_frame(executive, host_, 0);
        EXPECT_EQ(sink.in.calc_status(Instant{} + kFrame * 9), PortStatus::kBufferTimeout);
        ASSERT_EQ(executive.stop(), Status::kOk);
        ASSERT_EQ(executive.finalize(), Status::kOk);
    };

    run_once(system(frame(kFrame), window("w", 0_ns, 400_ns, budget(300_ns), run(counter, sink)),
                    connect(counter.out, sink.in, fresh_within(kFrame))));

    ASSERT_TRUE(sink.in.has_value());
    EXPECT_EQ(sink.in.calc_status(Instant{} + kFrame * 9), PortStatus::kOk) << "no age limit";
}

TEST_F(ExecutiveTest, APortWithoutAFunctionForItIsNotHashed) {
    verifies("SWR-KRN-050", Technique::kErrorGuessing);
    Counter counter;
    auto table = system(frame(kFrame), trace_hash(), window("w", 0_ns, 400_ns, budget(300_ns), run(counter)));
    table.ports[0].hash_published = nullptr;
    ExecutiveFor executive{table};
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);

    run_frame(executive, host_, 0);

    EXPECT_NE(counter.out.get_sequence(), 0U);
    EXPECT_EQ(executive.get_trace_hash(), TraceHash{}.get_value());
}

TEST_F(ExecutiveTest, WithoutARequestNoPublicationIsHashedAndNoHashIsGiven) {
    verifies("SWR-KRN-050", Technique::kErrorGuessing, Polarity::kViolation);
    Counter counter;
    Sink sink;
    const auto table = system(frame(kFrame), window("w", 0_ns, 400_ns, budget(300_ns), run(counter, sink)),
                              connect(counter.out, sink.in, any_age()));
    ExecutiveFor executive{table};
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);

    run_frame(executive, host_, 0);

    EXPECT_EQ(sink.get_values(), (Values{10}));
    for (const PortRow& port : table.ports) {
        EXPECT_EQ(port.hash_published, nullptr);
    }
    EXPECT_CHECK_FAILS(static_cast<void>(executive.get_trace_hash()), "executive.hpp", 1);
}

TEST_F(ExecutiveTest, AValueIsNotSeenBeforeItsWindowHasClosed) {
    verifies("SWR-KRN-021", Technique::kFaultInjection, Polarity::kViolation);
    run_frame(sut_, host_, 0);

    // The first window of the next frame is left out: what it would have published must not appear.
    host_.now = Instant{1400};
    EXPECT_EQ(sut_.run_window(1U, host_), WindowOutcome::kCompleted);

    EXPECT_EQ(sink_.notes[1].value, 11);
    EXPECT_FALSE(sink_.notes[1].is_new);
    EXPECT_EQ(sink_.notes[1].age, 1000_ns);
}

TEST_F(ExecutiveTest, AWriteBetweenOpenAndCloseDoesNotChangeALatchedInput) {
    verifies("SWR-KRN-021", Technique::kFaultInjection, Polarity::kViolation);
    run_frame(sut_, host_, 0);

    relay_.out.write(999);  // as code of the first window would, late
    host_.now = Instant{1400};
    EXPECT_EQ(sut_.run_window(1U, host_), WindowOutcome::kCompleted);

    EXPECT_EQ(sink_.notes[1].value, 11);
}

TEST_F(ExecutiveTest, ALateReleaseIsReportedAndChangesNoData) {
    verifies("SWR-KRN-031", Technique::kFaultInjection, Polarity::kViolation);
    SpyObserver observer;
    sut_.set_observer(&observer);
    host_.now = Instant{7};

    EXPECT_EQ(sut_.run_window(0U, Instant{0}, host_), WindowOutcome::kCompleted);
    host_.now = Instant{403};
    EXPECT_EQ(sut_.run_window(1U, Instant{400}, host_), WindowOutcome::kCompleted);

    EXPECT_EQ(observer.heard, (std::vector<std::string>{"late window 0 by 7 @7", "late window 1 by 3 @403"}));
    EXPECT_EQ(sink_.notes[0].now, Instant{400}) << "the planned opening";
    EXPECT_EQ(sink_.notes[0].age, 0_ns) << "published at the planned close";
}

TEST_F(ExecutiveTest, AWindowOnTimeAndWithinItsBudgetIsNothingToTell) {
    verifies("SWR-KRN-031");
    SpyObserver observer;
    host_.durations[{0U, WindowHost::Pass::kExecute}] = 300_ns;
    sut_.set_observer(&observer);

    run_frame(sut_, host_, 0);

    EXPECT_TRUE(observer.heard.empty());
}

TEST_F(ExecutiveTest, EachRunIsNotedFromTheOpeningOrTheTurnBefore) {
    verifies("SWR-KRN-030", Technique::kBoundaryValues);
    SpyObserver observer;
    host_.durations[{0U, WindowHost::Pass::kExecute}] = 30_ns;
    host_.durations[{1U, WindowHost::Pass::kExecute}] = 40_ns;
    observer.records[0].set_limits(30_ns, 30_ns);
    observer.records[1].set_limits(40_ns, 40_ns);
    observer.records[2].set_limits(0_ns, 0_ns);
    sut_.set_observer(&observer);

    run_frame(sut_, host_, 0);

    EXPECT_TRUE(observer.heard.empty());
    EXPECT_EQ(observer.take_seen(4U), (Seen{kWithin, kWithin, kWithin, 0U}));
}

TEST_F(ExecutiveTest, ARunOutsideItsLimitsIsNotedAndNotHiddenByALaterOne) {
    verifies("SWR-KRN-030", Technique::kBoundaryValues, Polarity::kViolation);
    SpyObserver observer;
    host_.durations[{0U, WindowHost::Pass::kExecute}] = 30_ns;
    host_.durations[{1U, WindowHost::Pass::kExecute}] = 40_ns;
    observer.records[0].set_limits(0_ns, 29_ns);
    observer.records[1].set_limits(41_ns, 100_ns);
    sut_.set_observer(&observer);

    run_frame(sut_, host_, 0);
    host_.durations[{0U, WindowHost::Pass::kExecute}] = 29_ns;
    host_.durations[{1U, WindowHost::Pass::kExecute}] = 41_ns;
    run_frame(sut_, host_, 1);

    EXPECT_EQ(observer.take_seen(3U), (Seen{kWithin | kOutside, kWithin | kOutside, kWithin}));
}

TEST_F(ExecutiveTest, AnObserverWithTooFewRecordsIsAnOwnBug) {
    verifies("SWR-KRN-030", Technique::kInterface, Polarity::kViolation);
    class FewRecords final : public ExecutionObserver {
      public:
        explicit FewRecords(Span<ExecutionRecord> records) : ExecutionObserver(records) {}
        void on_budget_overrun(std::size_t, std::size_t, Instant) noexcept override {}
        void on_late_release(std::size_t, Duration, Instant) noexcept override {}
    };
    std::array<ExecutionRecord, 3U> records{};
    FewRecords enough{records};
    FewRecords none{{}};
    FewRecords few{Span<ExecutionRecord>{records}.subspan(0U, 2U)};

    sut_.set_observer(&enough);
    sut_.set_observer(&none);
    run_frame(sut_, host_, 0);
    EXPECT_EQ(records[0].get_seen(), 0U) << "nobody measures";
    EXPECT_CHECK_FAILS(sut_.set_observer(&few), "executive.cpp", 4);
}

TEST_F(ExecutiveTest, TheTurnOfAComponentInErrorIsNoPartOfTheNextRun) {
    verifies("SWR-KRN-030", Technique::kBoundaryValues, Polarity::kViolation);
    counter_.answer = Status::kError;
    run_frame(sut_, host_, 0);
    SpyObserver observer;
    observer.records[1].set_limits(40_ns, 40_ns);
    sut_.set_observer(&observer);
    host_.durations[{0U, WindowHost::Pass::kExecute}] = 30_ns;
    host_.durations[{1U, WindowHost::Pass::kExecute}] = 40_ns;

    run_frame(sut_, host_, 1);

    EXPECT_EQ(observer.take_seen(2U), (Seen{0U, kWithin}));
}

TEST_F(ExecutiveTest, AComponentInErrorOrInactiveGivesNoSignOfLife) {
    verifies("SWR-KRN-030", Technique::kFaultInjection, Polarity::kViolation);
    SpyObserver observer;
    counter_.answer = Status::kError;
    run_frame(sut_, host_, 0);
    ASSERT_EQ(sut_.get_context(1U).deactivate_component(sink_, host_.now), Status::kOk);
    sut_.set_observer(&observer);

    run_frame(sut_, host_, 1);

    EXPECT_EQ(observer.take_seen(3U), (Seen{0U, kWithin, 0U}));
}

TEST_F(ExecutiveTest, WithoutAnObserverNothingChanges) {
    verifies("SWR-KRN-030", Technique::kInterface);
    Counter counter;
    Relay relay;
    Sink sink;
    const auto table = system(
        frame(kFrame), trace_hash(), window("first", 0_ns, 400_ns, budget(300_ns), run(counter, relay)),
        window("second", 400_ns, 600_ns, budget(600_ns), run(sink)),
        connect(counter.out, relay.in, any_age()), connect(relay.out, sink.in, any_age()));
    ExecutiveFor observed{table};
    FakeHost host;
    SpyObserver observer;
    ASSERT_EQ(observed.initialize(), Status::kOk);
    ASSERT_EQ(observed.start(), Status::kOk);
    observed.set_observer(&observer);

    run_frame(sut_, host_, 0);
    run_frame(observed, host, 0);
    observed.set_observer(nullptr);
    host.durations[{0U, WindowHost::Pass::kExecute}] = 1_ns;
    observer.records[0].set_limits(0_ns, 0_ns);
    run_frame(observed, host, 1);

    EXPECT_EQ(observer.take_seen(3U), (Seen{kWithin, kWithin, kWithin}));
    run_frame(sut_, host_, 1);
    EXPECT_EQ(observed.get_trace_hash(), sut_.get_trace_hash());
}

TEST_F(ExecutiveTest, AStoppedContextRunsNothing) {
    verifies("SWR-KRN-021", Technique::kStateTransition, Polarity::kViolation);
    SpyObserver observer;
    sut_.set_observer(&observer);
    ASSERT_EQ(sut_.get_context(0U).stop(Instant{}), Status::kOk);

    EXPECT_EQ(sut_.run_window(0U, host_), WindowOutcome::kStopped);

    EXPECT_TRUE(observer.heard.empty());
    EXPECT_EQ(observer.take_seen(1U), Seen{0U});
    EXPECT_EQ(counter_.value, 0);
    EXPECT_EQ(sut_.get_trace_hash(), TraceHash{}.get_value());
}

TEST_F(ExecutiveTest, AWindowThatDoesNotExistOrOpensBeforeItsTimeEndsInTheAssertion) {
    verifies("SWR-KRN-021", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS(static_cast<void>(sut_.run_window(2U, host_)), "span.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(sut_.run_window(0U, host_.now + 1_ns, host_)), "executive.cpp", 3);
}

TEST_F(ExecutiveTest, AChainInOneWindowNeedsNoExtraCycle) {
    verifies("SWR-KRN-023");
    Counter counter;
    Relay relay;
    Sink sink;
    const auto table =
        system(frame(kFrame), window("w", 0_ns, 400_ns, budget(300_ns), run(counter, relay, sink)),
               connect(counter.out, relay.in, any_age()), connect(relay.out, sink.in, any_age()));
    ExecutiveFor executive{table};
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);

    for (std::int64_t frame = 0; frame < 3; ++frame) {
        run_frame(executive, host_, frame);
    }

    EXPECT_EQ(sink.get_values(), (Values{11, 21, 31}));
    EXPECT_EQ(sink.notes[2].age, 0_ns);
    EXPECT_TRUE(sink.notes[2].is_new);
    EXPECT_EQ(relay.out.get_sequence(), 3U);

    host_.now = Instant{3005};
    EXPECT_EQ(executive.run_window(0U, Instant{3000}, host_), WindowOutcome::kCompleted);
    EXPECT_EQ(sink.notes[3].age, 0_ns) << "dated by the planned opening, also when it opens late";
}

TEST_F(ExecutiveTest, AConnectionAgainstTheOrderArrivesOneFrameLater) {
    verifies("SWR-KRN-023", Technique::kBoundaryValues);
    Counter counter;
    Sink sink;
    const auto table = system(frame(kFrame), window("w", 0_ns, 400_ns, budget(300_ns), run(sink, counter)),
                              connect(counter.out, sink.in, any_age(), delayed_by_a_frame()));
    ExecutiveFor executive{table};
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);

    for (std::int64_t frame = 0; frame < 3; ++frame) {
        run_frame(executive, host_, frame);
    }

    EXPECT_EQ(sink.get_values(), (Values{0, 10, 20}));
    EXPECT_FALSE(sink.notes[0].is_new);
    EXPECT_EQ(sink.notes[2].age, 600_ns) << "from the close at 1400 to the opening at 2000";
}

TEST_F(ExecutiveTest, AValueWrittenInTheSecondPassReachesALaterComponentInTheNextFrame) {
    verifies("SWR-KRN-023", Technique::kErrorGuessing);
    Counter counter;
    Sink sink;
    const auto table = system(frame(kFrame), window("w", 0_ns, 400_ns, budget(300_ns), run(counter, sink)),
                              connect(counter.out, sink.in, any_age()));
    ExecutiveFor executive{table};
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);
    counter.is_updating = true;

    run_frame(executive, host_, 0);
    counter.is_writing = false;
    run_frame(executive, host_, 1);

    EXPECT_EQ(sink.get_values(), (Values{10, -10}));
    EXPECT_TRUE(sink.notes[1].is_new);
    EXPECT_EQ(counter.out.get_published(), -10);
}

TEST_F(ExecutiveTest, AnInputStaysNewUntilItsOwnerHadACycle) {
    verifies("SWR-KRN-016", Technique::kStateTransition);
    ASSERT_EQ(sut_.get_context(1U).deactivate_component(sink_, Instant{}), Status::kOk);
    run_frame(sut_, host_, 0);
    counter_.is_writing = false;

    EXPECT_TRUE(sink_.in.is_new());
    ASSERT_EQ(sut_.get_context(1U).activate_component(sink_, Instant{1000}), Status::kOk);
    run_frame(sut_, host_, 1);

    ASSERT_EQ(sink_.notes.size(), 1U);
    EXPECT_TRUE(sink_.notes[0].is_new) << "it arrived while the sink could not see it";
}

}  // namespace
}  // namespace mamori

// SPDX-License-Identifier: Apache-2.0
// Goal: a queue gives every publication once, in order, not before its instant, and counts what it cannot.
// Method: a source and a queue moved by hand; a whole system with two rates on one core and on two.
#include "mamori/kernel/dataflow/queue_in_port.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using testing_support::Counter;
using testing_support::FakeHost;
using namespace verification;
using Values = std::vector<std::int64_t>;

template <FullPolicy kFull, EmptyPolicy kEmpty>
class Queue {
  public:
    void publish(std::int64_t value, Instant at) {
        out.write(value);
        ASSERT_TRUE(out.publish(at));
        static_cast<void>(in.push(out.get_published_sample()));
    }
    /// What reads at `opening` give until the first refusal, at most `limit`.
    Values read_all(Instant opening, std::size_t limit = 9U) {
        in.open(opening);
        Values values;
        std::int64_t value = 0;
        while (values.size() < limit && in.read(value) == Status::kOk) {
            values.push_back(value);
        }
        return values;
    }
    OutPort<std::int64_t> out{kNoOwner, "out"};
    QueueInPort<std::int64_t, 2U, kFull, kEmpty> in{kNoOwner, "in"};
};

TEST(QueueInPortTest, ValuesComeInOrderAndOnce) {
    verifies("SWR-KRN-028");
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> sut;
    sut.publish(1, Instant{10});
    sut.publish(2, Instant{20});

    EXPECT_EQ(sut.read_all(Instant{20}), (Values{1, 2}));
    EXPECT_EQ(sut.in.calc_age(Instant{25}), 5_ns);
    EXPECT_EQ(sut.read_all(Instant{30}), Values{});
    EXPECT_EQ(sut.in.get_empty_read_count(), 2U);
}

TEST(QueueInPortTest, AValueIsNotReadBeforeItsInstant) {
    verifies("SWR-KRN-028", Technique::kBoundaryValues, Polarity::kViolation);
    Queue<FullPolicy::kOverwrite, EmptyPolicy::kDoNothing> sut;
    sut.publish(1, Instant{10});
    sut.publish(2, Instant{20});

    EXPECT_EQ(sut.read_all(Instant{9}), Values{});
    EXPECT_FALSE(sut.in.is_new());
    EXPECT_EQ(sut.read_all(Instant{19}), Values{1});
    EXPECT_EQ(sut.read_all(Instant{20}), Values{2});
}

TEST(QueueInPortTest, ASampleThatWasQueuedIsNotQueuedAgain) {
    verifies("SWR-KRN-028", Technique::kErrorGuessing, Polarity::kViolation);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> sut;
    sut.out.write(1);
    EXPECT_EQ(sut.in.push(sut.out.get_staged_sample(Instant{5})), Status::kOk);
    ASSERT_TRUE(sut.out.publish(Instant{10}));
    EXPECT_EQ(sut.in.push(sut.out.get_published_sample()), Status::kOk);
    EXPECT_EQ(sut.in.push(sut.out.get_staged_sample(Instant{20})), Status::kOk);

    EXPECT_EQ(sut.read_all(Instant{20}), Values{1});
}

TEST(QueueInPortTest, AQueueIsMandatoryUnlessItSaysOtherwise) {
    verifies("SWR-KRN-028", Technique::kInterface);
    using Optional = QueueInPort<double, 1U, FullPolicy::kOverwrite, EmptyPolicy::kReadback, Need::kOptional>;

    static_assert(QueueInPort<double, 1U>::kIsMandatory && !Optional::kIsMandatory);
    static_assert(QueueInPort<double, 1U>::kIsQueue && QueueInPort<double, 1U>::kMayLeaveCore);
    SUCCEED();
}

TEST(QueueInPortTest, AnEmptyQueueHasNothingToTell) {
    verifies("SWR-KRN-029", Technique::kBoundaryValues);
    Queue<FullPolicy::kOverwrite, EmptyPolicy::kReadback> sut;

    EXPECT_FALSE(sut.in.has_waiting());
    EXPECT_FALSE(sut.in.has_value());
    const PortCounts counts = QueueInPort<std::int64_t, 2U>::count(sut.in);
    EXPECT_EQ(counts.capacity, 2U);
    EXPECT_EQ(counts.high_water_mark + counts.rejected + counts.overwritten + counts.empty_reads, 0U);
}

TEST(QueueInPortTest, AQueueIsNewWhileAValueWaitsThatIsDue) {
    verifies("SWR-KRN-028", Technique::kBoundaryValues);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> sut;
    sut.publish(1, Instant{10});

    sut.in.open(Instant{9});
    EXPECT_FALSE(sut.in.is_new() || sut.in.has_waiting());
    sut.in.open(Instant{10});
    EXPECT_TRUE(sut.in.is_new() && sut.in.has_waiting());
    EXPECT_EQ(sut.read_all(Instant{10}), Values{1});
    EXPECT_FALSE(sut.in.has_waiting());
    sut.in.open(Instant{11});
    EXPECT_FALSE(sut.in.is_new());
}

TEST(QueueInPortTest, AValueThatWaitsHasItsStatusAndAgeBeforeItIsRead) {
    verifies("SWR-KRN-037", Technique::kBoundaryValues);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kReadback> sut;
    static constexpr AgeLimits kLimits{15_ns, {}};
    sut.in.set_age_limits(kLimits);
    EXPECT_EQ(sut.in.calc_status(Instant{0}), PortStatus::kBufferEmpty);
    sut.publish(1, Instant{10});
    EXPECT_EQ(sut.in.calc_status(Instant{10}), PortStatus::kBufferEmpty) << "before the opening";

    sut.in.open(Instant{9});
    EXPECT_FALSE(sut.in.has_value()) << "not due yet";
    sut.in.open(Instant{25});
    EXPECT_TRUE(sut.in.has_value());
    EXPECT_EQ(sut.in.get_published_at(), Instant{10});
    EXPECT_EQ(sut.in.calc_age(Instant{25}), 15_ns);
    EXPECT_EQ(sut.in.calc_status(Instant{25}), PortStatus::kOk);
    EXPECT_EQ(sut.in.calc_status(Instant{26}), PortStatus::kBufferTimeout);
}

TEST(QueueInPortTest, AValueThatArrivesAfterTheStartOfTheWindowIsReadableAndNotNew) {
    verifies("SWR-KRN-037", Technique::kBoundaryValues);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kReadback> sut;
    sut.in.open(Instant{10});
    ASSERT_FALSE(sut.in.has_value());
    sut.publish(1, Instant{10});  // as a writer on another core that is late

    std::int64_t value = 0;
    ASSERT_EQ(sut.in.read(value), Status::kOk);
    EXPECT_EQ(value, 1);
    EXPECT_TRUE(sut.in.has_value());
    EXPECT_FALSE(sut.in.is_new());
}

TEST(QueueInPortTest, StatusAndAgeAreThoseOfTheOldestThatWaitsThenOfWhatWasRead) {
    verifies("SWR-KRN-037", Technique::kStateTransition);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> sut;
    static constexpr AgeLimits kLimits{20_ns, {}};
    sut.in.set_age_limits(kLimits);
    sut.publish(1, Instant{10});
    sut.publish(2, Instant{30});
    std::int64_t value = 0;
    sut.in.open(Instant{40});

    EXPECT_EQ(sut.in.calc_status(Instant{40}), PortStatus::kBufferTimeout);
    ASSERT_EQ(sut.in.read(value), Status::kOk);
    EXPECT_EQ(sut.in.calc_age(Instant{40}), 30_ns) << "of the value in hand, though a newer one waits";
    EXPECT_EQ(sut.in.calc_status(Instant{40}), PortStatus::kBufferTimeout);
    ASSERT_EQ(sut.in.read(value), Status::kOk);
    EXPECT_EQ(sut.in.calc_age(Instant{40}), 10_ns);
    EXPECT_EQ(sut.in.calc_status(Instant{40}), PortStatus::kOk);
    sut.in.open(Instant{60});
    EXPECT_EQ(sut.in.calc_age(Instant{60}), 30_ns) << "none waits: still the one read last";
    EXPECT_EQ(sut.in.calc_status(Instant{60}), PortStatus::kBufferTimeout);
    sut.publish(3, Instant{60});
    sut.in.open(Instant{60});
    EXPECT_EQ(sut.in.calc_status(Instant{60}), PortStatus::kOk);
}

TEST(QueueInPortTest, AValueThatWaitedIsGoneWithItsStatusAfterARestart) {
    verifies("SWR-MOD-009", Technique::kStateTransition, Polarity::kViolation);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kReadback> sut;
    std::int64_t value = 7;
    sut.publish(1, Instant{10});
    sut.in.open(Instant{10});
    ASSERT_EQ(sut.in.read(value), Status::kOk);
    sut.publish(2, Instant{11});
    sut.in.open(Instant{15});
    ASSERT_TRUE(sut.in.has_value());

    sut.in.restart(Instant{20}, 0U);
    sut.in.open(Instant{20});

    EXPECT_EQ(sut.in.calc_status(Instant{20}), PortStatus::kBufferEmpty);
    sut.publish(3, Instant{30});
    sut.in.open(Instant{30});
    ASSERT_TRUE(sut.in.has_value());
    sut.in.open(Instant{29});
    EXPECT_EQ(sut.in.read(value), Status::kPreconditionNotMet)
        << "nothing was read in this mode to be read back";
    EXPECT_EQ(value, 1);
}

TEST(QueueInPortTest, NothingOfAnotherModeIsLeftInAFullQueueOfWhichOneEntryIsHeld) {
    verifies("SWR-MOD-009", Technique::kBoundaryValues, Polarity::kViolation);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kReadback> sut;
    sut.publish(1, Instant{10});
    sut.in.open(Instant{10});
    ASSERT_TRUE(sut.in.has_waiting()) << "and is held from here on, so two more have room";
    sut.publish(2, Instant{20});
    sut.publish(3, Instant{30});

    sut.in.restart(Instant{30}, 0U);

    EXPECT_EQ(sut.read_all(Instant{40}), Values{}) << "the last one was published at the restart itself";
    EXPECT_FALSE(sut.in.is_new());
    sut.publish(4, Instant{50});
    EXPECT_EQ(sut.read_all(Instant{50}, 1U), Values{4});
}

TEST(QueueInPortTest, NothingIsReadFromARestartToTheNextOpening) {
    verifies("SWR-MOD-009", Technique::kStateTransition, Polarity::kViolation);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kReadback> sut;
    sut.publish(1, Instant{10});
    sut.publish(2, Instant{10});
    ASSERT_EQ(sut.read_all(Instant{10}, 1U), Values{1});
    std::int64_t value = 0;

    sut.in.restart(Instant{20}, 0U);

    EXPECT_FALSE(sut.in.has_waiting());
    EXPECT_EQ(sut.in.read(value), Status::kPreconditionNotMet) << "neither what waits nor what was read last";
}

TEST(QueueInPortTest, AValueThatIsPublishedBetweenARestartAndTheNextOpeningIsOfTheNewMode) {
    verifies("SWR-MOD-009", Technique::kBoundaryValues);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kReadback> sut;
    sut.in.restart(Instant{20}, 0U);
    sut.publish(1, Instant{21});

    EXPECT_EQ(sut.read_all(Instant{25}, 1U), Values{1});
}

TEST(QueueInPortTest, AValueThatIsHandedOnAtTheInstantOfARestartIsOfTheNewMode) {
    verifies("SWR-MOD-009", Technique::kBoundaryValues);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> sut;
    sut.in.restart(Instant{20}, 0U);
    sut.in.open(Instant{20});
    sut.out.write(1);
    ASSERT_EQ(sut.in.push(sut.out.get_staged_sample(Instant{20})), Status::kOk);

    EXPECT_TRUE(sut.in.has_waiting());
    EXPECT_EQ(sut.read_all(Instant{30}), Values{1}) << "not read at once, and still there";
}

TEST(QueueInPortTest, AFullQueueRefusesTheNewestOrGivesUpTheOldestAndCounts) {
    verifies("SWR-KRN-029", Technique::kBoundaryValues, Polarity::kViolation);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> refusing;
    Queue<FullPolicy::kOverwrite, EmptyPolicy::kDoNothing> replacing;
    for (std::int64_t i = 1; i <= 3; ++i) {
        refusing.publish(i, Instant{i});
        replacing.publish(i, Instant{i});
    }

    EXPECT_EQ(refusing.in.get_rejected_count(), 1U);
    EXPECT_EQ(refusing.in.get_high_water_mark(), 2U);
    EXPECT_EQ(refusing.read_all(Instant{9}), (Values{1, 2}));
    EXPECT_EQ(replacing.in.get_overwritten_count(), 1U);
    EXPECT_EQ(replacing.read_all(Instant{9}), (Values{2, 3}));
}

TEST(QueueInPortTest, AnEmptyQueueReadsTheLastValueBackWhenToldToAndOnlyOnceThereWasOne) {
    verifies("SWR-KRN-029", Technique::kEquivalenceClasses);
    Queue<FullPolicy::kDoNothing, EmptyPolicy::kReadback> sut;
    EXPECT_EQ(sut.read_all(Instant{9}), Values{});
    sut.publish(1, Instant{10});

    EXPECT_EQ(sut.read_all(Instant{10}, 3U), (Values{1, 1, 1}));
    sut.publish(2, Instant{20});
    EXPECT_EQ(sut.read_all(Instant{19}, 2U), (Values{1, 1})) << "the next one waits for its instant";
    EXPECT_EQ(sut.in.calc_status(Instant{19}), PortStatus::kOk);
}

/// Asks for the status first, as one does with an input that keeps the latest value, and reads one value.
class Asker final : public Component {
  public:
    Asker() : Component("asker") {}
    QueueInPort<std::int64_t, 8U> in{*this, "in"};
    using Ports = mamori::Ports<&Asker::in>;
    Values values;

    Status on_execute(ContextHandle context) noexcept override {
        std::int64_t value = 0;
        if (in.calc_status(context.now) == PortStatus::kOk && in.is_new() && in.read(value) == Status::kOk) {
            values.push_back(value);
        }
        return Status::kOk;
    }
};

template <typename Table>
Values run_four_frames(const Table& table, const Asker& asker) {
    ExecutiveFor executive{table};
    FakeHost host;
    EXPECT_EQ(executive.initialize(), Status::kOk);
    EXPECT_EQ(executive.start(), Status::kOk);
    for (std::int64_t t = 0; t < 40; t += 10) {
        host.now = Instant{t};
        EXPECT_EQ(executive.run_window(0U, host), WindowOutcome::kCompleted);
    }
    return asker.values;
}

TEST(QueueSystemTest, AReaderThatAsksForTheStatusFirstGetsEveryValueThatWasPublished) {
    verifies("SWR-KRN-037");
    Counter counter;
    Asker asker;
    const auto table = system(frame(10_ns), window("w", 0_ns, 5_ns, budget(5_ns), run(asker, counter)),
                              connect(counter.out, asker.in, fresh_within(10_ns), delayed_by_a_frame()));

    EXPECT_EQ(run_four_frames(table, asker), (Values{10, 20, 30}));
}

TEST(QueueSystemTest, AReaderThatAsksForTheStatusFirstGetsEveryValueThatIsHandedOn) {
    verifies("SWR-KRN-037");
    Counter counter;
    Asker asker;
    const auto table = system(frame(10_ns), window("w", 0_ns, 5_ns, budget(5_ns), run(counter, asker)),
                              connect(counter.out, asker.in, fresh_within(10_ns)));

    EXPECT_EQ(run_four_frames(table, asker), (Values{10, 20, 30, 40}));
}

/// Reads all that waits and notes it.
class Collector final : public Component {
  public:
    Collector() : Component("collector") {}
    QueueInPort<std::int64_t, 8U, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> in{*this, "in"};
    using Ports = mamori::Ports<&Collector::in>;
    std::vector<Values> cycles;

    Status on_execute(ContextHandle) noexcept override {
        Values values;
        std::int64_t value = 0;
        while (in.read(value) == Status::kOk) {
            values.push_back(value);
        }
        cycles.push_back(values);
        return Status::kOk;
    }
};

TEST(QueueSystemTest, ASlowReaderGetsEveryValueOfAFastWriter) {
    verifies("SWR-KRN-028");
    Counter counter;
    Collector collector;
    const auto table =
        system(frame(40_ns), window("fast", 0_ns, 5_ns, every(10_ns), budget(5_ns), run(counter)),
               window("slow", 5_ns, 5_ns, budget(5_ns), run(collector)),
               connect(counter.out, collector.in, any_age()));
    ExecutiveFor sut{table};
    FakeHost host;
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    for (std::int64_t t = 0; t < 80; t += 10) {
        host.now = Instant{t};
        ASSERT_EQ(sut.run_window(0U, host), WindowOutcome::kCompleted);
        if (t % 40 == 0) {
            host.now = Instant{t + 5};
            ASSERT_EQ(sut.run_window(1U, host), WindowOutcome::kCompleted);
        }
    }

    EXPECT_EQ(collector.cycles, (std::vector<Values>{{10}, {20, 30, 40, 50}}));
}

/// An input that refuses, one that gives up its oldest, and neither reads.
template <FullPolicy kFull>
class Sleeper final : public Component {
  public:
    Sleeper() : Component("sleeper") {}
    QueueInPort<std::int64_t, 2U, kFull> in{*this, "in"};
    using Ports = mamori::Ports<&Sleeper::in>;
    bool is_reading{false};

    Status on_execute(ContextHandle) noexcept override {
        std::int64_t value = 0;
        return is_reading ? in.read(value) : Status::kOk;
    }
};

template <typename Table, typename Reader>
std::vector<PortStatus> run_and_ask_the_writer(const Table& table, const Counter& writer, Reader& reader) {
    ExecutiveFor executive{table};
    FakeHost host;
    EXPECT_EQ(executive.initialize(), Status::kOk);
    EXPECT_EQ(executive.start(), Status::kOk);
    std::vector<PortStatus> statuses{writer.out.get_status()};
    for (std::int64_t t = 0; t < 60; t += 10) {
        reader.is_reading = t >= 40;
        host.now = Instant{t};
        EXPECT_EQ(executive.run_window(0U, host), WindowOutcome::kCompleted);
        statuses.push_back(writer.out.get_status());
    }
    return statuses;
}

constexpr PortStatus kIn = PortStatus::kOk;
constexpr PortStatus kRefused = PortStatus::kBufferFull;

TEST(QueueSystemTest, TheWriterIsToldOfEachValueThatAFullQueueRefused) {
    verifies("SWR-KRN-038", Technique::kBoundaryValues, Polarity::kViolation);
    Counter counter;
    Sleeper<FullPolicy::kDoNothing> reader;
    const auto table = system(frame(10_ns), window("w", 0_ns, 5_ns, budget(5_ns), run(reader, counter)),
                              connect(counter.out, reader.in, any_age(), delayed_by_a_frame()));

    EXPECT_EQ(run_and_ask_the_writer(table, counter, reader),
              (std::vector<PortStatus>{kIn, kIn, kIn, kIn, kRefused, kRefused, kIn}))
        << "one is held, two wait; a read gives up the one that is held, the next opening takes one more";
    EXPECT_EQ(reader.in.get_rejected_count(), 2U);
}

TEST(QueueSystemTest, TheWriterIsToldOfAValueThatWasRefusedWhenItWasHandedOn) {
    verifies("SWR-KRN-038", Technique::kBoundaryValues, Polarity::kViolation);
    Counter counter;
    Sleeper<FullPolicy::kDoNothing> reader;
    const auto table = system(frame(10_ns), window("w", 0_ns, 5_ns, budget(5_ns), run(counter, reader)),
                              connect(counter.out, reader.in, any_age()));

    EXPECT_EQ(run_and_ask_the_writer(table, counter, reader),
              (std::vector<PortStatus>{kIn, kIn, kIn, kIn, kRefused, kRefused, kIn}))
        << "in the first cycle that reads, the value comes before the read";
    EXPECT_EQ(reader.in.get_rejected_count(), 2U);
}

TEST(QueueSystemTest, AQueueThatGivesUpItsOldestTakesEachValue) {
    verifies("SWR-KRN-038", Technique::kEquivalenceClasses);
    Counter counter;
    Sleeper<FullPolicy::kOverwrite> reader;
    const auto table = system(frame(10_ns), window("w", 0_ns, 5_ns, budget(5_ns), run(reader, counter)),
                              connect(counter.out, reader.in, any_age(), delayed_by_a_frame()));

    EXPECT_EQ(run_and_ask_the_writer(table, counter, reader), std::vector<PortStatus>(7U, kIn));
    EXPECT_GT(reader.in.get_overwritten_count(), 0U) << "counted at the input";
}

TEST(QueueSystemTest, AQueueWithinAWindowGetsAValueOnceInTheSameCycle) {
    verifies("SWR-KRN-028", Technique::kStateTransition);
    Counter counter;
    Collector collector;
    const auto table = system(frame(40_ns), window("w", 0_ns, 5_ns, budget(5_ns), run(counter, collector)),
                              connect(counter.out, collector.in, any_age()));
    ExecutiveFor sut{table};
    FakeHost host;
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    ASSERT_EQ(sut.run_window(0U, host), WindowOutcome::kCompleted);
    counter.is_updating = true;  // a second value, in the second pass
    host.now = Instant{40};
    ASSERT_EQ(sut.run_window(0U, host), WindowOutcome::kCompleted);
    counter.is_writing = false;
    counter.is_updating = false;
    host.now = Instant{80};
    ASSERT_EQ(sut.run_window(0U, host), WindowOutcome::kCompleted);

    EXPECT_EQ(collector.cycles, (std::vector<Values>{{10}, {20}, {-20}}));
}

TEST(QueueSystemTest, AQueueBetweenCoresNeedsNoCrossingAndNoOrder) {
    verifies("SWR-KRN-028", Technique::kEquivalenceClasses);
    Counter counter;
    Collector collector;
    const auto table = system(frame(40_ns), window("w", 0_ns, 10_ns, budget(5_ns), run(counter)),
                              window("r", 5_ns, 5_ns, core(1), budget(5_ns), run(collector)),
                              connect(counter.out, collector.in, any_age()));
    ExecutiveFor writer{table};
    ExecutiveFor reader{table, 1U};
    FakeHost host;
    ASSERT_EQ(writer.initialize(), Status::kOk);
    ASSERT_EQ(reader.initialize(), Status::kOk);
    ASSERT_EQ(writer.start(), Status::kOk);
    ASSERT_EQ(reader.start(), Status::kOk);
    for (std::int64_t t = 0; t < 120; t += 40) {
        host.now = Instant{t + 5};
        ASSERT_EQ(writer.run_window(0U, Instant{t}, host), WindowOutcome::kCompleted);
        ASSERT_EQ(reader.run_window(1U, Instant{t + 5}, host), WindowOutcome::kCompleted);
    }

    EXPECT_EQ(collector.cycles, (std::vector<Values>{{}, {10}, {20}})) << "published at the close, 10 ns";
}

}  // namespace
}  // namespace mamori

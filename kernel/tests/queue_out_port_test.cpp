// SPDX-License-Identifier: Apache-2.0
// Goal: an output with a queue publishes each value of a cycle; counters and reports show what is lost, also
//       after a restart. Method: ports moved by hand, and a system with a reader on each of two cores.
#include "mamori/kernel/dataflow/queue_out_port.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Pass = WindowHost::Pass;
using Values = std::vector<std::int32_t>;

TEST(QueueOutPortTest, ValuesOfACycleWaitInTheOrderOfWriting) {
    verifies("SWR-KRN-053", Technique::kBoundaryValues);
    QueueOutPort<std::int32_t, 3U> sut{kNoOwner, "out"};
    for (const std::int32_t value : {7, 8, 9}) {
        EXPECT_EQ(sut.write(value), Status::kOk);
    }
    EXPECT_EQ(sut.write(10), Status::kOutOfResources);

    EXPECT_TRUE(sut.publish(Instant{100}));

    const Span<const std::int32_t> values = sut.get_values();
    EXPECT_EQ(Values(values.begin(), values.end()), (Values{7, 8, 9}));
    EXPECT_EQ(sut.get_published(), 9);
    EXPECT_EQ(sut.get_sequence(), 1U);
    EXPECT_EQ(sut.get_written_count(), 4U);
    EXPECT_EQ(sut.get_lost_count(), 1U);
    EXPECT_EQ(sut.get_counts().rejected, 1U);
}

TEST(QueueOutPortTest, TheNextCycleBeginsWithAnEmptyQueue) {
    verifies("SWR-KRN-053");
    QueueOutPort<std::int32_t, 1U> sut{kNoOwner, "out"};
    EXPECT_EQ(sut.write(1), Status::kOk);
    sut.discard();
    EXPECT_EQ(sut.write(2), Status::kOk);
    EXPECT_TRUE(sut.publish(Instant{100}));
    EXPECT_FALSE(sut.publish(Instant{200}));
    EXPECT_EQ(sut.write(3), Status::kOk);

    EXPECT_EQ(sut.get_values()[0], 3);
    EXPECT_EQ(sut.get_published(), 2);
    EXPECT_EQ(sut.get_lost_count(), 1U) << "the discarded one";
    EXPECT_EQ(sut.get_counts().rejected, 0U);
}

TEST(QueueOutPortTest, TheHashIsThatOfEachValueInOrder) {
    verifies("SWR-KRN-053", Technique::kBackToBack);
    const auto calc_hash = [](const Values& values) {
        QueueOutPort<std::int32_t, 2U> out{kNoOwner, "out"};
        for (const std::int32_t value : values) {
            EXPECT_EQ(out.write(value), Status::kOk);
        }
        EXPECT_TRUE(out.publish(Instant{100}));
        TraceHash hash;
        QueueOutPort<std::int32_t, 2U>::hash_published(out, hash);
        return hash.get_value();
    };
    OutPort<std::int32_t> latest{kNoOwner, "out"};
    latest.write(2);
    ASSERT_TRUE(latest.publish(Instant{100}));
    TraceHash hash;
    OutPort<std::int32_t>::hash_published(latest, hash);

    EXPECT_EQ(calc_hash({2}), hash.get_value());
    EXPECT_NE(calc_hash({1, 2}), calc_hash({2}));
    EXPECT_NE(calc_hash({1, 2}), calc_hash({2, 2}));
}

/// Writes `count` values per cycle, 1, 2, ... over all cycles, to both outputs.
class Writer final : public Component {
  public:
    Writer() : Component("writer") {}
    QueueOutPort<std::int32_t, 3U> each{*this, "each"};
    OutPort<std::int32_t> latest{*this, "latest"};
    using Ports = mamori::Ports<&Writer::each, &Writer::latest>;
    std::int32_t count{1};

    Status on_execute(ContextHandle) noexcept override {
        for (std::int32_t i = 0; i < count; ++i) {
            ++value_;
            static_cast<void>(each.write(value_));
            latest.write(value_);
        }
        return Status::kOk;
    }

  private:
    std::int32_t value_{0};
};

class Reader final : public Component {
  public:
    explicit Reader(const char* name) : Component(name) {}
    QueueInPort<std::int32_t, 4U, FullPolicy::kDoNothing> queue{*this, "queue"};
    InPort<std::int32_t> latest{*this, "latest"};
    using Ports = mamori::Ports<&Reader::queue, &Reader::latest>;
    bool is_reading{true};

    Status on_execute(ContextHandle) noexcept override {
        std::int32_t value = 0;
        while (is_reading && queue.has_waiting()) {
            EXPECT_EQ(queue.read(value), Status::kOk);
        }
        return Status::kOk;
    }
};

class LossObserver final : public ExecutionObserver {
  public:
    std::vector<std::size_t> ports;
    void on_budget_overrun(std::size_t, std::size_t, Instant) noexcept override {}
    void on_late_release(std::size_t, Duration, Instant) noexcept override {}
    void on_values_lost(std::size_t port, Instant) noexcept override { ports.push_back(port); }
};

/// The writer has two windows per major frame.
class ValueLossTest : public ::testing::Test {
  protected:
    using Ports = std::vector<std::size_t>;
    static constexpr std::size_t kEach = 0U;    ///< port row
    static constexpr std::size_t kLatest = 1U;  ///< port row

    void SetUp() override {
        core_0_.set_observer(&observer_);
        ASSERT_EQ(core_0_.initialize(), Status::kOk);
        ASSERT_EQ(core_1_.initialize(), Status::kOk);
        ASSERT_EQ(core_0_.start(), Status::kOk);
        ASSERT_EQ(core_1_.start(), Status::kOk);
    }
    void run(Executive& core, std::size_t window, std::int64_t at, WindowOutcome expected) {
        host_.now = Instant{at};
        ASSERT_EQ(core.run_window(window, Instant{at}, host_), expected);
    }
    void write(std::int32_t count, WindowOutcome expected = WindowOutcome::kCompleted) {
        writer_.count = count;
        host_.durations[{0U, Pass::kExecute}] = expected == WindowOutcome::kOverrun ? 101_ns : 0_ns;
        run(core_0_, 0U, writes_ * 500, expected);
        ++writes_;
    }
    void read_near() { run(core_0_, 1U, writes_ / 2 * 1000 + 200, WindowOutcome::kCompleted); }
    void read_other() { run(core_1_, 2U, writes_ / 2 * 1000 + 400, WindowOutcome::kCompleted); }
    static std::array<std::uint32_t, 4U> show(const PortCounts& counts) {
        return {counts.received, counts.superseded, counts.lost, counts.waiting};
    }
    using Shown = std::array<std::uint32_t, 4U>;
    Shown show_latest(const Reader& reader) const { return show(count_latest(reader.latest)); }
    Shown show_queue(const Reader& reader) const { return show(reader.queue.get_counts()); }

    Writer writer_;
    Reader near_{"near"};
    Reader other_{"other"};
    Crossing<std::int32_t> crossing_;
    SystemTable<3U, 3U, 6U, 4U> table_ = system(
        frame(1000_ns), window("write", 0_ns, 100_ns, every(500_ns), budget(100_ns), mamori::run(writer_)),
        window("near", 200_ns, 100_ns, budget(100_ns), mamori::run(near_)),
        window("other", 400_ns, 100_ns, core(1), budget(100_ns), mamori::run(other_)),
        connect(writer_.each, near_.queue, any_age()), connect(writer_.latest, near_.latest, any_age()),
        connect(writer_.each, other_.queue, any_age()),
        connect(writer_.latest, other_.latest, through(crossing_), any_age()));
    FakeHost host_;
    LossObserver observer_;
    ExecutiveFor<decltype(table_)> core_0_{table_};
    ExecutiveFor<decltype(table_)> core_1_{table_, 1U};
    std::int64_t writes_{0};
};

TEST_F(ValueLossTest, ADiscardedWindowIsReportedForEachOutputThatItWrote) {
    verifies("SWR-KRN-055", Technique::kFaultInjection, Polarity::kViolation);
    write(2);
    EXPECT_TRUE(observer_.ports.empty());

    write(2, WindowOutcome::kOverrun);

    EXPECT_EQ(observer_.ports, (Ports{kEach, kLatest}));
    EXPECT_EQ(writer_.each.get_lost_count(), 2U);
    EXPECT_EQ(writer_.latest.get_lost_count(), 1U) << "the first of both is superseded";
}

TEST_F(ValueLossTest, ADiscardedWindowWithoutAWriteIsNotReported) {
    verifies("SWR-KRN-055", Technique::kBoundaryValues);
    write(0, WindowOutcome::kOverrun);

    EXPECT_TRUE(observer_.ports.empty());
}

TEST_F(ValueLossTest, ASecondLossInAMajorFrameIsReportedInTheNextOne) {
    verifies("SWR-KRN-055", Technique::kBoundaryValues);
    write(1, WindowOutcome::kOverrun);
    write(1, WindowOutcome::kOverrun);
    EXPECT_EQ(observer_.ports, (Ports{kEach, kLatest}));

    write(1);
    EXPECT_EQ(observer_.ports, (Ports{kEach, kLatest, kEach, kLatest}));
    write(1);
    write(1);
    EXPECT_EQ(observer_.ports.size(), 4U);
}

TEST_F(ValueLossTest, AFullQueueIsReportedForTheOutputThatFeedsIt) {
    verifies("SWR-KRN-055", Technique::kBoundaryValues);
    near_.is_reading = false;
    write(3);
    write(1);
    EXPECT_TRUE(observer_.ports.empty()) << "four values fill the queues";
    read_other();

    write(1);

    EXPECT_EQ(observer_.ports, Ports{kEach});
    EXPECT_EQ(near_.queue.get_rejected_count(), 1U);
    EXPECT_EQ(writer_.each.get_status(), PortStatus::kBufferFull);
}

TEST_F(ValueLossTest, AFullOutputIsReported) {
    verifies("SWR-KRN-055", Technique::kBoundaryValues);
    write(4);

    EXPECT_EQ(observer_.ports, Ports{kEach});
    EXPECT_EQ(writer_.each.get_lost_count(), 1U);
}

TEST_F(ValueLossTest, WithoutAnObserverTheCountersRemain) {
    verifies("SWR-KRN-055");
    core_0_.set_observer(nullptr);

    write(4);
    write(1, WindowOutcome::kOverrun);

    EXPECT_TRUE(observer_.ports.empty());
    EXPECT_EQ(writer_.each.get_lost_count(), 2U);
}

TEST_F(ValueLossTest, ARestartOfBothCoresDropsWhatWaitedAndCountsOn) {
    verifies("SWR-KRN-054", Technique::kBoundaryValues);
    write(2);
    read_near();
    read_other();
    EXPECT_EQ(show_latest(near_), (Shown{1U, 1U, 0U, 0U}));
    EXPECT_EQ(show_latest(other_), (Shown{1U, 1U, 0U, 0U}));
    write(2);
    write(1, WindowOutcome::kOverrun);
    for (Executive* core : {static_cast<Executive*>(&core_0_), static_cast<Executive*>(&core_1_)}) {
        ASSERT_EQ(core->stop(), Status::kOk);
    }
    for (Executive* core : {static_cast<Executive*>(&core_0_), static_cast<Executive*>(&core_1_)}) {
        ASSERT_EQ(core->start(), Status::kOk);
    }
    writes_ = 0;
    write(1, WindowOutcome::kOverrun);
    write(2);
    read_near();
    read_other();

    EXPECT_EQ(show_latest(near_), (Shown{2U, 2U, 2U, 0U})) << "two values were under way at the stop";
    EXPECT_EQ(show_latest(other_), (Shown{2U, 2U, 1U, 0U}));
    EXPECT_EQ(show_queue(near_), (Shown{4U, 0U, 4U, 0U})) << "two were dropped, two discarded";
    EXPECT_EQ(show_queue(other_), (Shown{4U, 0U, 4U, 0U}));
}

TEST_F(ValueLossTest, ACoreThatRestartsAloneCountsFromTheNextValueOn) {
    verifies("SWR-KRN-054", Technique::kBoundaryValues);
    write(1);
    read_other();
    write(1, WindowOutcome::kOverrun);
    write(1);
    ASSERT_EQ(core_1_.stop(), Status::kOk);
    ASSERT_EQ(core_1_.start(), Status::kOk);
    write(3);
    read_other();
    EXPECT_EQ(show_latest(other_), (Shown{2U, 0U, 0U, 0U}));

    write(1, WindowOutcome::kOverrun);
    write(2);
    read_other();
    EXPECT_EQ(show_latest(other_), (Shown{3U, 1U, 1U, 0U}));
}

TEST_F(ValueLossTest, AWriterThatRestartsAloneCountsFromItsStartOn) {
    verifies("SWR-KRN-054", Technique::kBoundaryValues);
    write(1);
    write(1, WindowOutcome::kOverrun);
    read_other();
    ASSERT_EQ(core_0_.stop(), Status::kOk);
    ASSERT_EQ(core_0_.start(), Status::kOk);
    write(1, WindowOutcome::kOverrun);
    write(3);
    read_other();

    EXPECT_EQ(show_latest(other_), (Shown{2U, 2U, 1U, 0U}));
}

TEST_F(ValueLossTest, TheIntrospectionShowsTheCounters) {
    verifies("SWR-INS-001");
    IntrospectionFor introspection{table_};
    ASSERT_EQ(core_0_.stop(), Status::kOk);
    core_0_.set_introspection(&introspection);
    ASSERT_EQ(core_0_.start(), Status::kOk);
    write(4);
    read_near();
    write(1, WindowOutcome::kOverrun);

    const auto read = [&introspection](std::size_t port) {
        PortSnapshot snapshot;
        EXPECT_EQ(introspection.read_port(port, snapshot), Status::kOk);
        return snapshot.counts;
    };
    const PortCounts each = read(kEach);
    EXPECT_EQ(each.written, 5U);
    EXPECT_EQ(each.lost, 2U);
    EXPECT_EQ(each.rejected, 1U);
    EXPECT_EQ(show(read(2U)), (Shown{3U, 0U, 0U, 0U}));
    EXPECT_EQ(show(read(3U)), (Shown{1U, 3U, 0U, 0U}));
}

}  // namespace
}  // namespace mamori
